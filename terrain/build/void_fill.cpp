// Literature: Gortler, Grzeszczuk, Szeliski and Cohen, "The lumigraph" (1996), section 3.4: pull-push
// interpolation of scattered samples. We keep its saturated weights and tent kernels; new is the split into a
// global coarse part and local fine parts whose windows agree, so that memory stays a 64th of the raster's.
#include "ridgeline/build/void_fill.h"

#include <algorithm>
#include <cmath>

#include "ridgeline/base/contract.h"
#include "ridgeline/build/samples.h"

namespace ridgeline::build {
namespace {

constexpr int kEighth = 8;

// A weighted sum of neighbours under the tent [1 2 1] x [1 2 1] / 4: the tent's volume is that of a coarse
// cell in fine ones, so a neighbourhood that is valid to a quarter has full weight.
struct Tent {
    float weight = 0.0f;
    float sum = 0.0f;

    void add(float factor, float mean, float w) {
        weight += factor * w;
        sum += factor * w * mean;
    }
    float mean() const { return weight > 0.0f ? sum / weight : 0.0f; }
    float saturated() const { return std::min(weight, 1.0f); }
};

template <class Size>
Tent gather(const std::vector<float>& mean, const std::vector<float>& weight, Size columns, Size rows, Size x,
            Size y) {
    constexpr float kFactor[3] = {0.5f, 1.0f, 0.5f};
    Tent tent;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const Size nx = x + dx, ny = y + dy;
            if (nx < 0 || ny < 0 || nx >= columns || ny >= rows) continue;
            const auto at = static_cast<std::size_t>(ny * columns + nx);
            tent.add(kFactor[dx + 1] * kFactor[dy + 1], mean[at], weight[at]);
        }
    return tent;
}

// Bilinear between the points of a coarse lattice, at a point of the next finer one; value(x, y) clamps.
template <class Size, class Value>
float between(Size x, Size y, Value&& value) {
    const Size x0 = x >> 1, y0 = y >> 1, x1 = (x + 1) >> 1, y1 = (y + 1) >> 1;
    return 0.25f * ((value(x0, y0) + value(x1, y0)) + (value(x0, y1) + value(x1, y1)));
}

float blend(float mean, float weight, float below) { return weight * mean + (1.0f - weight) * below; }

void push_window(const VoidFill::Scratch::Lattice& fine, VoidFill::Scratch::Lattice& coarse) {
    coarse.size = fine.size / 2 + 1;
    const auto count = static_cast<std::size_t>(coarse.size) * static_cast<std::size_t>(coarse.size);
    coarse.mean.resize(count);
    coarse.weight.resize(count);
    for (int y = 0, at = 0; y < coarse.size; ++y)
        for (int x = 0; x < coarse.size; ++x, ++at) {
            const Tent tent = gather(fine.mean, fine.weight, fine.size, fine.size, 2 * x, 2 * y);
            coarse.mean[static_cast<std::size_t>(at)] = tent.mean();
            coarse.weight[static_cast<std::size_t>(at)] = tent.saturated();
        }
}

void take_samples(std::span<const std::int32_t> quanta, std::span<const std::uint8_t> flags,
                  VoidFill::Scratch::Lattice& lattice) {
    lattice.size = kWindow;
    lattice.mean.resize(quanta.size());
    lattice.weight.resize(quanta.size());
    for (std::size_t i = 0; i < quanta.size(); ++i) {
        const bool valid = (flags[i] & sample::kValid) != 0;
        lattice.mean[i] = valid ? static_cast<float>(quanta[i]) : 0.0f;
        lattice.weight[i] = valid ? 1.0f : 0.0f;
    }
}

// Turns a lattice's means into filled values, from the filled coarser one.
void pull_window(const VoidFill::Scratch::Lattice& coarse, VoidFill::Scratch::Lattice& fine) {
    const auto value = [&](int x, int y) {
        return coarse.mean[static_cast<std::size_t>(y * coarse.size + x)];
    };
    for (int y = 0, at = 0; y < fine.size; ++y)
        for (int x = 0; x < fine.size; ++x, ++at) {
            const auto i = static_cast<std::size_t>(at);
            if (fine.weight[i] < 1.0f)
                fine.mean[i] = blend(fine.mean[i], fine.weight[i], between(x, y, value));
        }
}

}  // namespace

WindowFrame::WindowFrame(const io::Grid& grid, io::LatticePoint block_origin)
    : west(block_origin.x - kWindowApron), north(block_origin.y - kWindowApron) {
    first_x = static_cast<int>(std::max<std::int64_t>(0, -west));
    first_y = static_cast<int>(std::max<std::int64_t>(0, -north));
    last_x = static_cast<int>(std::min<std::int64_t>(kWindow, grid.width() - west));
    last_y = static_cast<int>(std::min<std::int64_t>(kWindow, grid.height() - north));
}

VoidFill::VoidFill(const io::Grid& grid) {
    // One point past the raster where its size is no multiple: windows interpolate up to there.
    eighth_.columns = (grid.width() - 2) / kEighth + 2;
    eighth_.rows = (grid.height() - 2) / kEighth + 2;
    const auto count = static_cast<std::size_t>(eighth_.columns * eighth_.rows);
    eighth_.mean.resize(count);
    eighth_.weight.resize(count);
}

