// What is recorded of each frame, and the columns of frames.csv, which are declared here once.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>

namespace ridgeline::telemetry {

// Not measured (yet): GPU times arrive some frames late, and those of the last frames never.
inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

// Counts are of this frame alone. Every field is a column of the same name; see frame_columns().
struct FrameRecord {
    std::int64_t frame = 0;
    double time_s = 0.0;         // of the walk, which headless advances by 1/60 s a frame
    double frame_ms = 0.0;       // wall time from the frame before to this one
    double cpu_render_ms = 0.0;  // CPU time of the render thread
    double selection_ms = 0.0;
    double gpu_ms = kNotMeasured;
    std::int64_t triangles = 0;
    std::int64_t draws = 0;
    std::int64_t nodes_visited = 0;
    std::int64_t nodes_frustum_culled = 0;
    std::int64_t nodes_horizon_culled = 0;
    std::int64_t nodes_drawn = 0;
    std::int64_t tiles_wanted = 0;
    std::int64_t tiles_missing = 0;
    double eye_lift_m = 0.0;
    std::int64_t bytes_read = 0;
    std::int64_t bytes_uploaded = 0;
    std::int64_t ram_cache_bytes = 0;
    std::int64_t gpu_cache_bytes = 0;
    double selection_wait_ms = 0.0;  // that the render thread waited for the selection
    double upload_ms = 0.0;
    std::int64_t heap_allocations = 0;  // of all threads; see allocation_counter.h
    double eye_east_m = 0.0;
    double eye_north_m = 0.0;
    double eye_height_m = 0.0;
    std::int64_t shadow_casters = 0;    // nodes that the shadow maps draw
    std::int64_t shadow_triangles = 0;  // of all shadow maps together; `triangles` are the picture's
    double schedule_ms = 0.0;           // of selection_ms: choosing the tiles of a texture over the ground
    // Frames since the ground was seen by which they were chosen.
    double readback_age_frames = kNotMeasured;
    std::int64_t readback_stalls = 0;  // looks for a readback that waited, over 0.1 ms
    std::int64_t tiles_scheduled = 0;
    // Tiles of the disc's heights and of imagery, which tiles_wanted and tiles_missing leave out; bytes_…
    // above hold theirs.
    std::int64_t heights_wanted = 0;
    std::int64_t heights_missing = 0;  // of them on their way, failed, or without room
    std::int64_t imagery_wanted = 0;
    std::int64_t imagery_missing = 0;    // of them on their way, failed, or without room
    std::int64_t imagery_requested = 0;  // asked of the disk
    std::int64_t imagery_loaded = 0;
    std::int64_t imagery_gpu_bytes = 0;  // of gpu_cache_bytes
    // Of the process, looked up once a second.
    std::int64_t rss_bytes = 0;
    std::int64_t handles = 0;  // open files and sockets
};

// A column of frames.csv: its name and the field behind it.
struct FrameColumn {
    std::string_view name;
    std::variant<std::int64_t FrameRecord::*, double FrameRecord::*> field;

    double value(const FrameRecord& record) const;
};

std::span<const FrameColumn> frame_columns();

// The first line of frames.csv and the line of one frame, line ends included. What was not measured reads
// "nan".
std::string csv_header();
void append_csv_row(const FrameRecord& record, std::string& csv);

}  // namespace ridgeline::telemetry
