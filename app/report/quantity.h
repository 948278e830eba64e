// Numbers as the page writes them: with their unit, to as many digits as anybody reads. Pure functions, any
// thread.
#pragma once

#include <string>

namespace ridgeline::app::report {

enum class Unit { milliseconds, seconds, frames, count, bytes, metres, percent };

// "171 ms", "113 879", "64.0 MiB"; three digits where there is a fraction; "–" where nothing was measured.
std::string quantity(double value, Unit unit);
// The same as short as an axis has room for: "100k", "64 MiB".
std::string tick_text(double value, Unit unit);
// What stands for the unit where numbers stand alone: "ms"; empty for counts.
std::string unit_name(Unit unit);
// How it compares with the first run: "×0.87"; "–" where there is nothing to compare with.
std::string ratio_text(double value, double first);

}  // namespace ridgeline::app::report
