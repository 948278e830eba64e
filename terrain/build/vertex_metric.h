// What counts as a vertex's error: its vertical distance to the coarser surface, alone (geometric) or joined
// by its constrained normal cone (cone).
//
// A vertex of scale s stands among four faces, the squares of the lattice of step s that meet in it. The more
// their normals turn about it, the likelier it stands on a silhouette, and the more shading changes where it
// is left out. The chord of that turn times a length that belongs to the scale is a height, so both errors
// are codes of one kind and the greater of them is the vertex's own; one propagation and one threshold a
// level serve both. Where the ground is hollow it makes no silhouette, and the cone counts as none.
//
// Pure functions and an immutable value; any thread.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "ridgeline/io/terrain_info.h"

namespace ridgeline::build {

enum class Metric { geometric, cone };
const char* metric_name(Metric metric);

// How cones are measured on the lattice of one step.
struct ConeScale {
    // The slope that a Face's rise of 1 means.
    float slope_east = 0.0f;
    float slope_south = 0.0f;
    // A chord of 1 is a height of this many half quanta; squared.
    float height_squared = 0.0f;
};

// A square of four neighbouring samples of a lattice.
struct Face {
    // Twice the mean rise over a step eastwards and southwards, quanta: exact, so that equal slopes compare
    // equal.
    float rise_east = 0.0f, rise_south = 0.0f;
    // The unit normal, with its horizontal part reversed.
    float east = 0.0f, south = 0.0f, up = 1.0f;
};

inline Face face_of(std::int32_t north_west, std::int32_t north_east, std::int32_t south_west,
                    std::int32_t south_east, const ConeScale& scale) {
    const auto rise_east = static_cast<float>((north_east - north_west) + (south_east - south_west));
    const auto rise_south = static_cast<float>((south_west - north_west) + (south_east - north_east));
    const float x = rise_east * scale.slope_east, y = rise_south * scale.slope_south;
    const float up = 1.0f / std::sqrt(1.0f + x * x + y * y);
    return {rise_east, rise_south, x * up, y * up, up};
}

// Whether the slope nowhere falls from one face to another in the direction of the other: along both axes in
// both rows and columns, and along both diagonals. The ground is then hollow, or plane; a pass is not.
inline bool hollow(const Face& nw, const Face& ne, const Face& sw, const Face& se) {
    const bool along_rows = (ne.rise_east >= nw.rise_east) & (se.rise_east >= sw.rise_east);
    const bool along_columns = (sw.rise_south >= nw.rise_south) & (se.rise_south >= ne.rise_south);
    const bool falling = se.rise_east + se.rise_south >= nw.rise_east + nw.rise_south;
    const bool rising = sw.rise_south - sw.rise_east >= ne.rise_south - ne.rise_east;
    return along_rows & along_columns & falling & rising;
}

// Of the cone about the four unit normals: the squared distance from its axis, itself of unit length, to the
// farthest of them, 2 - 2 cos theta; 0 where hollow.
inline float squared_chord(const Face& nw, const Face& ne, const Face& sw, const Face& se) {
    const auto middle = [](float a, float b, float c, float d) {
        return std::max(std::max(a, b), std::max(c, d)) + std::min(std::min(a, b), std::min(c, d));
    };
    const float x = middle(nw.east, ne.east, sw.east, se.east);
    const float y = middle(nw.south, ne.south, sw.south, se.south);
    const float z = middle(nw.up, ne.up, sw.up, se.up);
    const float shrink = 1.0f / std::sqrt(x * x + y * y + z * z);
    const auto from_axis = [=](const Face& face) {
        const float dx = face.east - x * shrink, dy = face.south - y * shrink, dz = face.up - z * shrink;
        return dx * dx + dy * dy + dz * dz;
    };
    const float farthest =
        std::max(std::max(from_axis(nw), from_axis(ne)), std::max(from_axis(sw), from_axis(se)));
    return hollow(nw, ne, sw, se) ? 0.0f : farthest;
}

class VertexMetric {
  public:
    // Geometric.
    VertexMetric() = default;
    // info: spacing and quantum.
    VertexMetric(Metric metric, const io::TerrainInfo& info);

    Metric metric() const { return metric_; }
    bool has_cones() const { return metric_ == Metric::cone; }
    // Of the lattice of step 2^scale.
    const ConeScale& cones(int scale) const { return scales_[static_cast<std::size_t>(scale)]; }

  private:
    Metric metric_ = Metric::geometric;
    std::array<ConeScale, 32> scales_{};
};

}  // namespace ridgeline::build
