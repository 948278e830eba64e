// The report of some runs as one HTML page that needs nothing beside it: style, script, curves and pictures
// are inside.
//
// Pure; any thread.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "ridgeline/app/report/run_folder.h"

namespace ridgeline::app::report {

// As many colours as people with any kind of colour vision tell apart, on white as on black.
inline constexpr std::size_t kMostRuns = 8;
// Pictures on one page, of all runs together: some 15 KB each.
inline constexpr std::size_t kMostPictures = 24;

// What every page begins with, and nothing else does: by it a page is known again.
inline constexpr std::string_view kPageOpening =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
    "<meta name=\"generator\" content=\"ridgeline report\"/>\n";

// One to kMostRuns runs.
std::string page_of(std::span<const RunFolder> runs);

}  // namespace ridgeline::app::report
