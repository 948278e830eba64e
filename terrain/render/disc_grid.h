// The disc's triangles: one ring, which serves at every size, and the full disc in the middle.
//
// A ring is made of blocks, two by two cells of its spacing, each a fan about its middle; its disc is made of
// whole squares of four by four cells, about a centre on their lattice, and the ring within is cut out of it.
// Where a block meets the next ring, whose vertices are twice as far apart, the fan leaves out the vertex
// between: the triangles of all rings together are one surface without T-junctions. Pure arithmetic; any
// thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace ridgeline::render {

// A vertex: offset from the ring's centre, in its spacings.
struct DiscVertex {
    std::int16_t x = 0;
    std::int16_t y = 0;
};

// How a ring's inner border lies in it. The centre of the ring within is that of the ring or half a square
// off, to the east, to the south, or both. full: there is no ring within.
enum class RingHole : std::uint8_t { same, east, south, both, full };
constexpr int kRingHoles = 5;
// Parts of a ring by direction, so that what lies behind the eye need not be drawn.
constexpr int kRingSectors = 16;

// A part: indices, and the square about its vertices, in spacings from the ring's centre.
struct RingSector {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    glm::ivec2 least{0};
    glm::ivec2 most{0};
};

struct DiscGrid {
    std::vector<DiscVertex> vertices;
    std::vector<std::uint32_t> indices;
    // Sectors of a hole's ring lie one behind the other.
    std::array<std::array<RingSector, kRingSectors>, kRingHoles> sectors{};
};
// radius: of a ring in its own spacings.
DiscGrid make_disc_grid(int radius);

// Of a ring, in its own spacings: its centre, the corner of a square of the lattice.
glm::ivec2 ring_centre(const glm::ivec2& eye_cell, int ring);
RingHole ring_hole(const glm::ivec2& eye_cell, int ring, int innermost);

// Where a place of the lattice lies on the disc: the ring, a triangle's vertices, which are finest samples,
// and their shares.
struct DiscTriangle {
    int ring = 0;
    std::array<glm::ivec2, 3> cells{};
    std::array<double, 3> weights{};
};
// eye_cell: about which the rings lie. place: column, row.
DiscTriangle disc_triangle(int radius, const glm::ivec2& eye_cell, int innermost, const glm::dvec2& place);

// The rings that a frame draws: [innermost, outermost].
struct RingRange {
    int innermost = 0;
    int outermost = 0;
};
// The first ring whose surface shows anything but the next ring's, seen from this height over the ground, and
// the first that reaches this far. All in finest samples.
RingRange ring_range(double above_ground, double reach);

}  // namespace ridgeline::render
