#include "ridgeline/build/thresholds.h"

#include <algorithm>

#include "ridgeline/base/contract.h"

namespace ridgeline::build {
namespace {

void add_to(Histogram& sum, const Histogram& histogram) {
    for (std::size_t code = 0; code < sum.size(); ++code) sum[code] += histogram[code];
}

Histogram above_thresholds(const Histogram& by_code) {
    Histogram above{};
    for (std::size_t code = by_code.size() - 1; code > 0; --code)
        above[code - 1] = above[code] + by_code[code];
    return above;
}

void widen(Histogram& most, const Histogram& by_code) {
    const Histogram above = above_thresholds(by_code);
    for (std::size_t code = 0; code < most.size(); ++code) most[code] = std::max(most[code], above[code]);
}

// The histograms of the parents of a columns x rows array of nodes.
std::vector<Histogram> merge_children(const std::vector<Histogram>& nodes, std::int64_t columns,
                                      std::int64_t rows) {
    const std::int64_t parent_columns = (columns + 1) / 2;
    std::vector<Histogram> parents(static_cast<std::size_t>(parent_columns * ((rows + 1) / 2)), Histogram{});
    for (std::int64_t y = 0, at = 0; y < rows; ++y)
        for (std::int64_t x = 0; x < columns; ++x, ++at)
            add_to(parents[static_cast<std::size_t>(y / 2 * parent_columns + x / 2)],
                   nodes[static_cast<std::size_t>(at)]);
    return parents;
}

}  // namespace

BlockCounts::BlockCounts(const io::Grid& grid, const BlockGrid& blocks)
    : quads_(grid.quads()),
      nodes_a_side_(kBlock / quads_),
      nodes_(static_cast<std::size_t>(nodes_a_side_) * static_cast<std::size_t>(nodes_a_side_)),
      most_(static_cast<std::size_t>(grid.finest() - blocks.top_level() + 1)) {
    clear();
}

void BlockCounts::clear() {
    for (Histogram& histogram : nodes_) histogram.fill(0);
    for (Histogram& histogram : most_) histogram.fill(0);
    whole_.fill(0);
}

void BlockCounts::add_phase(const Phases<std::uint8_t>& shape, const std::vector<std::uint8_t>& phase,
                            int first, int cells) {
    const int node_cells = cells / nodes_a_side_;
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < nodes_a_side_; ++column) {
            Histogram& histogram = node(column, row / node_cells);
            const std::uint8_t* codes = &phase[shape.at(first + column * node_cells, first + row)];
            for (int i = 0; i < node_cells; ++i) ++histogram[codes[i]];
        }
}

void BlockCounts::add_fine(const VertexErrors& errors) {
    for (int scale = 0; scale < kFineScales; ++scale) {
        const auto& codes = errors.codes[scale];
        for (const auto* phase : {&codes.x, &codes.y, &codes.centre})
            add_phase(codes, *phase, first_cell(scale), block_cells(scale));
    }
}

void BlockCounts::add_coarse(const CoarseLattice& lattice, io::LatticePoint block_origin) {
    lattice.for_each_code(block_origin, kBlock, [&](std::int64_t x, std::int64_t y, std::uint8_t code) {
        ++node(static_cast<int>((x - block_origin.x) / quads_),
               static_cast<int>((y - block_origin.y) / quads_))[code];
    });
}

void BlockCounts::finish() {
    std::vector<Histogram> nodes = nodes_;
    for (std::size_t level = 0, side = static_cast<std::size_t>(nodes_a_side_); level < most_.size();
         ++level, side /= 2) {
        if (level > 0)
            nodes = merge_children(nodes, static_cast<std::int64_t>(2 * side),
                                   static_cast<std::int64_t>(2 * side));
        for (const Histogram& histogram : nodes) widen(most_[level], histogram);
    }
    for (const Histogram& histogram : nodes) add_to(whole_, histogram);
}

Thresholds::Thresholds(const io::Grid& grid, const BlockGrid& blocks, const VertexBudget& budget)
    : grid_(grid),
      blocks_(blocks),
      budget_(budget),
      block_counts_(static_cast<std::size_t>(blocks.count()), Histogram{}) {
    for (auto& most : most_)
        most.assign(static_cast<std::size_t>(grid.finest() - blocks.top_level() + 1), Histogram{});
}

void Thresholds::add(std::int64_t block, Part part, const BlockCounts& counts) {
    add_to(block_counts_[static_cast<std::size_t>(block)], counts.whole());
    auto& most = most_[static_cast<std::size_t>(part)];
    for (std::size_t level = 0; level < most.size(); ++level)
        for (std::size_t code = 0; code < kErrorCodes; ++code)
            most[level][code] = std::max(most[level][code], counts.most()[level][code]);
}

std::vector<Histogram> Thresholds::most_in_coarse_levels() const {
    std::vector<Histogram> most(static_cast<std::size_t>(blocks_.top_level()), Histogram{});
    std::vector<Histogram> nodes = block_counts_;
    std::int64_t columns = blocks_.columns(), rows = blocks_.rows();
    for (int level = blocks_.top_level() - 1; level >= 0; --level) {
        nodes = merge_children(nodes, columns, rows);
        columns = (columns + 1) / 2;
        rows = (rows + 1) / 2;
        for (const Histogram& histogram : nodes) widen(most[static_cast<std::size_t>(level)], histogram);
    }
    return most;
}

std::vector<std::uint8_t> Thresholds::choose(const std::vector<std::int64_t>& nodes) const {
    std::array<std::int64_t, kErrorCodes> above{};
    for (const Histogram& histogram : block_counts_) {
        const Histogram above_here = above_thresholds(histogram);
        for (std::size_t code = 0; code < above.size(); ++code) above[code] += above_here[code];
    }
    const std::vector<Histogram> coarse = most_in_coarse_levels();
    const auto most = [&](int level, std::size_t code) {
        if (level < blocks_.top_level()) return std::int64_t{coarse[static_cast<std::size_t>(level)][code]};
        const auto fineness = static_cast<std::size_t>(grid_.finest() - level);
        return std::int64_t{most_[0][fineness][code]} + most_[1][fineness][code];
    };
    std::vector<std::uint8_t> thresholds(static_cast<std::size_t>(grid_.levels()));
    std::size_t code = 0;
    for (int level = grid_.finest(); level >= 0; --level) {
        const std::int64_t allowed = budget_.mean * nodes[static_cast<std::size_t>(level)];
        // The greatest code leaves out every vertex.
        while (code + 1 < kErrorCodes && (above[code] > allowed || most(level, code) > budget_.most)) ++code;
        thresholds[static_cast<std::size_t>(level)] = static_cast<std::uint8_t>(code);
    }
    return thresholds;
}

}  // namespace ridgeline::build
