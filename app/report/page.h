// The report of some runs as one HTML page that needs nothing beside it: style, script, curves and pictures are inside.
//
// Pure; any thread.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "ridgeline/app/report/run_folder.h"

namespace ridgeline::app::report {

// As many colours as people with any kind of colour vision tell apart, on white as on black.
inline constexpr std::size_t kMostRuns = 8;
// Pictures on one page, of all runs together: some 15 KB each.
inline constexpr std::size_t kMostPictures = 24;

// One to kMostRuns runs.
std::string page_of(std::span<const RunFolder> runs);

}  // namespace ridgeline::app::report
