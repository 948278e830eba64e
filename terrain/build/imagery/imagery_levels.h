// The levels of an imagery pyramid while rows go through it: of each, the few rows that its next tiles need.
//
// Rows of the finest level come from outside; whoever makes the tiles of a row of nodes has their texels'
// means at hand and gives them to the next coarser level, which is ready for a row of its own every two. So
// memory is that of a few hundred rows, twice, however tall the picture. Thread rules: cut() and give() for
// different nodes of the rows under way from any threads; all else from one, filling meanwhile.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ridgeline/build/imagery/texel_rows.h"
#include "ridgeline/io/grid.h"

namespace ridgeline::build {

// The nodes of a level that lie side by side.
struct NodeRow {
    int level = 0;
    std::int32_t y = 0;
};

class ImageryLevels {
  public:
    ImageryLevels(std::int64_t width, std::int64_t height);

    const io::Grid& grid() const { return grid_; }

    // How many of the finest rows the next row of nodes needs beyond those that were filled; 0 at the end.
    std::int64_t finest_rows_to_fill() const;
    // Room for the first of them, as many as lie in one piece, while rows of nodes are worked on; they count
    // once they are filled().
    std::span<Texel> finest_to_fill(std::int64_t rows);
    void filled(std::int64_t rows);
    // All rows of nodes that are ready and were not returned before, coarsest first. What they give to
    // coarser levels counts once they are done(), which is due before the next call.
    std::vector<NodeRow> next();
    void done(const std::vector<NodeRow>& rows);
    // Every row of nodes was returned.
    bool complete() const;

    // The node's texels with the gutter, kImageryTexels² of them; beyond the lattice the nearest repeat.
    void cut(io::NodeId node, std::span<Texel> texels) const;
    // The node's means, as halve() makes them of what cut() gave, to the next coarser level, if there is one.
    void give(io::NodeId node, std::span<const Texel> means);

    // What all this takes for a picture of that width.
    static std::uint64_t memory_bytes(std::int64_t width);

  private:
    struct Level {
        std::int64_t width = 0, height = 0;
        std::int64_t capacity = 0;  // rows
        std::int64_t ready = 0;     // rows that are complete
        std::int32_t next_y = 0;    // the row of nodes that is to be returned next
        std::vector<Texel> texels;

        Texel* row(std::int64_t y) { return &texels[static_cast<std::size_t>(y % capacity * width)]; }
        const Texel* row(std::int64_t y) const {
            return &texels[static_cast<std::size_t>(y % capacity * width)];
        }
    };
    Level& level(int l) { return levels_[static_cast<std::size_t>(l)]; }
    const Level& level(int l) const { return levels_[static_cast<std::size_t>(l)]; }

    io::Grid grid_;
    std::vector<Level> levels_;
};

}  // namespace ridgeline::build
