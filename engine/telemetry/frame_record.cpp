#include "ridgeline/telemetry/frame_record.h"

#include <array>
#include <cstdio>

namespace ridgeline::telemetry {
namespace {

#define RIDGELINE_COLUMN(field) \
    FrameColumn { #field, &FrameRecord::field }
constexpr std::array kColumns = {
    RIDGELINE_COLUMN(frame),
    RIDGELINE_COLUMN(time_s),
    RIDGELINE_COLUMN(frame_ms),
    RIDGELINE_COLUMN(cpu_render_ms),
    RIDGELINE_COLUMN(selection_ms),
    RIDGELINE_COLUMN(gpu_ms),
    RIDGELINE_COLUMN(triangles),
    RIDGELINE_COLUMN(draws),
    RIDGELINE_COLUMN(nodes_visited),
    RIDGELINE_COLUMN(nodes_frustum_culled),
    RIDGELINE_COLUMN(nodes_horizon_culled),
    RIDGELINE_COLUMN(nodes_drawn),
    RIDGELINE_COLUMN(tiles_wanted),
    RIDGELINE_COLUMN(tiles_missing),
    RIDGELINE_COLUMN(eye_lift_m),
    RIDGELINE_COLUMN(bytes_read),
    RIDGELINE_COLUMN(bytes_uploaded),
    RIDGELINE_COLUMN(ram_cache_bytes),
    RIDGELINE_COLUMN(gpu_cache_bytes),
    RIDGELINE_COLUMN(selection_wait_ms),
    RIDGELINE_COLUMN(upload_ms),
    RIDGELINE_COLUMN(heap_allocations),
    RIDGELINE_COLUMN(eye_east_m),
    RIDGELINE_COLUMN(eye_north_m),
    RIDGELINE_COLUMN(eye_height_m),
    RIDGELINE_COLUMN(shadow_casters),
    RIDGELINE_COLUMN(shadow_triangles),
    RIDGELINE_COLUMN(schedule_ms),
    RIDGELINE_COLUMN(readback_age_frames),
    RIDGELINE_COLUMN(readback_stalls),
    RIDGELINE_COLUMN(tiles_scheduled),
    RIDGELINE_COLUMN(heights_wanted),
    RIDGELINE_COLUMN(heights_missing),
    RIDGELINE_COLUMN(imagery_wanted),
    RIDGELINE_COLUMN(imagery_missing),
    RIDGELINE_COLUMN(imagery_requested),
    RIDGELINE_COLUMN(imagery_loaded),
    RIDGELINE_COLUMN(imagery_gpu_bytes),
    RIDGELINE_COLUMN(rss_bytes),
    RIDGELINE_COLUMN(handles),
};
#undef RIDGELINE_COLUMN
static_assert(sizeof(FrameRecord) == kColumns.size() * sizeof(double),
              "every field of FrameRecord needs a column");

void append_value(std::int64_t value, std::string& csv) { csv += std::to_string(value); }

void append_value(double value, std::string& csv) {
    // Nine digits: centimetres in coordinates of millions of metres, and a millionth of any time.
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    // A sign would say nothing here, and not every reader of CSV knows it.
    csv += value != value ? "nan" : text;
}

}  // namespace

double FrameColumn::value(const FrameRecord& record) const {
    return std::visit([&record](auto member) { return static_cast<double>(record.*member); }, field);
}

std::span<const FrameColumn> frame_columns() { return kColumns; }

std::string csv_header() {
    std::string line;
    for (const FrameColumn& column : kColumns) {
        if (!line.empty()) line += ',';
        line += column.name;
    }
    return line + '\n';
}

void append_csv_row(const FrameRecord& record, std::string& csv) {
    bool first = true;
    for (const FrameColumn& column : kColumns) {
        if (!first) csv += ',';
        first = false;
        std::visit([&](auto member) { append_value(record.*member, csv); }, column.field);
    }
    csv += '\n';
}

}  // namespace ridgeline::telemetry
