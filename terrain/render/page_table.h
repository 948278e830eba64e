// The page table of a virtual texture, imagery or heights: which slot holds the finest resident tile at or
// above a node.
//
// A table for all nodes would grow with the imagery; this one holds, of every level, a window of nodes about
// the eye, addressed modulo its size, so that what stays in it stays in place as the eye moves. An entry
// names the node's own tile or its nearest resident ancestor's: a lookup is one fetch, and a change of
// residency touches the entries below the tile, in as many windows as there are levels below it. Level 0's
// window holds all of it. No GL: pure book-keeping, which terrain/render/virtual_texture.cpp copies to the
// GPU row by row. One thread at a time; after construction nothing allocates.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "ridgeline/io/grid.h"
#include "ridgeline/shaders/shared/imagery_uniforms.h"

namespace ridgeline::render {

class PageTable {
  public:
    // Nodes a window's side at least: 16 of them in every direction, so that the window is never what limits
    // the picture up to 4096 pixels per radian.
    static constexpr int kLeastWindowBits = 6;

    // slots: that tiles can be in. tile_bits: log2 of a tile's finest texels, that is of the grid's quads.
    PageTable(const io::Grid& grid, std::size_t slots, int tile_bits = shaders::kTileTexelBits);

    // Log2 of a window's columns and rows.
    const glm::ivec2& window_bits() const { return window_bits_; }
    int columns() const { return 1 << window_bits_.x; }
    int rows() const { return 1 << window_bits_.y; }
    static std::uint64_t bytes(const io::Grid& grid);

    // Puts the windows about a place of the lattice, in finest texels.
    void look_from(const glm::ivec2& cell);
    // Slots below 65535. A node's parent must be there before it, and leave after it.
    void insert(io::NodeId node, std::uint32_t slot);
    void remove(io::NodeId node);
    // Of the node's own tile, wherever the windows are.
    std::optional<std::uint32_t> slot_of(io::NodeId node) const;

    // The entries of a level, row by row, as shaders/shared/imagery_uniforms.h packs them.
    std::span<const std::uint32_t> entries(int level) const {
        return std::span(entries_).subspan(level_begin(level), level_size());
    }
    // Calls visit(level, first row, row count) for every run of rows that changed since the last call.
    template <class Visit>
    void take_changes(Visit visit) {
        for (int level = 0; level < grid_.levels(); ++level)
            for (int row = 0; row < rows();) row = take_run(level, row, visit);
    }

  private:
    // Nodes of a level: [begin, end) in both directions.
    struct Nodes {
        glm::ivec2 begin{0};
        glm::ivec2 end{0};
    };
    static glm::ivec2 bits_for(const io::Grid& grid);

    std::size_t level_size() const {
        return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows());
    }
    std::size_t level_begin(int level) const { return static_cast<std::size_t>(level) * level_size(); }
    std::uint32_t& entry(int level, const glm::ivec2& node) {
        const int column = node.x & (columns() - 1), row = node.y & (rows() - 1);
        return entries_[level_begin(level) + static_cast<std::size_t>(row * columns() + column)];
    }
    std::uint8_t& changed(int level, int row) {
        return changed_[static_cast<std::size_t>(level * rows() + row)];
    }
    Nodes window(int level) const;
    // Where the slot of a node's own tile, and one, is kept: with its parent's.
    std::uint32_t& own(io::NodeId node);
    std::uint32_t found(io::NodeId node);
    void refresh(int level, const Nodes& nodes);
    void refresh_below(io::NodeId node);
    void move_window(int level, const glm::ivec2& begin);

    template <class Visit>
    int take_run(int level, int row, Visit& visit) {
        const int first = row;
        while (row < rows() && changed(level, row)) changed(level, row++) = 0;
        if (row == first) return row + 1;
        visit(level, first, row - first);
        return row;
    }

    io::Grid grid_;
    int tile_bits_;
    glm::ivec2 window_bits_;
    std::vector<glm::ivec2> begins_;  // of the windows, by level
    // The tree of what is there, as slots and one, 0 without: of level 0 in linear order, and of the children of what
    // is in a slot. It grows with the slots, not with the nodes.
    std::vector<std::uint32_t> roots_;
    std::vector<std::array<std::uint32_t, io::kQuarters>> children_;
    std::vector<std::uint32_t> entries_;
    std::vector<std::uint8_t> changed_;  // by level and row
};

}  // namespace ridgeline::render
