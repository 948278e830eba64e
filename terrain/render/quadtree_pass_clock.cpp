#include "ridgeline/render/quadtree_pass_clock.h"

#include "ridgeline/telemetry/clock.h"

namespace ridgeline::render {

QuadtreePassClock::QuadtreePassClock(bool software) {
    if (software) return;
    for (std::size_t i = 0; i < kQuadtreePasses; ++i) timers_.push_back(gl::TimerQuery::create());
}

void QuadtreePassClock::begin(QuadtreePass pass) {
    if (timers_.empty())
        start_ns_ = telemetry::now_ns();
    else
        timers_[static_cast<std::size_t>(pass)].begin(0);
}

void QuadtreePassClock::end(QuadtreePass pass) {
    if (timers_.empty()) return add(pass, telemetry::milliseconds(telemetry::now_ns() - start_ns_));
    gl::TimerQuery& timer = timers_[static_cast<std::size_t>(pass)];
    timer.end();
    while (const auto measured = timer.take()) add(pass, measured->time.count());
}

void QuadtreePassClock::clear() {
    for (gl::TimerQuery& timer : timers_)
        while (timer.take()) {
        }
    sums_ = {};
}

void QuadtreePassClock::add(QuadtreePass pass, double ms) {
    Sum& sum = sums_[static_cast<std::size_t>(pass)];
    sum.ms += ms;
    ++sum.frames;
}

double QuadtreePassClock::mean_ms(QuadtreePass pass) const {
    const Sum& sum = sums_[static_cast<std::size_t>(pass)];
    return sum.frames > 0 ? sum.ms / static_cast<double>(sum.frames) : 0.0;
}

}  // namespace ridgeline::render
