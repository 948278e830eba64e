// The measures that the page shows over the walk, each a column of frames.csv. Pure, any thread.
#pragma once

#include <span>
#include <vector>

#include "ridgeline/app/report/quantity.h"
#include "ridgeline/app/report/run_folder.h"

namespace ridgeline::app::report {

// Ground: on pages of walks with imagery alone.
enum class Section { time, drawn, paging, ground, eye };

struct Measure {
    const char* column;
    const char* title;
    const char* note;  // HTML
    Unit unit;
    Section section;
    // Each frame's value, or what has come together since the first frame.
    enum class Count { each, total } count = Count::each;
    // Where the axis ends: at the greatest value, or, where few values are far above all others, at what most
    // of them need; these few are then marked.
    enum class Top { greatest, usual } top = Top::greatest;
    // Where the axis begins: at 0, or near the least value.
    enum class Foot { zero, least } foot = Foot::zero;
    // Whether the chart is as wide as the page: the one of its section to be looked at first.
    enum class Width { half, full } width = Width::half;
    // The option whose value the measure cannot exceed.
    const char* capacity = nullptr;
    // Another column, of which the axis has room for the values too, so that the two charts compare.
    const char* same_axis_as = nullptr;
};

std::span<const Measure> measures();
// By column, for those shown apart from the sections.
const Measure& frame_time_measure();

// What a run's frames say of a measure, NaN where nothing; empty where they have no such column.
std::vector<double> values_of(const Measure& measure, const FrameTable& frames);

// Whether the walk ever showed imagery; that, or the disc's heights.
bool had_imagery(const RunFolder& run);
bool had_ground_tiles(const RunFolder& run);

enum class Shown { chart, zero, absent };
// Absent: no run has it. Zero: it never is anything else, in no run.
Shown shown(const Measure& measure, std::span<const RunFolder> runs);

}  // namespace ridgeline::app::report
