// The measures that the page shows over the walk, each a column of frames.csv, and the chart of one of them for several
// runs.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ridgeline/app/report/curve_chart.h"
#include "ridgeline/app/report/run_folder.h"

namespace ridgeline::app::report {

enum class Section { time, drawn, paging, eye };

struct Measure {
    const char* column;
    const char* title;
    const char* note;  // HTML
    Unit unit;
    Section section;
    // Each frame's value, or what has come together since the first frame.
    enum class Count { each, total } count = Count::each;
    // Where the axis ends: at the greatest value, or, where few values are far above all others, at what most of them
    // need; these few are then marked.
    enum class Top { greatest, usual } top = Top::greatest;
    // The option whose value the measure cannot exceed.
    const char* capacity = nullptr;
    // Another column, of which the axis has room for the values too, so that the two charts compare.
    const char* same_axis_as = nullptr;
};

std::span<const Measure> measures();
// By column, for those shown apart from the sections.
const Measure& frame_time_measure();

// The time of the walk over all runs; frames where a run has no times. Nothing where no run has frames.
std::optional<WalkAxis> walk_axis(std::span<const RunFolder> runs);
// Where each frame of a run is on it.
std::vector<double> places_on(const WalkAxis& walk, const FrameTable& frames);

// What a run's frames say of a measure, NaN where nothing; empty where they have no such column.
std::vector<double> values_of(const Measure& measure, const FrameTable& frames);

enum class Shown { chart, zero, absent };
// Absent: no run has it. Zero: it never is anything else, in no run.
Shown shown(const Measure& measure, std::span<const RunFolder> runs);

CurveChart chart_of(const Measure& measure, std::span<const RunFolder> runs, const WalkAxis& walk);

}  // namespace ridgeline::app::report
