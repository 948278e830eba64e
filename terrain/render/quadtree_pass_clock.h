// What each of the quadtree's passes takes: by the GPU's own clock, or on a driver that draws with the CPU by
// the time in the calls, in which it runs them.
//
// For benches; a walk does without. Render thread only; never waits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ridgeline/gl/timer_query.h"

namespace ridgeline::render {

enum class QuadtreePass { shapes, levels, balance, turn, emit };
constexpr std::size_t kQuadtreePasses = 5;
constexpr const char* name_of(QuadtreePass pass) {
    constexpr std::array<const char*, kQuadtreePasses> kNames = {"shapes", "levels", "balance", "turn",
                                                                 "emit"};
    return kNames[static_cast<std::size_t>(pass)];
}

class QuadtreePassClock {
  public:
    explicit QuadtreePassClock(bool software);

    // One pass after another, each at most once a frame.
    template <class Work>
    void time(QuadtreePass pass, Work work) {
        begin(pass);
        work();
        end(pass);
    }

    // Of the frames whose times have arrived; 0 without any.
    double mean_ms(QuadtreePass pass) const;
    // Forgets them, and what has not arrived where the GPU has finished.
    void clear();

  private:
    void begin(QuadtreePass pass);
    void end(QuadtreePass pass);
    void add(QuadtreePass pass, double ms);

    struct Sum {
        double ms = 0.0;
        std::int64_t frames = 0;
    };
    std::array<Sum, kQuadtreePasses> sums_{};
    std::vector<gl::TimerQuery> timers_;  // by pass; none where calls are timed
    std::int64_t start_ns_ = 0;
};

}  // namespace ridgeline::render
