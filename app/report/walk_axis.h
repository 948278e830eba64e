// What all charts have across: the time of the walk. Pure, any thread.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ridgeline/app/report/axis.h"
#include "ridgeline/app/report/run_folder.h"

namespace ridgeline::app::report {

// Headless, equal times of equal paths are equal places, so runs compare frame by frame.
struct WalkAxis {
    Axis axis;
    Unit unit = Unit::seconds;  // or frames, where a run has no times
    int columns = 1;            // of a chart's picture
};

// Over all runs. Nothing where no run has frames.
std::optional<WalkAxis> walk_axis(std::span<const RunFolder> runs);
// Where each frame of a run is on it.
std::vector<double> places_on(const WalkAxis& walk, const FrameTable& frames);

}  // namespace ridgeline::app::report
