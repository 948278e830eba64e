#include "ridgeline/gl/timer_query.h"

namespace ridgeline::gl {

TimerQuery TimerQuery::create(std::size_t depth) {
    TimerQuery timer;
    for (std::size_t i = 0; i < depth; ++i)
        timer.pairs_.push_back({Query::create(GL_TIMESTAMP), Query::create(GL_TIMESTAMP), 0});
    return timer;
}

void TimerQuery::begin(std::uint64_t frame) {
    RIDGELINE_CHECK(state_ == State::idle);
    state_ = count_ == pairs_.size() ? State::skipping : State::measuring;
    if (state_ == State::skipping) return;
    Pair& pair = pairs_[(first_ + count_) % pairs_.size()];
    pair.frame = frame;
    pair.begin.mark();
}

void TimerQuery::end() {
    RIDGELINE_CHECK(state_ != State::idle);
    if (state_ == State::measuring) pairs_[(first_ + count_++) % pairs_.size()].end.mark();
    state_ = State::idle;
}

std::optional<TimerQuery::Measured> TimerQuery::take() {
    if (count_ == 0) return std::nullopt;
    const Pair& pair = pairs_[first_];
    const auto end = pair.end.result();
    const auto begin = end ? pair.begin.result() : std::nullopt;
    if (!begin) return std::nullopt;
    first_ = (first_ + 1) % pairs_.size();
    --count_;
    return Measured{pair.frame, std::chrono::nanoseconds(static_cast<std::int64_t>(*end - *begin))};
}

}  // namespace ridgeline::gl
