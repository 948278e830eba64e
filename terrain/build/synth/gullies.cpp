// R. S. Johansen, "Fast and gorgeous erosion filter" (blog.runevision.com), after C. John's and Fewes's
// shaders: around each point of a jittered lattice stands a plane wave whose crests follow the slope at the
// sample, and waves of neighbouring points are blended. Each octave sees the slopes that the one before has
// made, so furrows feed larger furrows, as tributaries do.
//
// How we differ: the blended wave is normalised towards equal depth, so that furrows neither fade between
// points nor pile up, and the slopes carried on are those of the wave along its own direction alone.
#include "gullies.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "noise.h"

namespace ridgeline::synth {
namespace {

// Points lie within this part of their cell, and reach this far, in cells: never past the 3×3 cells around.
constexpr float kJitter = 0.8f;
constexpr float kReach = 1.1f;

// Slopes between which furrows grow from nothing to their full depth.
constexpr float kFlat = 0.01f;
constexpr float kSteep = 0.25f;
// Blended waves shorter than this are left short rather than blown up out of nothing.
constexpr float kLeastLength = 0.35f;

constexpr float kTau = 6.2831853f;

// Rounds to the nearest whole number: adding 1.5·2²³ leaves no room for a fraction.
float whole(float x) { return (x + 12582912.0f) - 12582912.0f; }

// sin(2πt) within 0.001, by two parabolas.
float sine_of_turns(float turns) {
    const float t = turns - whole(turns);
    const float parabola = t * (8.0f - 16.0f * std::abs(t));
    return parabola * (0.775f + 0.225f * std::abs(parabola));
}

}  // namespace

// Samples worked on together: plain arrays, so that every loop over lanes becomes vector code.
struct Gullies::Batch {
    template <class T>
    using Lanes = std::array<T, kLanes>;

    Lanes<float> x, y;  // in cells
    Lanes<float> steepness;
    Lanes<float> along_x, along_y;  // unit vector along the contour
    Lanes<int> point;               // index of the cell's own point
    Lanes<float> weight{}, cosine{}, sine{};
    Lanes<float> height_m, slope;  // what the octave adds, the slope along the contour
};

Gullies::Gullies(const GullyOctave& octave, const SampleArea& area, float spacing_m)
    : octave_(octave), cells_per_sample_(spacing_m / octave.wavelength_m) {
    first_column_ = cell_of(area.column) - 1;
    first_row_ = cell_of(area.row) - 1;
    columns_ = cell_of(area.column + area.columns - 1) - first_column_ + 2;
    const int rows = cell_of(area.row + area.rows - 1) - first_row_ + 2;
    for (int row = first_row_; row < first_row_ + rows; ++row) {
        for (int column = first_column_; column < first_column_ + columns_; ++column) {
            const std::uint32_t h = hash(column, row, octave.seed);
            points_x_.push_back(static_cast<float>(column) + 0.5f + kJitter * (unit_interval(h) - 0.5f));
            points_y_.push_back(static_cast<float>(row) + 0.5f +
                                kJitter * (unit_interval(hash(h + 1)) - 0.5f));
        }
    }
}

int Gullies::cell_of(int sample) const {
    return static_cast<int>(std::floor(static_cast<float>(sample) * cells_per_sample_));
}

void Gullies::place(Batch& batch, const SampleRow& row, std::size_t first) const {
    const std::size_t last = row.heights_m.size() - 1;
    const float y = static_cast<float>(row.row) * cells_per_sample_;
    const int points_row = (cell_of(row.row) - first_row_) * columns_ - first_column_;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        // Lanes past the end work on the last sample; nobody reads them.
        const std::size_t i = std::min(first + lane, last);
        const int column = row.first_column + static_cast<int>(i);
        const float slope_x = row.slopes_x[i];
        const float slope_y = row.slopes_y[i];
        batch.x[lane] = static_cast<float>(column) * cells_per_sample_;
        batch.y[lane] = y;
        batch.point[lane] = points_row + cell_of(column);
        batch.steepness[lane] = std::sqrt(slope_x * slope_x + slope_y * slope_y) + 1e-6f;
        batch.along_x[lane] = -slope_y / batch.steepness[lane];
        batch.along_y[lane] = slope_x / batch.steepness[lane];
    }
}

void Gullies::add_point(Batch& batch, int column_offset, int row_offset) const {
    const int offset = row_offset * columns_ + column_offset;
    Batch::Lanes<float> point_x;
    Batch::Lanes<float> point_y;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        point_x[lane] = points_x_[static_cast<std::size_t>(batch.point[lane] + offset)];
        point_y[lane] = points_y_[static_cast<std::size_t>(batch.point[lane] + offset)];
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const float x = batch.x[lane] - point_x[lane];
        const float y = batch.y[lane] - point_y[lane];
        const float nearness = 1.0f - (x * x + y * y) * (1.0f / (kReach * kReach));
        const float weight = nearness > 0.0f ? nearness * nearness : 0.0f;
        // One wave a cell.
        const float turns = x * batch.along_x[lane] + y * batch.along_y[lane];
        batch.weight[lane] += weight;
        batch.cosine[lane] += weight * sine_of_turns(turns + 0.25f);
        batch.sine[lane] += weight * sine_of_turns(turns);
    }
}

void Gullies::blend(Batch& batch) const {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const float mean = 1.0f / (batch.weight[lane] + 1e-4f);
        const float cosine = batch.cosine[lane] * mean;
        const float sine = batch.sine[lane] * mean;
        const float length = std::sqrt(cosine * cosine + sine * sine);
        // None on flat ground, less than in proportion on the steepest.
        const float steepness = batch.steepness[lane];
        const float ramp = (steepness - kFlat) * (1.0f / (kSteep - kFlat));
        const float t = ramp < 0.0f ? 0.0f : ramp > 1.0f ? 1.0f : ramp;
        const float depth = octave_.strength * (steepness / (1.0f + 0.8f * steepness)) * t * t *
                            (3.0f - 2.0f * t) / (length > kLeastLength ? length : kLeastLength);
        batch.height_m[lane] = depth * octave_.wavelength_m * cosine;
        batch.slope[lane] = -depth * kTau * sine;
    }
}

void Gullies::carve(const SampleRow& row) const {
    for (std::size_t first = 0; first < row.heights_m.size(); first += kLanes) {
        Batch batch;
        place(batch, row, first);
        for (int b = -1; b <= 1; ++b)
            for (int a = -1; a <= 1; ++a) add_point(batch, a, b);
        blend(batch);
        const std::size_t used = std::min<std::size_t>(kLanes, row.heights_m.size() - first);
        for (std::size_t lane = 0; lane < used; ++lane) {
            row.heights_m[first + lane] += batch.height_m[lane];
            row.slopes_x[first + lane] += batch.slope[lane] * batch.along_x[lane];
            row.slopes_y[first + lane] += batch.slope[lane] * batch.along_y[lane];
        }
    }
}

}  // namespace ridgeline::synth
