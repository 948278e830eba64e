// The chart of one measure for several runs. Pure, any thread.
#pragma once

#include <span>

#include "ridgeline/app/report/curve_chart.h"
#include "ridgeline/app/report/measures.h"
#include "ridgeline/app/report/walk_axis.h"

namespace ridgeline::app::report {

CurveChart chart_of(const Measure& measure, std::span<const RunFolder> runs, const WalkAxis& walk);

}  // namespace ridgeline::app::report
