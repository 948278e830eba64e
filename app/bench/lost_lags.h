// How rough ground is at the lags that decimation loses, eastwards: mean squared differences of height, for holding ground that was
// made against ground that was there.
//
// Plain values; any thread.
#pragma once

#include <array>
#include <span>

namespace ridgeline::app {

class LostLags {
  public:
    static constexpr int kLags = 3;

    // Of 1, 2 and 4 samples.
    static constexpr int samples(int lag) { return 1 << lag; }

    // Heights of side x side neighbouring samples, row by row, of the same place.
    void add(std::span<const double> real_m, std::span<const double> made_m, int side);

    // Of the made ground's differences over the real one's; 0 where that has none.
    double ratio(int lag) const;

  private:
    std::array<double, kLags> real_{}, made_{};
};

}  // namespace ridgeline::app
