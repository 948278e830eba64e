// The figures of summary.json as tables, with ratios to the first run. HTML.
#pragma once

#include <span>
#include <string>

#include "ridgeline/app/report/run_folder.h"

namespace ridgeline::app::report {

// Rows: a measure of a run; columns: from the mean to the greatest.
std::string percentiles_table(std::span<const RunFolder> runs);

// Rows: a figure; columns: runs.
std::string counts_table(std::span<const RunFolder> runs);

}  // namespace ridgeline::app::report
