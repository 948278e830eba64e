#include "ridgeline/select/finest_nodes.h"

#include <algorithm>
#include <cmath>

#include "ridgeline/select/terrain_frame.h"

namespace ridgeline::select {

void find_finest_within(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                        const View& view, double metres, std::vector<io::NodeId>& nodes) {
    nodes.clear();
    const io::Grid grid = info.grid();
    const int level = grid.finest();
    TerrainFrame frame(info, records);
    frame.set_view(view, {});
    // In nodes' sides; one more, for what rounding loses.
    const auto side = static_cast<double>(grid.extent(level));
    const glm::dvec2 eye = info.lattice(view.eye_m.x, view.eye_m.y) / side;
    const glm::dvec2 reach = metres / (side * glm::dvec2(info.spacing_x_m, info.spacing_y_m)) + 1.0;
    const glm::dvec2 last(grid.nodes_x(level) - 1, grid.nodes_y(level) - 1);
    const glm::ivec2 from(glm::clamp(glm::floor(eye - reach), glm::dvec2(0.0), last));
    const glm::ivec2 to(glm::clamp(glm::floor(eye + reach), glm::dvec2(0.0), last));
    for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x) {
            const Visit node = visit(grid, {level, x, y});
            if (frame.record(node.index).has_data() && frame.distance_m(node) < metres)
                nodes.push_back(node.node);
        }
}

}  // namespace ridgeline::select
