// A level's surface at a sample that its mesh lacks is the mean of the ends of the hypotenuse that the sample
// would halve (docs/store.md); no triangle need be looked at.
#include "ridgeline/app/bench/surface_field.h"

#include <cmath>
#include <limits>

namespace ridgeline::app {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

}  // namespace

SurfaceField::SurfaceField(const io::Store& store)
    : store_(store), reader_(store), stride_(store.grid().nodes_x(0) * store.grid().extent(0) + 1) {
    const std::int64_t rows = store.grid().nodes_y(0) * store.grid().extent(0) + 1;
    heights_m_.assign(static_cast<std::size_t>(stride_ * rows), kNone);
}

Result<void> SurfaceField::take_samples() {
    const io::Grid& grid = store_.grid();
    for (std::int64_t i = grid.first(grid.finest()); i < grid.node_count(); ++i) {
        const io::NodeId node = grid.node_at(i);
        if (!store_.record(node).has_data()) continue;
        RIDGELINE_TRY(store_.read_heights(node, tile_bytes_, tile_));
        const io::LatticePoint origin = grid.origin(node);
        for (int row = 0; row <= tile_.quads; ++row)
            for (int column = 0; column <= tile_.quads; ++column) {
                const std::size_t from = tile_.at(column, row);
                const bool valid = tile_.all_valid || tile_.sample_valid[from] != 0;
                point(origin.x + column, origin.y + row) =
                    valid ? static_cast<float>(store_.info().height_m(tile_.quanta[from])) : kNone;
            }
    }
    return {};
}

Result<void> SurfaceField::take_mesh(io::NodeId node) {
    const io::NodeRecord& record = store_.record(node);
    if (!record.has_data()) return {};
    const io::Grid& grid = store_.grid();
    RIDGELINE_TRY(reader_.read(node, chunk_));
    const io::LatticePoint origin = grid.origin(node);
    clear(origin, grid.extent(node.level));
    for (const io::ChunkVertex& vertex : chunk_.view.vertices())
        point(origin.x + vertex.x(), origin.y + vertex.y) =
            static_cast<float>(store_.info().height_m(vertex.quanta));
    interpolate(origin, grid.extent(node.level));
    return {};
}

Result<void> SurfaceField::take_level(int level) {
    const io::Grid& grid = store_.grid();
    for (std::int64_t i = grid.first(level); i < grid.first(level + 1); ++i)
        RIDGELINE_TRY(take_mesh(grid.node_at(i)));
    return {};
}

void SurfaceField::clear(io::LatticePoint origin, std::int64_t extent) {
    for (std::int64_t row = 0; row <= extent; ++row)
        std::fill_n(&point(origin.x, origin.y + row), extent + 1, kNone);
}

// Coarse scales before fine ones, centres before edge vertices: the ends are always there.
void SurfaceField::interpolate(io::LatticePoint origin, std::int64_t extent) {
    const auto fill = [this](std::int64_t x, std::int64_t y, std::int64_t dx, std::int64_t dy) {
        float& height = point(x, y);
        if (std::isnan(height)) height = 0.5f * (point(x - dx, y - dy) + point(x + dx, y + dy));
    };
    for (std::int64_t s = extent / 2; s >= 1; s /= 2) {
        for (std::int64_t y = origin.y + s; y < origin.y + extent; y += 2 * s)
            for (std::int64_t x = origin.x + s; x < origin.x + extent; x += 2 * s)
                fill(x, y, s, ((x / s) & 3) == ((y / s) & 3) ? s : -s);
        for (std::int64_t y = origin.y; y <= origin.y + extent; y += 2 * s)
            for (std::int64_t x = origin.x + s; x < origin.x + extent; x += 2 * s) fill(x, y, s, 0);
        for (std::int64_t y = origin.y + s; y < origin.y + extent; y += 2 * s)
            for (std::int64_t x = origin.x; x <= origin.x + extent; x += 2 * s) fill(x, y, 0, s);
    }
}

}  // namespace ridgeline::app
