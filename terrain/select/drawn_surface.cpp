#include "ridgeline/select/drawn_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ridgeline/shaders/lib/morph.h"

namespace ridgeline::select {
namespace {

using io::ChunkVertex;
using io::IndexRange;
using io::Side;

// Rounding must not let a place on the edge of two triangles fall between them.
constexpr double kOnEdge = 1e-9;

// Twice the signed area, in samples; positive where a, b, c run counter-clockwise seen from above (rows run
// south).
double twice_area(double ax, double ay, double bx, double by, double cx, double cy) {
    return (cx - ax) * (by - ay) - (bx - ax) * (cy - ay);
}

// Weights of the triangle's corners at a place, or nothing if it lies outside.
bool weigh(std::span<const ChunkVertex> vertices, double column, double row, ChunkPlace& place) {
    double x[3], y[3];
    for (int i = 0; i < 3; ++i) {
        x[i] = vertices[place.vertex[i]].x();
        y[i] = vertices[place.vertex[i]].y;
    }
    if (column < std::min({x[0], x[1], x[2]}) || column > std::max({x[0], x[1], x[2]})) return false;
    const double whole = twice_area(x[0], y[0], x[1], y[1], x[2], y[2]);
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        place.weight[i] = twice_area(column, row, x[j], y[j], x[k], y[k]) / whole;
        if (place.weight[i] < -kOnEdge) return false;
    }
    return true;
}

std::optional<ChunkPlace> locate_in(const io::ChunkView& chunk, std::span<const IndexRange> ranges,
                                    double column, double row) {
    const auto vertices = chunk.vertices();
    const auto indices = chunk.indices();
    ChunkPlace place;
    for (const IndexRange& range : ranges)
        for (std::uint32_t i = range.first; i < range.first + range.count; i += 3) {
            std::copy_n(indices.begin() + i, 3, place.vertex);
            if (weigh(vertices, column, row, place)) return place;
        }
    return {};
}

int quarter_at(double half, double column, double row) {
    return (column >= half ? 1 : 0) + (row >= half ? 2 : 0);
}

// Whether a triangle's box comes within `reach` of a place, in samples.
bool comes_near(const ChunkVertex* const (&corners)[3], const glm::dvec2& place, const glm::dvec2& reach) {
    glm::dvec2 least(corners[0]->x(), corners[0]->y), most = least;
    for (const ChunkVertex* corner : {corners[1], corners[2]}) {
        least = glm::min(least, glm::dvec2(corner->x(), corner->y));
        most = glm::max(most, glm::dvec2(corner->x(), corner->y));
    }
    return glm::all(glm::lessThanEqual(least, place + reach)) &&
           glm::all(glm::lessThanEqual(place - reach, most));
}

// A triangle's part in a square about the eye: cut by one of its sides after the other (Sutherland and
// Hodgman, "Reentrant polygon clipping", 1974), each of which adds a corner at most.
struct ClippedTriangle {
    std::array<glm::dvec3, 3 + 4> corners;
    std::size_t count = 0;

    // Keeps what lies at `sign` * axis <= reach.
    void clip(int axis, double sign, double reach) {
        const auto beyond = [&](const glm::dvec3& p) { return sign * p[axis] - reach; };
        const ClippedTriangle whole = *this;
        count = 0;
        for (std::size_t i = 0; i < whole.count; ++i) {
            const glm::dvec3 &from = whole.corners[i], &to = whole.corners[(i + 1) % whole.count];
            const double at = beyond(from), next = beyond(to);
            if (at <= 0.0) corners[count++] = from;
            if ((at < 0.0 && next > 0.0) || (at > 0.0 && next < 0.0))
                corners[count++] = glm::mix(from, to, at / (at - next));
        }
    }
};

// The highest place of a triangle in a square about the eye; minus infinity where they do not meet.
double highest_in_square_m(const ChunkVertex* const (&corners)[3], const EyeFrame& eye,
                           const DrawEntry& entry, double reach_m) {
    ClippedTriangle part;
    for (const ChunkVertex* corner : corners)
        part.corners[part.count++] =
            glm::dvec3(drawn_vertex(eye, entry.origin, entry.morph, *corner).position_m);
    for (const int axis : {0, 1})
        for (const double sign : {-1.0, 1.0}) part.clip(axis, sign, reach_m);
    double highest_m = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < part.count; ++i) highest_m = std::max(highest_m, part.corners[i].z);
    return highest_m;
}

}  // namespace

// What shaders/passes/terrain.vert does, with the same functions.
DrawnVertex drawn_vertex(const EyeFrame& eye, const glm::ivec2& origin, const MorphTable& morph,
                         const ChunkVertex& vertex) {
    const glm::vec4 rest(eye.cell_rest, eye.quanta_rest, 0.0f), scale(eye.spacing_m, eye.quantum_m, 0.0f);
    const glm::ivec2 lattice = origin + glm::ivec2(vertex.x(), vertex.y);
    const int quanta = vertex.quanta - eye.quanta;
    const auto& [ramp, bias, fade] = morph[static_cast<std::size_t>(vertex.morph_class())];
    const glm::vec3 own = shaders::position_from_eye(lattice, static_cast<float>(quanta), rest, scale);
    const float omega = shaders::morph_weight({ramp, bias, fade}, shaders::distance_from_eye(own));
    const float morphed = shaders::morphed_quanta(quanta, vertex.delta, omega);
    return {shaders::position_from_eye(lattice, morphed, rest, scale), omega};
}

io::NodeId node_at_place(const io::Grid& grid, int level, double column, double row) {
    const auto side = static_cast<double>(grid.extent(level));
    return {level, std::min(static_cast<std::int32_t>(column / side), grid.nodes_x(level) - 1),
            std::min(static_cast<std::int32_t>(row / side), grid.nodes_y(level) - 1)};
}

