// Who the runs are and the few figures of each that matter most. HTML.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "ridgeline/app/report/run_folder.h"

namespace ridgeline::app::report {

// How a run is called in tables and legends: its letter in its colour, where there are several, and its name.
std::string run_label(std::span<const RunFolder> runs, std::size_t index);

// A card: what was walked, where and how fast.
std::string headline(std::span<const RunFolder> runs, std::size_t index);

}  // namespace ridgeline::app::report
