#include "ridgeline/telemetry/recorder.h"

#include <pthread.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "ridgeline/base/contract.h"
#include "ridgeline/base/whole_file.h"

namespace ridgeline::telemetry {
namespace {

// Means over all frames that summary.json gives, by column.
constexpr std::string_view kMeans[] = {
    "triangles",  "nodes_drawn", "nodes_frustum_culled", "nodes_horizon_culled", "bytes_uploaded",
    "bytes_read", "draws",       "nodes_visited",        "cpu_render_ms",        "heap_allocations"};

const FrameColumn& column_named(std::string_view name) {
    const auto columns = frame_columns();
    const auto found = std::ranges::find(columns, name, &FrameColumn::name);
    RIDGELINE_CHECK(found != columns.end());
    return *found;
}

double percent(std::int64_t used_ns, double seconds) {
    return seconds > 0.0 ? static_cast<double>(used_ns) * 1e-9 / seconds * 100.0 : 0.0;
}

}  // namespace

Recorder::Recorder(const RecorderOptions& options) : trace_(options.trace) {
    blocks_.push_back(std::make_unique<FrameBlock>());
    start();
}

Recorder::~Recorder() = default;

// --- Time ---

void Recorder::start() {
    MutexLock lock(time_mutex_);
    start_ns_ = now_ns();
    end_ns_ = 0;
    process_cpu_start_ns_ = process_cpu_ns();
    std::erase_if(threads_, &CountedThread::released);
    for (CountedThread& thread : threads_) thread.start_ns = thread.clock.used_ns();
}

void Recorder::finish() {
    MutexLock lock(time_mutex_);
    if (end_ns_ != 0) return;
    end_ns_ = now_ns();
    process_cpu_used_ns_ = process_cpu_ns() - process_cpu_start_ns_;
    for (CountedThread& thread : threads_) thread.stop();
}

// A thread that has ended reads zero and keeps what it was last seen to have used.
void Recorder::CountedThread::stop() {
    if (!released) used_ns = std::max(used_ns, clock.used_ns() - start_ns);
}

void Recorder::count_this_thread(CpuGroup group) {
    const auto clock = ThreadCpuClock::of_this_thread();
    MutexLock lock(time_mutex_);
    threads_.push_back(
        {.group = group, .thread = pthread_self(), .clock = clock, .start_ns = clock.used_ns()});
}

void Recorder::release_this_thread() {
    MutexLock lock(time_mutex_);
    for (CountedThread& thread : threads_) {
        if (thread.released || pthread_equal(thread.thread, pthread_self()) == 0) continue;
        // After finish() the time is settled.
        if (end_ns_ == 0) thread.stop();
        thread.released = true;
    }
}

double Recorder::measured_seconds() const {
    MutexLock lock(time_mutex_);
    return static_cast<double>(end_ns_ - start_ns_) * 1e-9;
}

RunSummary::CpuPercent Recorder::cpu_percent(double seconds) const {
    std::int64_t used_ns[3] = {};
    MutexLock lock(time_mutex_);
    for (const CountedThread& thread : threads_)
        used_ns[static_cast<std::size_t>(thread.group)] += thread.used_ns;
    const auto of = [&](CpuGroup group) {
        return percent(used_ns[static_cast<std::size_t>(group)], seconds);
    };
    return {.process = percent(process_cpu_used_ns_, seconds),
            .render = of(CpuGroup::render),
            .io = of(CpuGroup::io),
            .workers = of(CpuGroup::workers)};
}

// --- Frames ---

FrameRecord& Recorder::stored(std::int64_t index) const {
    RIDGELINE_CHECK(index >= 0 && index < frame_count_);
    return (*blocks_[static_cast<std::size_t>(index / kFramesPerBlock)])[static_cast<std::size_t>(
        index % kFramesPerBlock)];
}

const FrameRecord& Recorder::frame(std::int64_t index) const { return stored(index); }

void Recorder::add_frame(const FrameRecord& record) {
    RIDGELINE_CHECK(record.frame == frame_count_);
    const auto blocks_needed = static_cast<std::size_t>(frame_count_ / kFramesPerBlock) + 1;
    if (blocks_needed > blocks_.size()) blocks_.push_back(std::make_unique<FrameBlock>());
    ++frame_count_;
    stored(record.frame) = record;
}

void Recorder::set_gpu_ms(std::int64_t frame, double gpu_ms) { stored(frame).gpu_ms = gpu_ms; }

Summary Recorder::summary_of(std::string_view name) const {
    const FrameColumn& column = column_named(name);
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(frame_count_));
    for (std::int64_t index = 0; index < frame_count_; ++index) {
        const double value = column.value(stored(index));
        if (!std::isnan(value)) values.push_back(value);
    }
    return summarise(values);
}

std::string Recorder::frames_csv() const {
    std::string csv = csv_header();
    for (std::int64_t index = 0; index < frame_count_; ++index) append_csv_row(stored(index), csv);
    return csv;
}

// --- Results ---

RunSummary Recorder::summary() {
    finish();
    RunSummary run;
    run.description = description_;
    run.frames = frame_count_;
    run.seconds = measured_seconds();
    run.frame_ms = summary_of("frame_ms");
    run.selection_ms = summary_of("selection_ms");
    run.gpu_ms = summary_of("gpu_ms");
    run.request_to_ready_ms = request_to_ready_ns_.summary(1e6);
    run.request_to_drawn_frames = request_to_drawn_frames_.summary();
    run.cpu_percent = cpu_percent(run.seconds);
    for (const auto name : kMeans) run.per_frame.emplace_back(name, summary_of(name).mean);
    run.tiles = tiles_.now();
    for (std::int64_t index = 0; index < frame_count_; ++index) {
        run.frames_with_missing_tiles += stored(index).tiles_missing > 0 ? 1 : 0;
        run.frames_with_missing_heights += stored(index).heights_missing > 0 ? 1 : 0;
        run.frames_with_missing_imagery += stored(index).imagery_missing > 0 ? 1 : 0;
    }
    run.peak_rss_bytes = peak_rss_bytes();
    run.ram_cache_bytes_max = static_cast<std::int64_t>(summary_of("ram_cache_bytes").max);
    run.gpu_cache_bytes_max = static_cast<std::int64_t>(summary_of("gpu_cache_bytes").max);
    return run;
}

RunSummary::Tiles TileCounters::now() const {
    const auto read = [](const std::atomic<std::uint64_t>& count) {
        return count.load(std::memory_order_relaxed);
    };
    return {.requested = read(requested),
            .loaded = read(loaded),
            .cancelled = read(cancelled),
            .failed = read(failed),
            .retried = read(retried),
            .evicted = read(evicted)};
}

Result<void> Recorder::write(const std::filesystem::path& directory) {
    const RunSummary run = summary();
    std::error_code failure;
    std::filesystem::create_directories(directory, failure);
    if (failure)
        return Error{directory.string() + ": cannot make the telemetry directory: " + failure.message()};
    RIDGELINE_TRY(write_whole_file(directory / "frames.csv", frames_csv()));
    RIDGELINE_TRY(trace_.write(directory / "trace.json"));
    return write_whole_file(directory / "summary.json", to_json(run));
}

}  // namespace ridgeline::telemetry
