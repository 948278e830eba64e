#include "ridgeline/build/fine_vertices.h"

#include <algorithm>

namespace ridgeline::build {
namespace {

constexpr std::int64_t kRow = kBlock + kExactApron + 1;

std::uint32_t place_of(std::int64_t column, std::int64_t row) {
    return static_cast<std::uint32_t>(row * kRow + column);
}
bool on_border(std::int64_t along) { return along % kBlock == 0; }

}  // namespace

void FineVertices::set(std::int64_t block, const BlockWindow& window, const BlockLevels& levels) {
    std::vector<FineVertex>& kept = by_block_[static_cast<std::size_t>(block)];
    const int top = blocks_.top_level();
    const int columns = blocks_.last_column(block) ? kBlock + kExactApron + 1 : kBlock;
    const int rows = blocks_.last_row(block) ? kBlock + kExactApron + 1 : kBlock;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const std::uint8_t level = levels.at(column, row);
            const int limit = on_border(column) || on_border(row) ? top : top - 1;
            if (level > limit || ((column | row) & 7) == 0) continue;
            kept.push_back({place_of(column, row), window.quanta()[BlockWindow::at(column, row)], level});
        }
    kept.shrink_to_fit();
}

const FineVertex* FineVertices::find(io::LatticePoint point) const {
    const std::int64_t block = blocks_.block_of(point);
    const io::LatticePoint origin = blocks_.origin(block);
    const std::int64_t column = point.x - origin.x, row = point.y - origin.y;
    if (column >= kRow || row >= kRow) return nullptr;
    const auto& vertices = by_block_[static_cast<std::size_t>(block)];
    const std::uint32_t place = place_of(column, row);
    const auto found =
        std::lower_bound(vertices.begin(), vertices.end(), place,
                         [](const FineVertex& vertex, std::uint32_t p) { return vertex.place < p; });
    return found != vertices.end() && found->place == place ? &*found : nullptr;
}

}  // namespace ridgeline::build
