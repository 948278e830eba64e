// How long the GPU took for a stretch of commands, known some frames later, waited for never. Render thread
// only.
//
// Pairs of timestamps, so that timers may nest. When the GPU lags so far that no pair is free, a frame goes
// unmeasured.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "ridgeline/gl/query.h"

namespace ridgeline::gl {

class TimerQuery {
  public:
    // `depth`: measurements that may be in flight.
    static TimerQuery create(std::size_t depth = 8);

    void begin(std::uint64_t frame);
    void end();

    struct Measured {
        std::uint64_t frame = 0;
        std::chrono::duration<double, std::milli> time{0.0};
    };
    // In order; nothing when the oldest is not finished. Call until it gives nothing.
    std::optional<Measured> take();

  private:
    struct Pair {
        Query begin;
        Query end;
        std::uint64_t frame = 0;
    };
    enum class State { idle, measuring, skipping };

    std::vector<Pair> pairs_;  // a queue: oldest at first_
    std::size_t first_ = 0;
    std::size_t count_ = 0;
    State state_ = State::idle;
};

}  // namespace ridgeline::gl
