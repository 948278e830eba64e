// The frame time: its curve with the percentiles marked, how often which time came, and the pictures of the
// walk above.
#pragma once

#include <span>
#include <string>

#include "ridgeline/app/report/curve_chart.h"
#include "ridgeline/app/report/run_folder.h"

namespace ridgeline::app::report {

// Each HTML; empty where no run has frame times.
std::string frame_time_chart(std::span<const RunFolder> runs, const WalkAxis& walk);
std::string frame_time_histogram(std::span<const RunFolder> runs);

}  // namespace ridgeline::app::report