int quarter_at_place(const io::Grid& grid, const io::NodeId& node, const glm::dvec2& place) {
    const io::LatticePoint origin = grid.origin(node);
    return quarter_at(static_cast<double>(grid.extent(node.level)) / 2.0,
                      place.x - static_cast<double>(origin.x), place.y - static_cast<double>(origin.y));
}

std::optional<ChunkPlace> locate(const io::ChunkView& chunk, int extent, double column, double row) {
    const io::ChunkRanges& ranges = chunk.ranges();
    const int quarter = quarter_at(extent / 2.0, column, row);
    std::array<IndexRange, 1 + io::kSides> list{ranges.inside[quarter]};
    for (int s = 0; s < io::kSides; ++s) list[static_cast<std::size_t>(1 + s)] = ranges.plain[quarter][s];
    return locate_in(chunk, list, column, row);
}

std::optional<ChunkPlace> locate(const io::ChunkView& chunk, const DrawEntry& entry, const io::Grid& grid,
                                 double column, double row) {
    const io::LatticePoint origin = grid.origin(entry.node);
    const double x = column - static_cast<double>(origin.x), y = row - static_cast<double>(origin.y);
    const int quarter = quarter_at_place(grid, entry.node, {column, row});
    if ((entry.quarters >> quarter & 1) == 0) return {};
    return locate_in(chunk, quarter_ranges(chunk.ranges(), entry, quarter), x, y);
}

double mesh_quanta(const io::ChunkView& chunk, const ChunkPlace& place) {
    const auto vertices = chunk.vertices();
    double quanta = 0.0;
    for (int i = 0; i < 3; ++i) quanta += place.weight[i] * vertices[place.vertex[i]].quanta;
    return quanta;
}

double drawn_height_m(const io::ChunkView& chunk, const EyeFrame& eye, const DrawEntry& entry,
                      const ChunkPlace& place) {
    const auto vertices = chunk.vertices();
    double height_m = 0.0;
    for (int i = 0; i < 3; ++i) {
        const DrawnVertex drawn = drawn_vertex(eye, entry.origin, entry.morph, vertices[place.vertex[i]]);
        height_m += place.weight[i] * static_cast<double>(drawn.position_m.z);
    }
    return height_m;
}

double highest_about_m(const io::ChunkView& chunk, const EyeFrame& eye, const DrawEntry& entry,
                       double reach_m) {
    const glm::dvec2 place = glm::dvec2(-entry.origin) + glm::dvec2(eye.cell_rest);
    const glm::dvec2 reach = reach_m / glm::dvec2(eye.spacing_m);
    const auto vertices = chunk.vertices();
    const auto indices = chunk.indices();
    double highest_m = -std::numeric_limits<double>::infinity();
    for (int quarter = 0; quarter < io::kQuarters; ++quarter)
        for (const IndexRange& range : quarter_ranges(chunk.ranges(), entry, quarter))
            for (std::uint32_t i = range.first; i < range.first + range.count; i += 3) {
                const ChunkVertex* const corners[3] = {&vertices[indices[i]], &vertices[indices[i + 1]],
                                                       &vertices[indices[i + 2]]};
                if (!comes_near(corners, place, reach)) continue;
                highest_m = std::max(highest_m, highest_in_square_m(corners, eye, entry, reach_m));
            }
    return highest_m;
}

std::array<IndexRange, 1 + io::kSides> quarter_ranges(const io::ChunkRanges& ranges, const DrawEntry& entry,
                                                      int quarter) {
    std::array<IndexRange, 1 + io::kSides> list{};
    if ((entry.quarters >> quarter & 1) == 0) return list;
    list[0] = ranges.inside[quarter];
    for (int s = 0; s < io::kSides; ++s) {
        const auto side = static_cast<std::size_t>(s);
        const SideUse use = entry.sides[static_cast<std::size_t>(quarter)][side];
        if (use == SideUse::plain) list[1 + side] = ranges.plain[quarter][s];
        if (use == SideUse::fan) list[1 + side] = ranges.fan[quarter][s];
    }
    return list;
}

void border_polyline(const io::ChunkView& chunk, const EyeFrame& eye, const DrawEntry& entry,
                     const io::Grid& grid, int quarter, Side side, std::vector<BorderPoint>& points) {
    points.clear();
    const auto half = static_cast<std::uint32_t>(grid.extent(entry.node.level) / 2);
    const bool runs_south = side == Side::west || side == Side::east;
    const auto first = runs_south ? quarter & 1 : quarter >> 1;
    const bool far_side = side == Side::east || side == Side::south;
    const std::uint32_t across = half * static_cast<std::uint32_t>(first + (far_side ? 1 : 0));
    const io::LatticePoint origin = grid.origin(entry.node);
    const auto vertices = chunk.vertices();
    const auto indices = chunk.indices();
    const IndexRange range =
        quarter_ranges(chunk.ranges(), entry, quarter)[static_cast<std::size_t>(1 + io::index(side))];
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
        const ChunkVertex& vertex = vertices[indices[i]];
        if ((runs_south ? vertex.x() : vertex.y) != across) continue;
        points.push_back({{origin.x + vertex.x(), origin.y + vertex.y},
                          drawn_vertex(eye, entry.origin, entry.morph, vertex).position_m});
    }
    // Two triangles give most points, each as its own chunk's vertex; points that differ in space both stay.
    std::sort(points.begin(), points.end(), [](const BorderPoint& a, const BorderPoint& b) {
        return std::pair(a.place.x + a.place.y, a.position_m.z) <
               std::pair(b.place.x + b.place.y, b.position_m.z);
    });
    points.erase(std::unique(points.begin(), points.end()), points.end());
}

}  // namespace ridgeline::select
