// How high the bumps below the source are to be: foretold from the source's own finest octaves (synthesis paper 3.2,
// where the amplitudes are the author's choice).
//
// A sample's residual is how far it lies beside what is interpolated from every second sample. Its size over spacings
// has a trend, which goes on; its share of slope and roughness is fitted at the finest spacing; and each octave's gains
// are set so that the ground made so far gets bumps of the size foretold (docs/detail.md). Pure; any thread.
#pragma once

#include <span>

#include "ridgeline/detail/detail_tile.h"
#include "ridgeline/io/detail_info.h"

namespace ridgeline::detail {

// Metres of height a unit of the windows' heights, and of a quantum, whose rounding is no roughness.
struct CalibrationUnits {
    double unit_m = 1.0;
    double quantum_m = 1.0;
};

// windows: source tiles in finer units (make_root), all of them valid; none: every gain is 0. The same windows in the
// same order give the same numbers.
io::DetailInfo calibrate(std::span<const DetailTile> windows, const CalibrationUnits& units);

}  // namespace ridgeline::detail
