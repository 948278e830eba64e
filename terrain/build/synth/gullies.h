// Gullies and spurs on hillsides, finer than the drained landscape: one octave of furrows that run downhill.
//
// Built for one rectangle of samples and then applied row by row; a value depends on its position and seed
// alone, never on the rectangle. Not shared between threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ridgeline::synth {

struct GullyOctave {
    float wavelength_m = 100.0f;
    float strength = 0.1f;  // depth on steep ground, as a share of the wavelength
    std::uint32_t seed = 1;
};

// A rectangle of samples.
struct SampleArea {
    int column = 0;
    int row = 0;
    int columns = 0;
    int rows = 0;
};

// Some samples of one row: heights and slopes (rise per metre east and south), changed in place. Sample
// (column, row) lies at (column, row) * spacing_m, rows southwards.
struct SampleRow {
    int first_column = 0;
    int row = 0;
    float spacing_m = 1.0f;
    std::span<float> heights_m;
    std::span<float> slopes_x;
    std::span<float> slopes_y;
};

class Gullies {
  public:
    // For samples of `area`, which lie spacing_m apart.
    Gullies(const GullyOctave& octave, const SampleArea& area, float spacing_m);

    void carve(const SampleRow& row) const;

  private:
    static constexpr int kLanes = 16;
    struct Batch;
    int cell_of(int sample) const;
    void place(Batch& batch, const SampleRow& row, std::size_t first) const;
    void add_point(Batch& batch, int column_offset, int row_offset) const;
    void blend(Batch& batch) const;

    GullyOctave octave_;
    float cells_per_sample_;
    int first_column_;
    int first_row_;
    int columns_;
    // The lattice's points, jittered within their cells, in cells.
    std::vector<float> points_x_;
    std::vector<float> points_y_;
};

}  // namespace ridgeline::synth
