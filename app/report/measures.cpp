#include "ridgeline/app/report/measures.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "ridgeline/app/report/html_text.h"
#include "ridgeline/telemetry/summary.h"

namespace ridgeline::app::report {
namespace {

using Count = Measure::Count;
using Top = Measure::Top;

constexpr Measure kFrameTime = {.column = "frame_ms",
                                .title = "Frame time",
                                .note = "from one frame to the next",
                                .unit = Unit::milliseconds,
                                .section = Section::time,
                                .top = Top::usual};

constexpr std::array kMeasures = {
    Measure{.column = "cpu_render_ms",
            .title = "Render thread",
            .note = "CPU time a frame",
            .unit = Unit::milliseconds,
            .section = Section::time,
            .top = Top::usual},
    Measure{.column = "gpu_ms",
            .title = "GPU",
            .note = "by its own timers",
            .unit = Unit::milliseconds,
            .section = Section::time,
            .top = Top::usual},
    Measure{.column = "selection_ms",
            .title = "Selection",
            .note = "the job that decides what is drawn",
            .unit = Unit::milliseconds,
            .section = Section::time,
            .top = Top::usual},
    Measure{.column = "selection_wait_ms",
            .title = "Waiting for the selection",
            .note = "of the render thread",
            .unit = Unit::milliseconds,
            .section = Section::time,
            .top = Top::usual},
    Measure{.column = "upload_ms",
            .title = "Uploading",
            .note = "of the render thread",
            .unit = Unit::milliseconds,
            .section = Section::time,
            .top = Top::usual},

    Measure{.column = "triangles",
            .title = "Triangles",
            .note = "drawn in the picture",
            .unit = Unit::count,
            .section = Section::drawn},
    Measure{.column = "nodes_drawn",
            .title = "Nodes drawn",
            .note = "places of the quadtree",
            .unit = Unit::count,
            .section = Section::drawn},
    Measure{.column = "nodes_frustum_culled",
            .title = "Culled by the frustum",
            .note = "nodes out of view",
            .unit = Unit::count,
            .section = Section::drawn,
            .same_axis_as = "nodes_horizon_culled"},
    Measure{.column = "nodes_horizon_culled",
            .title = "Culled by the horizon",
            .note = "nodes that mountains hide",
            .unit = Unit::count,
            .section = Section::drawn,
            .same_axis_as = "nodes_frustum_culled"},
    Measure{.column = "draws",
            .title = "Draw calls",
            .note = "of the picture",
            .unit = Unit::count,
            .section = Section::drawn},
    Measure{.column = "shadow_triangles",
            .title = "Shadow triangles",
            .note = "of all shadow maps",
            .unit = Unit::count,
            .section = Section::drawn},

    Measure{.column = "tiles_wanted",
            .title = "Tiles wanted",
            .note = "by the selection",
            .unit = Unit::count,
            .section = Section::paging},
    Measure{.column = "tiles_missing",
            .title = "Tiles missing",
            .note = "wanted and not there yet: coarser ones stand in",
            .unit = Unit::count,
            .section = Section::paging},
    Measure{.column = "bytes_read",
            .title = "Read",
            .note = "from disk, each frame",
            .unit = Unit::bytes,
            .section = Section::paging,
            .top = Top::usual},
    Measure{.column = "bytes_uploaded",
            .title = "Uploaded",
            .note = "to the GPU, each frame",
            .unit = Unit::bytes,
            .section = Section::paging,
            .top = Top::usual},
    Measure{.column = "bytes_read",
            .title = "Read so far",
            .note = "since the first frame",
            .unit = Unit::bytes,
            .section = Section::paging,
            .count = Count::total},
    Measure{.column = "bytes_uploaded",
            .title = "Uploaded so far",
            .note = "since the first frame",
            .unit = Unit::bytes,
            .section = Section::paging,
            .count = Count::total},
    Measure{.column = "ram_cache_bytes",
            .title = "RAM cache",
            .note = "decoded tiles",
            .unit = Unit::bytes,
            .section = Section::paging,
            .capacity = "ram-cache"},
    Measure{.column = "gpu_cache_bytes",
            .title = "GPU cache",
            .note = "tiles on the GPU",
            .unit = Unit::bytes,
            .section = Section::paging,
            .capacity = "gpu-cache"},

    Measure{.column = "eye_lift_m",
            .title = "Eye lift",
            .note = "that kept the eye out of coarse ground",
            .unit = Unit::metres,
            .section = Section::eye},
    Measure{.column = "heap_allocations",
            .title = "Heap allocations",
            .note = "of all threads, each frame",
            .unit = Unit::count,
            .section = Section::eye,
            .top = Top::usual},
};

// Values this many times above what most frames need are marked at the edge of the chart, which they would flatten.
constexpr double kFarAbove = 2.5;
// Of the values, those that the axis must hold; and the room above the greatest of them.
constexpr double kUsualShare = 0.99;
constexpr double kRoomAboveUsual = 1.5;
constexpr double kRoomAbove = 1.06;
constexpr int kMostTicks = 4;

bool any_frames(std::span<const RunFolder> runs, std::string_view column) {
    return std::any_of(runs.begin(), runs.end(), [column](const RunFolder& run) {
        return run.frames.frames() > 0 && run.frames.find(column) != nullptr;
    });
}

std::optional<double> capacity_of(const Measure& measure, const RunFolder& run) {
    const std::string* text =
        measure.capacity != nullptr ? run.summary.find_option(measure.capacity) : nullptr;
    double value = 0.0;
    if (text == nullptr) return std::nullopt;
    const auto [end, status] = std::from_chars(text->data(), text->data() + text->size(), value);
    if (status != std::errc() || end != text->data() + text->size() || !(value > 0.0 && value < 1e18))
        return std::nullopt;
    return value;
}

telemetry::Summary summary_of(std::vector<double> values) {
    std::erase_if(values, [](double value) { return std::isnan(value); });
    return telemetry::summarise(values);
}

// The greatest value that the axis must reach for one run.
double top_of(const Measure& measure, const std::vector<double>& values) {
    std::vector<double> known = values;
    std::erase_if(known, [](double value) { return std::isnan(value); });
    if (known.empty()) return 0.0;
    std::sort(known.begin(), known.end());
    const double usual = kRoomAboveUsual * known[telemetry::nearest_rank(kUsualShare, known.size()) - 1];
    return measure.top == Top::usual && usual > 0.0 && known.back() > kFarAbove * usual ? usual
                                                                                        : known.back();
}

double axis_top(const Measure& measure, std::span<const RunFolder> runs) {
    double top = 0.0;
    for (const RunFolder& run : runs) {
        top = std::max(top, top_of(measure, values_of(measure, run.frames)));
        top = std::max(top, capacity_of(measure, run).value_or(0.0));
        if (measure.same_axis_as == nullptr) continue;
        Measure other = measure;
        other.column = measure.same_axis_as;
        top = std::max(top, top_of(measure, values_of(other, run.frames)));
    }
    return top > 0.0 ? top * kRoomAbove : 1.0;
}

// One line where all runs have the same capacity, else one a run in its colour.
std::vector<Level> capacities(const Measure& measure, std::span<const RunFolder> runs) {
    std::vector<Level> levels;
    for (std::size_t run = 0; run < runs.size(); ++run) {
        const auto capacity = capacity_of(measure, runs[run]);
        const auto same = [&](const Level& level) { return level.value == capacity; };
        if (!capacity) continue;
        if (const auto found = std::find_if(levels.begin(), levels.end(), same); found != levels.end())
            found->style = "capacity";
        else
            levels.push_back({*capacity, "", "capacity " + colour_class(run)});
    }
    if (levels.size() == 1) levels.front().style = "capacity";
    return levels;
}

// "at most 16.0 MiB of 256.0 MiB (6.2 %)", of the fullest run.
std::string fill_text(const Measure& measure, std::span<const RunFolder> runs) {
    double share = -1.0;
    std::string text;
    for (const RunFolder& run : runs) {
        const auto capacity = capacity_of(measure, run);
        const double most = summary_of(values_of(measure, run.frames)).max;
        if (!capacity || most / *capacity <= share) continue;
        share = most / *capacity;
        text = "; at most " + quantity(most, measure.unit) + " of " + quantity(*capacity, measure.unit) +
               ", " + quantity(100.0 * share, Unit::percent);
    }
    return text;
}

// "; ▴ 2 frames above the scale, up to 496 ms".
std::string above_text(const Measure& measure, std::span<const RunFolder> runs, double top) {
    std::size_t above = 0;
    double most = 0.0;
    for (const RunFolder& run : runs)
        for (const double value : values_of(measure, run.frames)) {
            above += value > top ? 1 : 0;
            most = value > most ? value : most;
        }
    if (above == 0) return {};
    return "; <span class=\"over\">▲</span> " + std::to_string(above) + (above == 1 ? " frame" : " frames") +
           " above the scale, up to " + quantity(most, measure.unit);
}

std::string description_of(const Measure& measure, std::span<const RunFolder> runs) {
    std::string text = std::string(measure.title) + " over the walk.";
    for (const RunFolder& run : runs) {
        const telemetry::Summary summary = summary_of(values_of(measure, run.frames));
        text += " " + run.name + ": ";
        if (summary.count == 0)
            text += "not recorded.";
        else if (measure.count == Count::total)
            text += quantity(summary.max, measure.unit) + " in all.";
        else
            text += "median " + quantity(summary.p50, measure.unit) + ", 99 of 100 frames at most " +
                    quantity(summary.p99, measure.unit) + ", most " + quantity(summary.max, measure.unit) +
                    ".";
    }
    return text;
}

// The page has room for three runs in full; more share it, each with fewer columns.
int columns_for(std::size_t runs) {
    constexpr std::size_t kColumns = 960;
    return static_cast<int>(runs <= 3 ? kColumns : 3 * kColumns / runs);
}

}  // namespace

std::span<const Measure> measures() { return kMeasures; }

const Measure& frame_time_measure() { return kFrameTime; }

std::optional<WalkAxis> walk_axis(std::span<const RunFolder> runs) {
    WalkAxis walk{.axis = {}, .unit = Unit::seconds, .columns = columns_for(runs.size())};
    for (const RunFolder& run : runs)
        if (run.frames.frames() > 0 && run.frames.find("time_s") == nullptr) walk.unit = Unit::frames;
    double first = std::numeric_limits<double>::infinity(), last = -first;
    for (const RunFolder& run : runs)
        for (const double at : places_on(walk, run.frames)) {
            if (std::isnan(at)) continue;
            first = std::min(first, at);
            last = std::max(last, at);
        }
    if (!(first <= last)) return std::nullopt;
    constexpr int kTicksAcross = 10;
    walk.axis = linear_axis(first, last, walk.unit, kTicksAcross);
    return walk;
}

std::vector<double> places_on(const WalkAxis& walk, const FrameTable& frames) {
    if (walk.unit == Unit::seconds && frames.find("time_s") != nullptr) return *frames.find("time_s");
    std::vector<double> numbers;
    for (std::size_t frame = 0; frame < frames.frames(); ++frame)
        numbers.push_back(static_cast<double>(frame));
    return numbers;
}

std::vector<double> values_of(const Measure& measure, const FrameTable& frames) {
    const std::vector<double>* column = frames.find(measure.column);
    if (column == nullptr) return {};
    std::vector<double> values = *column;
    if (measure.count == Count::each) return values;
    double total = 0.0;
    for (double& value : values) value = total += std::isnan(value) ? 0.0 : value;
    return values;
}

Shown shown(const Measure& measure, std::span<const RunFolder> runs) {
    if (!any_frames(runs, measure.column)) return Shown::absent;
    bool measured = false;
    for (const RunFolder& run : runs)
        for (const double value : values_of(measure, run.frames)) {
            if (!std::isnan(value) && value != 0.0) return Shown::chart;
            measured |= !std::isnan(value);
        }
    return measured ? Shown::zero : Shown::absent;
}

CurveChart chart_of(const Measure& measure, std::span<const RunFolder> runs, const WalkAxis& walk) {
    const double top = axis_top(measure, runs);
    CurveChart chart{.title = measure.title,
                     .note = measure.note,
                     .description = description_of(measure, runs),
                     .unit = measure.unit,
                     .y = linear_axis(0.0, top, measure.unit, kMostTicks),
                     .curves = {},
                     .levels = capacities(measure, runs),
                     .above = {},
                     .beside = {},
                     .style = {}};
    chart.note += fill_text(measure, runs) + above_text(measure, runs, chart.y.last);
    const ColumnGrid grid{walk.axis.first, walk.axis.last, walk.columns};
    for (std::size_t run = 0; run < runs.size(); ++run) {
        const std::vector<double> values = values_of(measure, runs[run].frames);
        if (values.empty()) continue;
        chart.curves.push_back({run, decimated(places_on(walk, runs[run].frames), values, grid)});
    }
    return chart;
}

}  // namespace ridgeline::app::report
