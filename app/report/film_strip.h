// The pictures of a walk in a row, each with a line to the moment when it was taken, to stand above a chart
// over time.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "ridgeline/app/report/curve_chart.h"
#include "ridgeline/app/report/run_folder.h"

namespace ridgeline::app::report {

// Where pictures of one width begin, as shares of the row, in order and none over another: as near to being
// centred at `moments` (ascending) as that leaves. `width` times their number is 1 at most.
std::vector<double> places_in_row(std::span<const double> moments, double width);

// A row for each run that has pictures; the last has the lines. HTML.
std::string film_strips(std::span<const RunFolder> runs, const WalkAxis& walk);

}  // namespace ridgeline::app::report
