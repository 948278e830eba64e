#include "ridgeline/telemetry/trace.h"

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <utility>

#include "ridgeline/base/json_text.h"
#include "ridgeline/base/thread_role.h"
#include "ridgeline/base/whole_file.h"

namespace ridgeline::telemetry {
namespace {

std::atomic<std::uint64_t> next_trace_id{1};

// The rings of the calling thread; those of traces that are gone stay behind unused, their ids are not given
// again.
struct HeldRing {
    std::uint64_t trace_id;
    void* ring;
};
thread_local std::vector<HeldRing> held_rings;

double microseconds(std::int64_t duration_ns) { return static_cast<double>(duration_ns) * 1e-3; }

void append_field(std::string& json, const char* key, double value) {
    char text[64];
    std::snprintf(text, sizeof text, ",\"%s\":%.3f", key, value);
    json += text;
}

}  // namespace

Trace::Ring::Ring(std::size_t capacity, std::string name, int number)
    : thread_name(std::move(name)), thread_number(number), events(capacity) {}

Trace::Trace(const TraceOptions& options)
    : options_(options), id_(next_trace_id.fetch_add(1)), start_ns_(now_ns()) {
    RIDGELINE_CHECK(options.events_per_thread > 0);
}

Trace::Ring& Trace::ring() {
    for (const HeldRing& held : held_rings)
        if (held.trace_id == id_) return *static_cast<Ring*>(held.ring);
    return make_ring();
}

Trace::Ring& Trace::make_ring() {
    MutexLock lock(mutex_);
    const int number = static_cast<int>(rings_.size()) + 1;
    Ring& made = rings_.emplace_back(options_.events_per_thread, thread_name(), number);
    held_rings.push_back({id_, &made});
    return made;
}

void Trace::add(const Event& event) {
    Ring& own = ring();
    MutexLock lock(own.mutex);
    own.events[own.added++ % own.events.size()] = event;
}

void Trace::add_span(const char* name, std::int64_t start_ns, std::int64_t duration_ns) {
    Event event;
    event.name = name;
    event.start_ns = start_ns;
    event.duration_ns = duration_ns;
    add(event);
}

void Trace::add_value(const char* name, double value) {
    Event event;
    event.name = name;
    event.start_ns = now_ns();
    event.value = value;
    event.kind = Kind::value;
    add(event);
}

void Trace::append_event(const Event& event, int thread, std::string& json) const {
    json += ",\n{\"name\":" + json_text(std::string_view(event.name)) +
            ",\"pid\":1,\"tid\":" + std::to_string(thread);
    append_field(json, "ts", microseconds(event.start_ns - start_ns_));
    if (event.kind == Kind::span) {
        append_field(json, "dur", microseconds(event.duration_ns));
        json += ",\"ph\":\"X\"}";
    } else {
        json += ",\"ph\":\"C\",\"args\":{\"value\":" + json_text(event.value) + "}}";
    }
}

void Trace::append_ring(const Ring& ring, std::string& json) const {
    const auto thread = std::to_string(ring.thread_number);
    json += ",\n{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":" + thread +
            ",\"args\":{\"name\":" + json_text(std::string_view(ring.thread_name)) + "}}";
    MutexLock lock(ring.mutex);
    const std::uint64_t kept = std::min<std::uint64_t>(ring.added, ring.events.size());
    for (std::uint64_t number = ring.added - kept; number < ring.added; ++number)
        append_event(ring.events[number % ring.events.size()], ring.thread_number, json);
}

std::string Trace::to_json() const {
    std::string json = R"({"displayTimeUnit":"ms","traceEvents":[)"
                       "\n"
                       R"({"name":"process_name","ph":"M","pid":1,"tid":0,"args":{"name":"ridgeline"}})";
    MutexLock lock(mutex_);
    for (const Ring& ring : rings_) append_ring(ring, json);
    return json + "\n]}\n";
}

Result<void> Trace::write(const std::filesystem::path& file) const {
    return write_whole_file(file, to_json());
}

}  // namespace ridgeline::telemetry
