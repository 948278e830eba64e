#include "ridgeline/app/report/measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

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
            .section = Section::drawn,
            .width = Measure::Width::full},
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

    Measure{.column = "heights_wanted",
            .title = "Heights wanted",
            .note = "tiles for the disc, beside the chunks",
            .unit = Unit::count,
            .section = Section::ground,
            .same_axis_as = "heights_missing"},
    Measure{.column = "heights_missing",
            .title = "Heights missing",
            .note = "wanted and not there yet: coarser heights stand in",
            .unit = Unit::count,
            .section = Section::ground,
            .same_axis_as = "heights_wanted"},
    Measure{.column = "imagery_wanted",
            .title = "Imagery wanted",
            .note = "tiles, beside those of the heights",
            .unit = Unit::count,
            .section = Section::ground,
            .same_axis_as = "imagery_missing"},
    Measure{.column = "imagery_missing",
            .title = "Imagery missing",
            .note = "wanted and not there yet: coarser imagery stands in",
            .unit = Unit::count,
            .section = Section::ground,
            .same_axis_as = "imagery_wanted"},
    Measure{.column = "imagery_loaded",
            .title = "Imagery loaded so far",
            .note = "tiles, since the first frame",
            .unit = Unit::count,
            .section = Section::ground,
            .count = Count::total},
    Measure{.column = "imagery_gpu_bytes",
            .title = "Imagery on the GPU",
            .note = "part of the GPU cache",
            .unit = Unit::bytes,
            .section = Section::ground},
    Measure{.column = "tiles_scheduled",
            .title = "Tiles scheduled",
            .note = "chosen by what the picture showed of the ground",
            .unit = Unit::count,
            .section = Section::ground},
    Measure{.column = "schedule_ms",
            .title = "Scheduling",
            .note = "the part of the selection that chooses them",
            .unit = Unit::milliseconds,
            .section = Section::ground,
            .top = Top::usual},
    Measure{.column = "readback_age_frames",
            .title = "Age of what was seen",
            .note = "of the ground by which they were chosen; none until the first is read back",
            .unit = Unit::frames,
            .section = Section::ground},
    Measure{.column = "readback_stalls",
            .title = "Stalls of the readback",
            .note = "looks for it that waited, over 0.1 ms",
            .unit = Unit::count,
            .section = Section::ground},

    Measure{.column = "eye_height_m",
            .title = "Height of the eye",
            .note = "in the store's heights",
            .unit = Unit::metres,
            .section = Section::eye,
            .foot = Measure::Foot::least,
            .width = Measure::Width::full},
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

bool any_frames(std::span<const RunFolder> runs, std::string_view column) {
    return std::any_of(runs.begin(), runs.end(), [column](const RunFolder& run) {
        return run.frames.frames() > 0 && run.frames.find(column) != nullptr;
    });
}

bool ever_above_zero(const RunFolder& run, std::string_view column) {
    const std::vector<double>* values = run.frames.find(column);
    return values != nullptr &&
           std::any_of(values->begin(), values->end(), [](double value) { return value > 0.0; });
}

}  // namespace

std::span<const Measure> measures() { return kMeasures; }

const Measure& frame_time_measure() { return kFrameTime; }

std::vector<double> values_of(const Measure& measure, const FrameTable& frames) {
    const std::vector<double>* column = frames.find(measure.column);
    if (column == nullptr) return {};
    std::vector<double> values = *column;
    if (measure.count == Count::each) return values;
    double total = 0.0;
    for (double& value : values) value = total += std::isnan(value) ? 0.0 : value;
    return values;
}

bool had_imagery(const RunFolder& run) {
    return ever_above_zero(run, "imagery_wanted") || ever_above_zero(run, "imagery_gpu_bytes");
}

bool had_ground_tiles(const RunFolder& run) {
    return had_imagery(run) || ever_above_zero(run, "heights_wanted");
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

}  // namespace ridgeline::app::report
