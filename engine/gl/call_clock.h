// How much of a thread's CPU time goes into OpenGL's functions; the rest of it is the program's own. A
// software driver draws in them, so without this nobody could tell what the program itself costs.
//
// Every function is bracketed while a CallClock lives, one at a time. Render thread only, with a GL context
// current.
#pragma once

#include <cstdint>

namespace ridgeline::gl {

class CallClock {
  public:
    // Whether the loader has brackets: glad's generator makes them with --debug.
    static bool available();

    // After available() has said so.
    CallClock();
    ~CallClock();
    CallClock(const CallClock&) = delete;
    CallClock& operator=(const CallClock&) = delete;

    // CPU time in GL's functions since this clock was made, what reading the clock took included.
    std::int64_t used_ns() const;
    std::int64_t calls() const;

  private:
    double cost_ns_ = 0.0;  // of a bracket, outside what it measures
};

}  // namespace ridgeline::gl