void VoidFill::set_means(const BlockGrid& blocks, std::int64_t block, std::span<const std::int32_t> quanta,
                         std::span<const std::uint8_t> flags, Scratch& scratch) {
    take_samples(quanta, flags, scratch.lattices[0]);
    for (int k = 0; k < 3; ++k) push_window(scratch.lattices[k], scratch.lattices[k + 1]);
    const Scratch::Lattice& eighth = scratch.lattices[3];
    const io::LatticePoint origin = blocks.origin(block);
    const std::int64_t column = origin.x / kEighth, row = origin.y / kEighth;
    const std::int64_t last_column = blocks.last_column(block) ? eighth_.columns : column + kBlock / kEighth;
    const std::int64_t last_row = blocks.last_row(block) ? eighth_.rows : row + kBlock / kEighth;
    for (std::int64_t y = row; y < last_row; ++y)
        for (std::int64_t x = column; x < last_column; ++x) {
            const auto to = static_cast<std::size_t>(y * eighth_.columns + x);
            const auto from = static_cast<std::size_t>((y - row + kWindowApron / kEighth) * eighth.size + x -
                                                       column + kWindowApron / kEighth);
            eighth_.mean[to] = eighth.mean[from];
            eighth_.weight[to] = eighth.weight[from];
        }
}

VoidFill::Lattice VoidFill::push(const Lattice& fine) {
    Lattice coarse{fine.columns / 2 + 1, fine.rows / 2 + 1, {}, {}};
    for (std::int64_t y = 0; y < coarse.rows; ++y)
        for (std::int64_t x = 0; x < coarse.columns; ++x) {
            const Tent tent = gather(fine.mean, fine.weight, fine.columns, fine.rows, 2 * x, 2 * y);
            coarse.mean.push_back(tent.mean());
            coarse.weight.push_back(tent.saturated());
        }
    return coarse;
}

void VoidFill::pull(const Lattice& coarse, Lattice& fine) {
    const auto value = [&](std::int64_t x, std::int64_t y) {
        return coarse.mean[static_cast<std::size_t>(std::min(y, coarse.rows - 1) * coarse.columns +
                                                    std::min(x, coarse.columns - 1))];
    };
    for (std::int64_t y = 0, at = 0; y < fine.rows; ++y)
        for (std::int64_t x = 0; x < fine.columns; ++x, ++at) {
            const auto i = static_cast<std::size_t>(at);
            fine.mean[i] = blend(fine.mean[i], fine.weight[i], between(x, y, value));
        }
}

// On the coarsest lattice, of at most 2 x 2 points, what is missing takes the mean of the rest.
void VoidFill::settle(Lattice& coarsest) {
    Tent all;
    for (std::size_t i = 0; i < coarsest.mean.size(); ++i)
        all.add(1.0f, coarsest.mean[i], coarsest.weight[i]);
    for (std::size_t i = 0; i < coarsest.mean.size(); ++i)
        coarsest.mean[i] = blend(coarsest.mean[i], coarsest.weight[i], all.mean());
}

void VoidFill::finish() {
    std::vector<Lattice> lattices(1);
    std::swap(lattices.front(), eighth_);
    while (lattices.back().columns > 2 || lattices.back().rows > 2) lattices.push_back(push(lattices.back()));
    settle(lattices.back());
    for (std::size_t k = lattices.size() - 1; k > 0; --k) pull(lattices[k], lattices[k - 1]);
    std::swap(lattices.front(), eighth_);
    eighth_.weight = {};
}

void VoidFill::fill_window(const WindowFrame& frame, std::span<std::int32_t> quanta,
                           std::span<const std::uint8_t> flags, Scratch& scratch) const {
    RIDGELINE_CHECK(eighth_.weight.empty());
    take_samples(quanta, flags, scratch.lattices[0]);
    for (int k = 0; k < 2; ++k) push_window(scratch.lattices[k], scratch.lattices[k + 1]);
    Scratch::Lattice& eighth = scratch.lattices[3];
    eighth.size = scratch.lattices[2].size / 2 + 1;
    eighth.mean.clear();
    for (std::int64_t y = 0; y < eighth.size; ++y)
        for (std::int64_t x = 0; x < eighth.size; ++x) {
            const std::int64_t column =
                std::clamp<std::int64_t>(frame.west / kEighth + x, 0, eighth_.columns - 1);
            const std::int64_t row = std::clamp<std::int64_t>(frame.north / kEighth + y, 0, eighth_.rows - 1);
            eighth.mean.push_back(eighth_.mean[static_cast<std::size_t>(row * eighth_.columns + column)]);
        }
    for (int k = 2; k >= 0; --k) pull_window(scratch.lattices[k + 1], scratch.lattices[k]);
    for (int y = frame.first_y; y < frame.last_y; ++y)
        for (int x = frame.first_x; x < frame.last_x; ++x) {
            const auto i = static_cast<std::size_t>(y * kWindow + x);
            if ((flags[i] & sample::kValid) == 0)
                quanta[i] = static_cast<std::int32_t>(std::floor(scratch.lattices[0].mean[i] + 0.5f));
        }
}

}  // namespace ridgeline::build
