// A trace of what each thread did when, as Chrome trace events (opens in Perfetto or chrome://tracing).
//
// Any thread may record; each writes to a ring of its own, made at its first event, that keeps the newest
// events. Recording takes an uncontended lock and no memory. Names are string literals: only the pointer is
// kept. Classes that may be traced take a `Trace*` in their options, null for none. A thread's ring is named
// after the role that the thread has at its first event (set_thread_role). The trace must outlive the
// recording.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/base/thread_annotations.h"
#include "ridgeline/telemetry/clock.h"

namespace ridgeline::telemetry {

struct TraceOptions {
    // The newest events kept of each thread, 32 bytes each.
    std::size_t events_per_thread = std::size_t{1} << 16;
};

class Trace {
  public:
    explicit Trace(const TraceOptions& options = {});
    Trace(const Trace&) = delete;
    Trace& operator=(const Trace&) = delete;

    // Something that lasted from `start_ns` (of now_ns()) for `duration_ns`, on the calling thread.
    void add_span(const char* name, std::int64_t start_ns, std::int64_t duration_ns);
    // A value over time, drawn as a curve.
    void add_value(const char* name, double value);

    // The events so far, as JSON, in the order of their end on each thread.
    std::string to_json() const;
    Result<void> write(const std::filesystem::path& file) const;

  private:
    enum class Kind : std::uint8_t { span, value };
    struct Event {
        const char* name = nullptr;
        std::int64_t start_ns = 0;
        union {
            std::int64_t duration_ns = 0;
            double value;
        };
        Kind kind = Kind::span;
    };
    struct Ring {
        Ring(std::size_t capacity, std::string name, int number);

        const std::string thread_name;
        const int thread_number;
        mutable Mutex mutex;
        std::vector<Event> events RIDGELINE_GUARDED_BY(mutex);
        // Events ever added; the newest is at (added - 1) modulo the capacity.
        std::uint64_t added RIDGELINE_GUARDED_BY(mutex) = 0;
    };

    Ring& ring();
    Ring& make_ring();
    void add(const Event& event);
    void append_ring(const Ring& ring, std::string& json) const;
    void append_event(const Event& event, int thread, std::string& json) const;

    const TraceOptions options_;
    const std::uint64_t id_;
    const std::int64_t start_ns_;
    mutable Mutex mutex_;
    std::deque<Ring> rings_ RIDGELINE_GUARDED_BY(mutex_);
};

// Traces the life of a scope on the calling thread; does nothing where there is no trace.
class TraceScope {
  public:
    TraceScope(Trace* trace, const char* name)
        : trace_(trace), name_(name), start_ns_(trace ? now_ns() : 0) {}
    ~TraceScope() {
        if (trace_) trace_->add_span(name_, start_ns_, now_ns() - start_ns_);
    }
    TraceScope(const TraceScope&) = delete;
    TraceScope& operator=(const TraceScope&) = delete;

  private:
    Trace* const trace_;
    const char* const name_;
    const std::int64_t start_ns_;
};

}  // namespace ridgeline::telemetry
