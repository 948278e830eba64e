// The horizon paper bounds chunks by the simplification's own error; a propagated error is no bound on the
// distance between surfaces (we measured 1.5 to 2.3 times as much). So every level's surface is rebuilt and
// compared at every sample, which rows of floats make cheap.
#include "ridgeline/build/surface_errors.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ridgeline::build {
namespace {

constexpr int kCells = kBlock / 2;  // of scale 1

float larger(float a, float b) { return a < b ? b : a; }

// The surface along a row of vertices whose hypotenuse ends lie in rows a and b.
void surface_row(const std::uint8_t* levels, std::uint8_t level, const float* heights, const float* a,
                 const float* b, int count, float* __restrict surface, int step) {
    for (int i = 0; i < count; ++i) {
        const float mean = 0.5f * (a[i] + b[i]);
        surface[i * step] = levels[i] <= level ? heights[i] : mean;
    }
}

// The mean of a centre's hypotenuse ends; `falling` alternates between 1 and 0, which keeps products exact.
float diagonal_mean(const float* upper, const float* lower, int i, float falling) {
    const float falls = 0.5f * (upper[i] + lower[i + 1]);
    const float rises = 0.5f * (upper[i + 1] + lower[i]);
    return falling * falls + (1.0f - falling) * rises;
}
float falling_factor(int i, int row) { return falls_eastwards(i, row) ? 1.0f : 0.0f; }

// Widens most by the distance of means from heights, where the level lacks the vertex.
void widen_row(const std::uint8_t* levels, std::uint8_t level, const float* heights, const float* a,
               const float* b, int count, float* __restrict most) {
    for (int i = 0; i < count; ++i) {
        const float error = std::fabs(0.5f * (a[i] + b[i]) - heights[i]);
        most[i] = larger(most[i], levels[i] > level ? error : 0.0f);
    }
}

// From coarse to fine, sets every vertex of a lattice that `lacks` holds for to the mean of its hypotenuse's
// ends. extent is that of the squares whose corners are known, in the lattice's steps.
template <class Size, class Surface, class Lacks>
void interpolate(Size extent, Size columns, Size rows, Surface&& at, Lacks&& lacks) {
    for (Size s = extent / 2; s > 0; s /= 2)
        for (Size y = 0; y < rows; y += s)
            for (Size x = 0; x < columns; x += s) {
                const bool odd_x = (x / s & 1) != 0, odd_y = (y / s & 1) != 0;
                if ((!odd_x && !odd_y) || !lacks(x, y)) continue;
                const bool falls = (((x ^ y) / s) & 2) == 0;
                const Size dx = odd_x ? s : 0, dy = !odd_y ? 0 : !odd_x || falls ? s : -s;
                at(x, y) = (at(x - dx, y - dy) + at(x + dx, y + dy)) / 2;
            }
}

// The block's part of a lattice of errors, as floats above `base`.
void to_block_floats(const Phases<std::int32_t>& from, int first, int cells, std::int32_t base,
                     Phases<float>& to) {
    to.resize(cells);
    const auto copy = [&](const std::vector<std::int32_t>& source, std::vector<float>& target) {
        for (int row = 0; row <= cells; ++row) {
            const std::int32_t* in = &source[from.at(first, first + row)];
            float* out = &target[to.at(0, row)];
            for (int i = 0; i <= cells; ++i) out[i] = static_cast<float>(in[i] - base);
        }
    };
    copy(from.even, to.even);
    copy(from.x, to.x);
    copy(from.y, to.y);
    copy(from.centre, to.centre);
}

}  // namespace

CornerSurfaces::CornerSurfaces(const io::Grid& grid, const BlockGrid& blocks, const CoarseLattice& lattice,
                               const Levels& levels)
    : columns_(std::max(grid.nodes_x(0) * grid.extent(0) / kBlock, blocks.columns()) + 1),
      rows_(std::max(grid.nodes_y(0) * grid.extent(0) / kBlock, blocks.rows()) + 1) {
    std::vector<double> heights;
    for (std::int64_t row = 0; row < rows_; ++row)
        for (std::int64_t column = 0; column < columns_; ++column)
            heights.push_back(lattice.quanta(column * kBlock, row * kBlock));
    // Levels whose nodes lie within blocks hold every block's corners; they share one entry.
    surfaces_.assign(static_cast<std::size_t>(blocks.top_level()) + 1, heights);
    for (int level = 0; level < blocks.top_level(); ++level) {
        auto& surface = surfaces_[static_cast<std::size_t>(level)];
        const auto at = [&](std::int64_t x, std::int64_t y) -> double& {
            return surface[static_cast<std::size_t>(y * columns_ + x)];
        };
        interpolate(grid.extent(0) / kBlock, columns_, rows_, at, [&](std::int64_t x, std::int64_t y) {
            return lattice.level(levels, x * kBlock, y * kBlock) > level;
        });
    }
}

