// The surface as it is drawn: one draw entry's vertices where the vertex shader puts them, its borders, its
// height.
//
// The arithmetic is the shader's own (shaders/lib/morph.h, compiled as C++), so what holds here of equality
// on both sides of an edge holds of the picture. Used by the eye lift and by the watertightness tests. Pure
// functions; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "ridgeline/io/chunk.h"
#include "ridgeline/select/selection.h"
#include "ridgeline/select/view.h"

namespace ridgeline::select {

// Relative to the eye, metres: x east, y north, z up.
struct DrawnVertex {
    glm::vec3 position_m{0.0f};
    float omega = 0.0f;  // 0 own height, 1 the parent's surface
};
DrawnVertex drawn_vertex(const EyeFrame& eye, const glm::ivec2& origin, const MorphTable& morph,
                         const io::ChunkVertex& vertex);

// The node of a level in which a place of the terrain lies; its last row and column belong to the last nodes.
io::NodeId node_at_place(const io::Grid& grid, int level, double column, double row);
// The quarter of a node in which a place in it lies.
int quarter_at_place(const io::Grid& grid, const io::NodeId& node, const glm::dvec2& place);

// Where a lattice place lies in a chunk: a triangle and the weights of its corners.
struct ChunkPlace {
    std::uint16_t vertex[3] = {0, 0, 0};
    double weight[3] = {0.0, 0.0, 0.0};
};
// column, row: finest samples from the chunk's corner, within [0, extent]. Looks through the quarter's plain
// triangles; empty only for a place outside them.
std::optional<ChunkPlace> locate(const io::ChunkView& chunk, int extent, double column, double row);

// The same among the triangles that an entry draws, so with its fans. column, row as Selection::entry_at.
std::optional<ChunkPlace> locate(const io::ChunkView& chunk, const DrawEntry& entry, const io::Grid& grid,
                                 double column, double row);

// The chunk's unmorphed height at a place, in quanta.
double mesh_quanta(const io::ChunkView& chunk, const ChunkPlace& place);
// The drawn height at a place over the eye, in metres of the drawn frame: negative below the eye.
double drawn_height_m(const io::ChunkView& chunk, const EyeFrame& eye, const DrawEntry& entry,
                      const ChunkPlace& place);

// How high the entry's triangles stand over the eye at most within `reach_m` of it to any side (metres of the
// drawn frame, negative below the eye); minus infinity where none of them comes so near.
double highest_about_m(const io::ChunkView& chunk, const EyeFrame& eye, const DrawEntry& entry,
                       double reach_m);

// Index ranges that draw one quarter of an entry: its inside and its four sides as the entry chooses them.
std::array<io::IndexRange, 1 + io::kSides> quarter_ranges(const io::ChunkRanges& ranges,
                                                          const DrawEntry& entry, int quarter);

// A point of a border as drawn: where on the lattice, and where in space.
struct BorderPoint {
    io::LatticePoint place;
    glm::vec3 position_m{0.0f};
    friend bool operator==(const BorderPoint&, const BorderPoint&) = default;
};
// The polyline along a quarter's side, from west to east or from north to south, as the drawn triangles have
// it.
void border_polyline(const io::ChunkView& chunk, const EyeFrame& eye, const DrawEntry& entry,
                     const io::Grid& grid, int quarter, io::Side side, std::vector<BorderPoint>& points);

}  // namespace ridgeline::select
