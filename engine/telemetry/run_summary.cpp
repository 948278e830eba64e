#include "ridgeline/telemetry/run_summary.h"

#include <nlohmann/json.hpp>

#include "ridgeline/base/json_text.h"

namespace ridgeline::telemetry {
namespace {

// Ordered, so that the file reads as it is documented.
using Json = nlohmann::ordered_json;

Json json_of(const Summary& summary) {
    return {{"mean", summary.mean}, {"p50", summary.p50},   {"p95", summary.p95},
            {"p99", summary.p99},   {"p999", summary.p999}, {"max", summary.max}};
}

Json json_of(const RunSummary::CpuPercent& cpu) {
    return {{"process", cpu.process}, {"render", cpu.render}, {"io", cpu.io}, {"workers", cpu.workers}};
}

Json json_of(const RunSummary::Tiles& tiles) {
    return {{"requested", tiles.requested}, {"loaded", tiles.loaded},   {"cancelled", tiles.cancelled},
            {"failed", tiles.failed},       {"retried", tiles.retried}, {"evicted", tiles.evicted}};
}

Json json_of(const std::vector<std::pair<std::string, double>>& means) {
    Json json = Json::object();
    for (const auto& [name, mean] : means) json[name] = mean;
    return json;
}

Json json_of(const std::vector<std::pair<std::string, OptionValue>>& options) {
    Json json = Json::object();
    for (const auto& option : options)
        std::visit([&](const auto& value) { json[option.first] = value; }, option.second);
    return json;
}

Json json_of(const RunSummary& run) {
    const double fps_mean = run.seconds > 0.0 ? static_cast<double>(run.frames) / run.seconds : 0.0;
    return {{"format", "ridgeline-telemetry-1"},
            {"dataset", run.description.dataset},
            {"options", json_of(run.description.options)},
            {"gl_renderer", run.description.gl_renderer},
            {"frames", run.frames},
            {"seconds", run.seconds},
            {"fps_mean", fps_mean},
            {"frame_ms", json_of(run.frame_ms)},
            {"selection_ms", json_of(run.selection_ms)},
            {"gpu_ms", json_of(run.gpu_ms)},
            {"request_to_ready_ms", json_of(run.request_to_ready_ms)},
            {"request_to_drawn_frames", json_of(run.request_to_drawn_frames)},
            {"cpu_percent", json_of(run.cpu_percent)},
            {"per_frame", json_of(run.per_frame)},
            {"tiles", json_of(run.tiles)},
            {"frames_with_missing_tiles", run.frames_with_missing_tiles},
            {"frames_with_missing_heights", run.frames_with_missing_heights},
            {"frames_with_missing_imagery", run.frames_with_missing_imagery},
            {"peak_rss_bytes", run.peak_rss_bytes},
            {"ram_cache_bytes_max", run.ram_cache_bytes_max},
            {"gpu_cache_bytes_max", run.gpu_cache_bytes_max}};
}

void collect_numbers(const Json& json, const std::string& prefix,
                     std::vector<std::pair<std::string, double>>& out) {
    for (const auto& [key, value] : json.items()) {
        if (value.is_object()) collect_numbers(value, prefix + key + '.', out);
        if (value.is_number()) out.emplace_back(prefix + key, value.get<double>());
    }
}

}  // namespace

std::string to_json(const RunSummary& summary) { return json_text(json_of(summary), 2) + '\n'; }

std::vector<std::pair<std::string, double>> metrics(const RunSummary& summary) {
    Json json = json_of(summary);
    json.erase("options");
    std::vector<std::pair<std::string, double>> numbers;
    collect_numbers(json, "", numbers);
    return numbers;
}

}  // namespace ridgeline::telemetry
