// How far long work has come: a bar with rate and time left on a terminal, plain lines elsewhere, nothing if
// quiet.
//
// Either goes to stderr: stdout is for results.
// Any thread may report, several at once; calls are cheap enough for every tile or row.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

#include "ridgeline/base/thread_annotations.h"

namespace ridgeline::app {

class Progress {
  public:
    enum class Style { bar, lines, silent };
    // The style that suits where the output goes.
    static Style style(bool quiet);

    // what: "building alps.terrain"; unit: what is counted, in the plural: "samples".
    Progress(std::string what, std::string unit, Style style);
    // Takes the bar off the screen.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // done of total, both in units; phases have names and clocks of their own and may take turns.
    void report(std::int64_t done, std::int64_t total) { report({"", unit_}, done, total); }
    struct Phase {
        std::string name;
        std::string unit;
    };
    void report(const Phase& phase, std::int64_t done, std::int64_t total) RIDGELINE_EXCLUDES(mutex_);

  private:
    using Clock = std::chrono::steady_clock;

    void show(const std::string& phase, const std::string& text, std::int64_t done, std::int64_t total)
        RIDGELINE_REQUIRES(mutex_);

    const std::string what_;
    const std::string unit_;
    const Style style_;
    Mutex mutex_;
    std::map<std::string, Clock::time_point> phase_starts_ RIDGELINE_GUARDED_BY(mutex_);
    Clock::time_point last_report_ RIDGELINE_GUARDED_BY(mutex_);
    Clock::time_point shown_at_ RIDGELINE_GUARDED_BY(mutex_);
    bool bar_on_screen_ RIDGELINE_GUARDED_BY(mutex_) = false;
};

// "45 %, 12.3 M samples/s, 0:23 left", as both styles show it.
std::string progress_text(std::int64_t done, std::int64_t total, std::chrono::duration<double> elapsed,
                          const std::string& unit);

}  // namespace ridgeline::app