std::array<double, 4> CornerSurfaces::at(int level, io::LatticePoint block_origin) const {
    const auto& surface = surfaces_[std::min(static_cast<std::size_t>(level), surfaces_.size() - 1)];
    const auto first = static_cast<std::size_t>(block_origin.y / kBlock * columns_ + block_origin.x / kBlock);
    const auto below = first + static_cast<std::size_t>(columns_);
    return {surface[first], surface[first + 1], surface[below], surface[below + 1]};
}

void SurfaceErrors::set_block(const VertexErrors& errors, const BlockLevels& levels, const Bounds& bounds,
                              bool all_valid) {
    levels_ = &levels;
    const Phases<std::int32_t>& eighth = errors.heights[kFineScales - 1];
    constexpr int kFirstEighth = first_cell(kFineScales - 1);
    const std::int32_t base =
        eighth.even[eighth.at(kFirstEighth + kEighths / 2, kFirstEighth + kEighths / 2)];
    base_ = base;
    for (int scale = 0; scale < kFineScales; ++scale)
        to_block_floats(errors.heights[scale], first_cell(scale), block_cells(scale), base, heights_[scale]);
    eighth_heights_.clear();
    for (int row = 0; row <= kEighths; ++row)
        for (int column = 0; column <= kEighths; ++column)
            eighth_heights_.push_back(
                static_cast<float>(eighth.even[eighth.at(kFirstEighth + column, kFirstEighth + row)] - base));

    judged_ = levels.phases[0];
    even_valid_.assign(errors.codes[0].even.size(), 1);
    if (!all_valid) {
        const Phases<std::uint8_t>& flags = errors.flags[0];
        for (std::size_t i = 0; i < even_valid_.size(); ++i) {
            even_valid_[i] = flags.even[i] & 1;
            judged_.x[i] = static_cast<std::uint8_t>(judged_.x[i] * (flags.x[i] & 1));
            judged_.y[i] = static_cast<std::uint8_t>(judged_.y[i] * (flags.y[i] & 1));
            judged_.centre[i] = static_cast<std::uint8_t>(judged_.centre[i] * (flags.centre[i] & 1));
        }
    }

    range_ = std::max(std::abs(static_cast<double>(bounds.least) - base_),
                      std::abs(static_cast<double>(bounds.greatest) - base_));
}

void SurfaceErrors::find_eighth_surface(std::uint8_t level, const std::array<double, 4>& corners) {
    std::vector<float>& surface = surface_[0];
    surface = eighth_heights_;
    constexpr int kSide = kEighths + 1, kFirst = kErrorApron / 8, kLevelSide = kErrorCells / 8 + 1;
    const auto at = [&](int column, int row) -> float& {
        return surface[static_cast<std::size_t>(row * kSide + column)];
    };
    for (int corner = 0; corner < 4; ++corner)
        at(corner % 2 * kEighths, corner / 2 * kEighths) =
            static_cast<float>(corners[static_cast<std::size_t>(corner)] - base_);
    interpolate(kEighths, kSide, kSide, at, [&](int x, int y) {
        return levels_->eighth[static_cast<std::size_t>((y + kFirst) * kLevelSide + x + kFirst)] > level;
    });
}

