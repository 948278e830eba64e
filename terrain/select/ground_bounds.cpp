#include "ridgeline/select/ground_bounds.h"

#include <algorithm>

#include "ridgeline/base/contract.h"

namespace ridgeline::select {
namespace {

GroundRectangle extent(const io::TerrainInfo& info) {
    return {{info.min_east_m(), info.min_north_m()}, {info.max_east_m(), info.max_north_m()}};
}

// The node of a level that holds a place so many node sides from the lattice's corner.
std::int32_t held_by(double sides, std::int32_t nodes) {
    return static_cast<std::int32_t>(std::clamp(sides, 0.0, nodes - 1.0));
}

}  // namespace

GroundBounds::GroundBounds(const io::TerrainInfo& info, std::span<const io::NodeRecord> records)
    : grid_(info.grid()),
      records_(records),
      terrain_(extent(info)),
      offset_m_(info.height_offset_m),
      quantum_m_(info.quantum_m) {
    RIDGELINE_CHECK(records.size() == static_cast<std::size_t>(grid_.node_count()));
    for (int level = 0; level < grid_.levels(); ++level)
        side_m_[static_cast<std::size_t>(level)] =
            static_cast<double>(grid_.extent(level)) * glm::dvec2(info.spacing_x_m, info.spacing_y_m);
}

int GroundBounds::level_for(const glm::dvec2& size_m) const {
    int level = grid_.finest();
    while (level > 0 &&
           glm::any(glm::lessThan(side_m_[static_cast<std::size_t>(level)], size_m * (1.0 - 1e-9))))
        --level;
    return level;
}

std::optional<GroundBounds::Quanta> GroundBounds::of(const GroundRectangle& area, int level) const {
    const glm::dvec2& side = side_m_[static_cast<std::size_t>(level)];
    const std::int32_t columns = grid_.nodes_x(level), rows = grid_.nodes_y(level);
    const std::int32_t west = held_by((area.min.x - terrain_.min.x) / side.x, columns);
    const std::int32_t east = held_by((area.max.x - terrain_.min.x) / side.x, columns);
    const std::int32_t north = held_by((terrain_.max.y - area.max.y) / side.y, rows);
    const std::int32_t south = held_by((terrain_.max.y - area.min.y) / side.y, rows);
    std::optional<Quanta> bounds;
    for (std::int32_t y = north; y <= south; ++y)
        for (std::int32_t x = west; x <= east; ++x) {
            const io::NodeRecord& r = records_[static_cast<std::size_t>(grid_.linear({level, x, y}))];
            if (!r.has_data()) continue;
            if (!bounds) bounds = {r.min_quanta, r.max_quanta};
            bounds->lowest = std::min(bounds->lowest, r.min_quanta);
            bounds->highest = std::max(bounds->highest, r.max_quanta);
        }
    return bounds;
}

}  // namespace ridgeline::select
