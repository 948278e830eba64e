// Windows about the eye that are addressed modulo their size: Tanner, Migdal, Jones, "The Clipmap: A Virtual
// Mipmap", SIGGRAPH 1998. There they hold texels; here they hold the way to them.
#include "ridgeline/render/page_table.h"

#include <algorithm>
#include <bit>

#include "ridgeline/base/contract.h"
#include "ridgeline/shaders/shared/imagery_uniforms.h"

namespace ridgeline::render {

glm::ivec2 PageTable::bits_for(const io::Grid& grid) {
    // Level 0 is looked up wherever the eye stands on it: twice its nodes.
    const auto bits = [](int nodes) {
        return std::max(kLeastWindowBits,
                        1 + static_cast<int>(std::bit_width(static_cast<unsigned>(nodes - 1))));
    };
    return {bits(grid.nodes_x(0)), bits(grid.nodes_y(0))};
}

std::uint64_t PageTable::bytes(const io::Grid& grid) {
    const glm::ivec2 bits = bits_for(grid);
    return (std::uint64_t{sizeof(std::uint32_t)} << (bits.x + bits.y)) *
           static_cast<std::uint64_t>(grid.levels());
}

PageTable::PageTable(const io::Grid& grid, std::size_t slots, int tile_bits)
    : grid_(grid),
      tile_bits_(tile_bits),
      window_bits_(bits_for(grid)),
      begins_(static_cast<std::size_t>(grid.levels())),
      roots_(static_cast<std::size_t>(grid.first(1))),
      children_(slots),
      entries_(level_begin(grid.levels())),
      changed_(static_cast<std::size_t>(grid.levels() * rows()), 1) {
    const glm::ivec2 half(columns() / 2, rows() / 2);
    std::ranges::fill(begins_, -half);
}

PageTable::Nodes PageTable::window(int level) const {
    const glm::ivec2 begin = begins_[static_cast<std::size_t>(level)];
    return {begin, begin + glm::ivec2(columns(), rows())};
}

std::uint32_t& PageTable::own(io::NodeId node) {
    if (node.level == 0) return roots_[static_cast<std::size_t>(grid_.linear(node))];
    const std::uint32_t parent = own(node.parent());
    RIDGELINE_CHECK(parent != 0);
    return children_[parent - 1][static_cast<std::size_t>(node.quarter())];
}

std::optional<std::uint32_t> PageTable::slot_of(io::NodeId node) const {
    const io::NodeId root{0, node.x >> node.level, node.y >> node.level};
    std::uint32_t slot = roots_[static_cast<std::size_t>(grid_.linear(root))];
    for (int above = node.level - 1; above >= 0 && slot != 0; --above)
        slot =
            children_[slot - 1][static_cast<std::size_t>((node.x >> above & 1) + 2 * (node.y >> above & 1))];
    return slot == 0 ? std::nullopt : std::optional(slot - 1);
}

// A node's parent is in its window, because both stand about the same place; what names another tile for it says that
// it is not there, nor the node.
std::uint32_t PageTable::found(io::NodeId node) {
    if (!grid_.contains(node)) return 0;
    const auto coarseness = static_cast<std::uint32_t>(grid_.finest() - node.level);
    std::uint32_t above = 0, slot = 0;
    if (node.level == 0) {
        slot = roots_[static_cast<std::size_t>(grid_.linear(node))];
    } else {
        above = entry(node.level - 1, {node.x >> 1, node.y >> 1});
        if (above >> shaders::kPageCoarsenessShift == coarseness + 1)
            slot = children_[(above & shaders::kPageSlotMask) - 1][static_cast<std::size_t>(node.quarter())];
    }
    return slot == 0 ? above : slot | coarseness << shaders::kPageCoarsenessShift;
}

// The parents' entries must be right.
void PageTable::refresh(int level, const Nodes& nodes) {
    for (int y = nodes.begin.y; y < nodes.end.y; ++y)
        for (int x = nodes.begin.x; x < nodes.end.x; ++x) {
            std::uint32_t& before = entry(level, {x, y});
            const std::uint32_t now = found({level, x, y});
            if (before == now) continue;
            before = now;
            changed(level, y & (rows() - 1)) = 1;
        }
}

void PageTable::refresh_below(io::NodeId node) {
    Nodes below{{node.x, node.y}, {node.x + 1, node.y + 1}};
    for (int level = node.level; level < grid_.levels(); ++level) {
        const Nodes shown = window(level);
        refresh(level, {glm::max(below.begin, shown.begin), glm::min(below.end, shown.end)});
        below = {below.begin * 2, below.end * 2};
    }
}

void PageTable::insert(io::NodeId node, std::uint32_t slot) {
    RIDGELINE_CHECK(slot < shaders::kPageSlotMask && slot < children_.size());
    children_[slot] = {};
    own(node) = slot + 1;
    refresh_below(node);
}

void PageTable::remove(io::NodeId node) {
    own(node) = 0;
    refresh_below(node);
}

// What enters the window takes the place of what leaves it.
void PageTable::move_window(int level, const glm::ivec2& begin) {
    const Nodes before = window(level);
    begins_[static_cast<std::size_t>(level)] = begin;
    const Nodes now = window(level);
    const glm::ivec2 kept_begin = glm::max(before.begin, now.begin), kept_end = glm::min(before.end, now.end);
    if (kept_begin.x >= kept_end.x || kept_begin.y >= kept_end.y) return refresh(level, now);
    refresh(level, {now.begin, {now.end.x, kept_begin.y}});
    refresh(level, {{now.begin.x, kept_end.y}, now.end});
    refresh(level, {{now.begin.x, kept_begin.y}, {kept_begin.x, kept_end.y}});
    refresh(level, {{kept_end.x, kept_begin.y}, {now.end.x, kept_end.y}});
}

void PageTable::look_from(const glm::ivec2& cell) {
    const glm::ivec2 half(columns() / 2, rows() / 2);
    for (int level = 0; level < grid_.levels(); ++level) {
        const int shift = tile_bits_ + grid_.finest() - level;
        const glm::ivec2 begin = glm::ivec2(cell.x >> shift, cell.y >> shift) - half;
        if (begin != begins_[static_cast<std::size_t>(level)]) move_window(level, begin);
    }
}

}  // namespace ridgeline::render
