// What the runs were told: the options that differ, and all of them. HTML.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "ridgeline/app/report/run_folder.h"

namespace ridgeline::app::report {

// Names of options of which not all runs have the same value (dataset and renderer among them), by name.
std::vector<std::string> options_that_differ(std::span<const RunFolder> runs);

// Empty for a single run.
std::string differing_options(std::span<const RunFolder> runs);
std::string options_table(std::span<const RunFolder> runs);

}  // namespace ridgeline::app::report
