// What summary.json says of a run, and its two shapes: the JSON text and a flat list of numbers.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "ridgeline/telemetry/summary.h"

namespace ridgeline::telemetry {

using OptionValue = std::variant<bool, std::int64_t, double, std::string>;

// What was run.
struct RunDescription {
    std::string dataset;
    std::string gl_renderer;
    // As they took effect, defaults included.
    std::vector<std::pair<std::string, OptionValue>> options{};
};

struct RunSummary {
    RunDescription description{};
    std::int64_t frames = 0;
    double seconds = 0.0;  // wall time

    Summary frame_ms{};
    Summary selection_ms{};
    Summary gpu_ms{};  // of the frames measured
    Summary request_to_ready_ms{};
    Summary request_to_drawn_frames{};

    // CPU time, in percent of one core.
    struct CpuPercent {
        double process = 0.0;
        double render = 0.0;
        double io = 0.0;
        double workers = 0.0;
    } cpu_percent{};

    // Means, by column of frames.csv.
    std::vector<std::pair<std::string, double>> per_frame{};

    struct Tiles {
        std::uint64_t requested = 0;
        std::uint64_t loaded = 0;
        std::uint64_t cancelled = 0;
        std::uint64_t failed = 0;
        std::uint64_t retried = 0;
        std::uint64_t evicted = 0;
    } tiles{};

    std::int64_t frames_with_missing_tiles = 0;  // of heights
    std::int64_t frames_with_missing_heights = 0;
    std::int64_t frames_with_missing_imagery = 0;
    std::uint64_t peak_rss_bytes = 0;
    std::int64_t ram_cache_bytes_max = 0;
    std::int64_t gpu_cache_bytes_max = 0;
};

// The text of summary.json.
std::string to_json(const RunSummary& summary);

// The numbers of summary.json, their keys joined by dots ("frame_ms.p99"); without the options.
std::vector<std::pair<std::string, double>> metrics(const RunSummary& summary);

}  // namespace ridgeline::telemetry
