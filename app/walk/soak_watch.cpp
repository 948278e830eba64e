#include "ridgeline/app/walk/soak_watch.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "ridgeline/base/units.h"

namespace ridgeline::app {
namespace {

using telemetry::Trend;
using telemetry::TrendSample;

// Linux adds up resident pages by thread, and each thread's once they are 64.
constexpr double kRssResolution_bytes = 64.0 * 4096.0;

enum class Judged { yes, no };

struct Measure {
    const char* name;
    double SoakWatch::Second::*field;
    double unit;  // in which it is printed
    const char* unit_name;
    double resolution;
    Judged judged;
};

constexpr double kMiB = static_cast<double>(1_MiB);
constexpr Measure kMeasures[] = {
    {"rss_bytes", &SoakWatch::Second::rss_bytes, kMiB, "MiB", kRssResolution_bytes, Judged::yes},
    {"gpu_cache_bytes", &SoakWatch::Second::gpu_cache_bytes, kMiB, "MiB", 0.0, Judged::yes},
    {"handles", &SoakWatch::Second::handles, 1.0, "", 0.0, Judged::yes},
    {"cpu_ms", &SoakWatch::Second::cpu_ms, 1.0, "ms", 0.0, Judged::yes},
    {"frame_ms", &SoakWatch::Second::frame_ms, 1.0, "ms", 0.0, Judged::no},
};

const char* said_of(const Trend& trend) {
    return trend.rises() ? "rises" : trend.falls() ? "falls" : "level";
}

}  // namespace

SoakWatch::SoakWatch(const SoakClock& start, std::size_t usual_seconds, std::size_t round_frames)
    : round_frames_(round_frames), second_start_(start) {
    // Touched, too: pages that come one by one would show as memory that grows.
    seconds_.resize(usual_seconds);
    seconds_.clear();
}

void SoakWatch::add(const SoakClock& now, const telemetry::FrameRecord& frame) {
    ++second_.frames;
    second_.frame_ms_max = std::max(second_.frame_ms_max, frame.frame_ms);
    if (now.wall_s - second_start_.wall_s < 1.0) return;
    const double each_ms = 1e3 / static_cast<double>(second_.frames);
    second_.wall_s = now.wall_s;
    second_.rss_bytes = static_cast<double>(frame.rss_bytes);
    second_.gpu_cache_bytes = static_cast<double>(frame.gpu_cache_bytes);
    second_.handles = static_cast<double>(frame.handles);
    second_.cpu_ms = each_ms * (now.cpu_s - second_start_.cpu_s);
    second_.frame_ms = each_ms * (now.wall_s - second_start_.wall_s);
    if (round_frames_ > 0)
        second_.rounds = static_cast<double>(frame.frame) / static_cast<double>(round_frames_);
    seconds_.push_back(second_);
    second_ = {};
    second_start_ = now;
}

std::string SoakWatch::csv() const {
    std::string csv = "wall_s,frames,rss_bytes,gpu_cache_bytes,handles,cpu_ms,frame_ms,frame_ms_max\n";
    for (const Second& second : seconds_) {
        std::array<char, 160> line{};
        std::snprintf(line.data(), line.size(), "%.3f,%lld,%.0f,%.0f,%.0f,%.4f,%.4f,%.4f\n", second.wall_s,
                      static_cast<long long>(second.frames), second.rss_bytes, second.gpu_cache_bytes,
                      second.handles, second.cpu_ms, second.frame_ms, second.frame_ms_max);
        csv += line.data();
    }
    return csv;
}

Result<std::vector<Trend>> SoakWatch::trends() const {
    // Parts shorter than two seconds are hardly independent of each other.
    constexpr std::size_t kLeast = 2 * std::size_t{Trend::kParts};
    const std::size_t from = seconds_.size() / 4;
    const std::size_t kept = seconds_.size() - from;
    if (kept < kLeast)
        return Error{"--soak: " + std::to_string(seconds_.size()) +
                     " seconds are too few to tell whether anything rises: 32 do, and ten minutes tell more"};
    std::vector<Trend> trends;
    std::vector<TrendSample> samples(kept);
    for (const Measure& measure : kMeasures) {
        std::transform(seconds_.end() - static_cast<std::ptrdiff_t>(kept), seconds_.end(), samples.begin(),
                       [&](const Second& second) {
                           return TrendSample{second.wall_s, second.*measure.field, second.rounds};
                       });
        trends.push_back(telemetry::trend_of(samples, measure.resolution));
    }
    return trends;
}

Result<std::string> SoakWatch::table() const {
    const auto found = trends();
    if (!found) return found.error();
    std::string table = "                       mean   slope an hour   its error   told from\n";
    for (std::size_t i = 0; i < std::size(kMeasures); ++i) {
        const Measure& measure = kMeasures[i];
        const Trend& trend = (*found)[i];
        std::array<char, 160> line{};
        std::snprintf(line.data(), line.size(), "%-15s %11.4f %+15.4f %11.4f %11.4f  %s%s%s\n", measure.name,
                      trend.mean / measure.unit, trend.per_hour / measure.unit,
                      trend.error_per_hour / measure.unit, trend.least_told_per_hour() / measure.unit,
                      measure.unit_name, *measure.unit_name ? ", " : "", said_of(trend));
        table += line.data();
    }
    return table;
}

Result<void> SoakWatch::verdict() const {
    const auto found = trends();
    if (!found) return found.error();
    for (std::size_t i = 0; i < std::size(kMeasures); ++i) {
        const Measure& measure = kMeasures[i];
        const Trend& trend = (*found)[i];
        if (measure.judged == Judged::no || !trend.rises()) continue;
        std::array<char, 160> text{};
        std::snprintf(text.data(), text.size(), "--soak: %s rises by %.4g %s an hour, give or take %.4g",
                      measure.name, trend.per_hour / measure.unit, measure.unit_name,
                      trend.least_told_per_hour() / measure.unit);
        return Error{text.data()};
    }
    return {};
}

}  // namespace ridgeline::app