void SurfaceErrors::refine(int scale, std::uint8_t level, const std::vector<float>& coarse,
                           std::vector<float>& fine) const {
    const Phases<float>& heights = heights_[scale];
    const Phases<std::uint8_t>& levels = levels_->phases[scale];
    const int cells = heights.cells, first = first_cell(scale), side = 2 * cells + 1;
    fine.resize(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (int row = 0; row <= cells; ++row) {
        const float* upper = &coarse[heights.at(0, row)];
        float* out = &fine[static_cast<std::size_t>(2 * row * side)];
        for (int i = 0; i <= cells; ++i) out[2 * i] = upper[i];
        surface_row(&levels.x[levels.at(first, first + row)], level, &heights.x[heights.at(0, row)], upper,
                    upper + 1, cells, out + 1, 2);
        if (row == cells) break;
        const float* lower = &coarse[heights.at(0, row + 1)];
        out += side;
        surface_row(&levels.y[levels.at(first, first + row)], level, &heights.y[heights.at(0, row)], upper,
                    lower, cells + 1, out, 2);
        const std::uint8_t* centre_levels = &levels.centre[levels.at(first, first + row)];
        const float* centre_heights = &heights.centre[heights.at(0, row)];
        for (int i = 0; i < cells; ++i) {
            const float mean = diagonal_mean(upper, lower, i, falling_factor(i, row));
            out[2 * i + 1] = centre_levels[i] <= level ? centre_heights[i] : mean;
        }
    }
}

void SurfaceErrors::widen_even_row(int row, std::uint8_t level) {
    const Phases<float>& heights = heights_[0];
    const int first = first_cell(0);
    const float* surface = &surface_[2][heights.at(0, row)];
    const float* even = &heights.even[heights.at(0, row)];
    const std::uint8_t* valid = &even_valid_[judged_.at(first, first + row)];
    for (int i = 0; i <= kCells; ++i) {
        const float error = std::fabs(surface[i] - even[i]);
        even_most_[static_cast<std::size_t>(i)] =
            larger(even_most_[static_cast<std::size_t>(i)], valid[i] != 0 ? error : 0.0f);
    }
    widen_row(&judged_.x[judged_.at(first, first + row)], level, &heights.x[heights.at(0, row)], surface,
              surface + 1, kCells, odd_most_.data());
}

void SurfaceErrors::widen_odd_row(int row, std::uint8_t level) {
    const Phases<float>& heights = heights_[0];
    const int first = first_cell(0);
    const float *upper = &surface_[2][heights.at(0, row)], *lower = &surface_[2][heights.at(0, row + 1)];
    widen_row(&judged_.y[judged_.at(first, first + row)], level, &heights.y[heights.at(0, row)], upper, lower,
              kCells + 1, even_most_.data());
    const std::uint8_t* levels = &judged_.centre[judged_.at(first, first + row)];
    const float* centre = &heights.centre[heights.at(0, row)];
    float* __restrict most = odd_most_.data();
    for (int i = 0; i < kCells; ++i) {
        const float error = std::fabs(diagonal_mean(upper, lower, i, falling_factor(i, row)) - centre[i]);
        most[i] = larger(most[i], levels[i] > level ? error : 0.0f);
    }
}

void SurfaceErrors::close_nodes(int nodes_a_side, float* errors) {
    const int cells = kCells / nodes_a_side;
    for (int node = 0; node < nodes_a_side; ++node) {
        const auto even = even_most_.begin() + node * cells, odd = odd_most_.begin() + node * cells;
        const float most =
            larger(*std::max_element(even, even + cells + 1), *std::max_element(odd, odd + cells));
        errors[node] = most + slack_;
    }
    std::fill(even_most_.begin(), even_most_.end(), 0.0f);
    std::fill(odd_most_.begin(), odd_most_.end(), 0.0f);
}

void SurfaceErrors::measure(int level, const std::array<double, 4>& corners, int nodes_a_side,
                            std::vector<float>& errors) {
    const auto coarsest = static_cast<std::uint8_t>(level);
    double range = range_;
    for (const double corner : corners) range = std::max(range, std::abs(corner - base_));
    // Each mean rounds by half a unit in the last place (2^-24 of the range), two a scale from the block's
    // extent down; as much again for taking heights and corners as floats.
    slack_ = static_cast<float>(range * std::ldexp(2.0 * (std::bit_width(unsigned{kBlock}) + 2), -24));
    find_eighth_surface(coarsest, corners);
    refine(2, coarsest, surface_[0], surface_[1]);
    refine(1, coarsest, surface_[1], surface_[2]);
    errors.resize(static_cast<std::size_t>(nodes_a_side) * static_cast<std::size_t>(nodes_a_side));
    even_most_.assign(kCells + 1, 0.0f);
    odd_most_.assign(kCells, 0.0f);
    const int node_cells = kCells / nodes_a_side;
    for (int row = 0; row <= kCells; ++row) {
        widen_even_row(row, coarsest);
        if (row > 0 && row % node_cells == 0) {
            // The row between two nodes belongs to both.
            close_nodes(nodes_a_side,
                        &errors[static_cast<std::size_t>((row / node_cells - 1) * nodes_a_side)]);
            widen_even_row(row, coarsest);
        }
        if (row < kCells) widen_odd_row(row, coarsest);
    }
}

}  // namespace ridgeline::build
