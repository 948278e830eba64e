// Columns as the paths of an SVG: a line through the medians, a band from the least to the greatest.
//
// Paths are in steps of whole units (x: columns, y: kHeight units from the top of the chart down), relative
// to the point before, which is the shortest way to write them; the page's script reads values back from
// them.
#pragma once

#include <span>
#include <string>

#include "ridgeline/app/report/axis.h"
#include "ridgeline/app/report/decimation.h"

namespace ridgeline::app::report {

// A quarter of a thousandth of the axis is lost to rounding at most: less than three digits show.
inline constexpr int kHeight = 4000;

std::string line_path(std::span<const Column> columns, const Axis& y);
// Closed: the greatest values from left to right, then the least from right to left. Empty where no column
// holds more than one value.
std::string band_path(std::span<const Column> columns, const Axis& y);

}  // namespace ridgeline::app::report
