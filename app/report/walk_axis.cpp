#include "ridgeline/app/report/walk_axis.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ridgeline::app::report {
namespace {

// The page has room for three runs in full; more share it, each with fewer columns.
int columns_for(std::size_t runs) {
    constexpr std::size_t kColumns = 960;
    return static_cast<int>(runs <= 3 ? kColumns : 3 * kColumns / runs);
}

}  // namespace

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

}  // namespace ridgeline::app::report
