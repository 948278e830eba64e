#include "ridgeline/app/progress.h"

#include <unistd.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace ridgeline::app {
namespace {

using namespace std::chrono_literals;

constexpr auto kBarInterval = 100ms;  // faster only flickers
constexpr auto kLineInterval = 5s;    // a log of an hour stays readable
constexpr int kBarCells = 24;
constexpr const char* kClearLine = "\r\x1b[K";

// Three figures and a prefix: "950 ", "12.3 M".
std::string short_count(double value) {
    constexpr std::array<const char*, 4> kPrefixes = {"", "k", "M", "G"};
    std::size_t prefix = 0;
    for (; value >= 999.5 && prefix + 1 < kPrefixes.size(); ++prefix) value /= 1000.0;
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.*f %s", value < 99.95 ? 1 : 0, value, kPrefixes[prefix]);
    return text.data();
}

std::string minutes_and_seconds(double seconds) {
    const auto whole = std::llround(std::min(seconds, 359999.0));
    std::array<char, 32> text{};
    if (whole >= 3600)
        std::snprintf(text.data(), text.size(), "%lld:%02lld:%02lld", whole / 3600, whole / 60 % 60,
                      whole % 60);
    else
        std::snprintf(text.data(), text.size(), "%lld:%02lld", whole / 60, whole % 60);
    return text.data();
}

std::string bar(std::int64_t done, std::int64_t total) {
    const auto filled = static_cast<std::size_t>(kBarCells * done / total);
    return "[" + std::string(filled, '#') + std::string(kBarCells - filled, '-') + "]";
}

}  // namespace

std::string progress_text(std::int64_t done, std::int64_t total, std::chrono::duration<double> elapsed,
                          const std::string& unit) {
    std::string text = std::to_string(100 * done / total) + " %";
    if (done <= 0 || elapsed.count() <= 0.0) return text;
    const double per_second = static_cast<double>(done) / elapsed.count();
    text += ", " + short_count(per_second) + (per_second >= 999.5 ? " " : "") + unit + "/s";
    if (done < total)
        text += ", " + minutes_and_seconds(static_cast<double>(total - done) / per_second) + " left";
    return text;
}

Progress::Style Progress::style(bool quiet) {
    if (quiet) return Style::silent;
    return isatty(STDERR_FILENO) != 0 ? Style::bar : Style::lines;
}

Progress::Progress(std::string what, std::string unit, Style style)
    : what_(std::move(what)),
      unit_(std::move(unit)),
      style_(style),
      last_report_(Clock::now()),
      shown_at_(last_report_) {}

Progress::~Progress() {
    if (bar_on_screen_) std::fputs(kClearLine, stderr);
}

void Progress::report(const Phase& phase, std::int64_t done, std::int64_t total) {
    if (style_ == Style::silent || total <= 0) return;
    const auto now = Clock::now();
    const MutexLock lock(mutex_);
    // A phase began when the one before was last heard of, or with all of it.
    const auto start = phase_starts_.try_emplace(phase.name, last_report_).first->second;
    last_report_ = now;
    const auto interval =
        style_ == Style::bar ? Clock::duration(kBarInterval) : Clock::duration(kLineInterval);
    if (now - shown_at_ < interval) return;
    shown_at_ = now;
    const auto sane = std::clamp<std::int64_t>(done, 0, total);
    show(phase.name, progress_text(sane, total, now - start, phase.unit), sane, total);
}

void Progress::show(const std::string& phase, const std::string& text, std::int64_t done,
                    std::int64_t total) {
    const std::string name = phase.empty() ? what_ : what_ + ": " + phase;
    if (style_ == Style::bar) {
        std::fprintf(stderr, "%s%s %s %s", kClearLine, name.c_str(), bar(done, total).c_str(), text.c_str());
        bar_on_screen_ = true;
        return;
    }
    std::fprintf(stderr, "%s: %s\n", name.c_str(), text.c_str());
}

}  // namespace ridgeline::app
