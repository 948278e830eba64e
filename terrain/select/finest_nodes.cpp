#include "ridgeline/select/finest_nodes.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "ridgeline/select/terrain_frame.h"

namespace ridgeline::select {
namespace {

bool is_nearer(const NearNode& a, const NearNode& b) {
    return std::tie(a.distance_m, a.node.y, a.node.x) < std::tie(b.distance_m, b.node.y, b.node.x);
}

}  // namespace

void find_finest_within(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                        const View& view, const NodeReach& reach, std::size_t most,
                        std::vector<NearNode>& nodes) {
    nodes.clear();
    const io::Grid grid = info.grid();
    const int level = grid.finest();
    TerrainFrame frame(info, records);
    frame.set_view(view, {});
    // In nodes' sides; one more, for what rounding loses.
    const auto side = static_cast<double>(grid.extent(level));
    const glm::dvec2 eye = info.lattice(view.eye_m.x, view.eye_m.y) / side;
    const glm::dvec2 sides = reach.most_m / (side * glm::dvec2(info.spacing_x_m, info.spacing_y_m)) + 1.0;
    const glm::dvec2 last(grid.nodes_x(level) - 1, grid.nodes_y(level) - 1);
    const glm::ivec2 from(glm::clamp(glm::floor(eye - sides), glm::dvec2(0.0), last));
    const glm::ivec2 to(glm::clamp(glm::floor(eye + sides), glm::dvec2(0.0), last));
    for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x) {
            const Visit at = visit(grid, {level, x, y});
            const io::NodeRecord& record = frame.record(at.index);
            if (!record.has_data()) continue;
            const double distance_m = frame.distance_m(at);
            if (distance_m <
                std::clamp(reach.by_error * static_cast<double>(record.error_m), reach.least_m, reach.most_m))
                nodes.push_back({at.node, distance_m});
        }
    const auto kept = nodes.begin() + static_cast<std::ptrdiff_t>(std::min(most, nodes.size()));
    std::partial_sort(nodes.begin(), kept, nodes.end(), is_nearer);
    nodes.erase(kept, nodes.end());
}

}  // namespace ridgeline::select
