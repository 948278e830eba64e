// Collects what a walk did and writes it: DIR/frames.csv, DIR/summary.json and DIR/trace.json.
//
// Frames are added by the render thread alone; tile counters, histograms and the trace may be used by any
// thread. Memory for frames is taken in blocks of thousands, so that recording allocates nothing in nearly
// every frame. Threads whose CPU time is reported say so themselves (count_this_thread); they need not
// outlive the recorder, nor it them, but none may come or go while the recorder is destroyed.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/base/thread_annotations.h"
#include "ridgeline/telemetry/clock.h"
#include "ridgeline/telemetry/frame_record.h"
#include "ridgeline/telemetry/histogram.h"
#include "ridgeline/telemetry/run_summary.h"
#include "ridgeline/telemetry/trace.h"

namespace ridgeline::telemetry {

// What became of tiles since the start. Any thread.
struct TileCounters {
    std::atomic<std::uint64_t> requested{0};
    std::atomic<std::uint64_t> loaded{0};
    std::atomic<std::uint64_t> cancelled{0};
    std::atomic<std::uint64_t> failed{0};
    std::atomic<std::uint64_t> retried{0};
    std::atomic<std::uint64_t> evicted{0};

    RunSummary::Tiles now() const;
};

// Whose CPU time a thread's is counted as.
enum class CpuGroup { render, io, workers };

struct RecorderOptions {
    TraceOptions trace{};
};

class Recorder {
  public:
    explicit Recorder(const RecorderOptions& options = {});
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    void describe(RunDescription description) { description_ = std::move(description); }

    // The measured time begins at start() (or at construction) and ends at finish() (or when results are
    // asked for).
    void start();
    void finish();

    // Counts the calling thread's CPU time from now on, until it ends or says otherwise.
    void count_this_thread(CpuGroup group);
    // To be called by a counted thread that ends before finish(), whose time would be lost otherwise.
    void release_this_thread();

    // Render thread. `record.frame` counts up by one from 0.
    void add_frame(const FrameRecord& record);
    // Render thread: the time that the GPU took for a frame added earlier.
    void set_gpu_ms(std::int64_t frame, double gpu_ms);
    std::int64_t frame_count() const { return frame_count_; }
    const FrameRecord& frame(std::int64_t index) const;

    TileCounters& tiles() { return tiles_; }
    // Nanoseconds from a tile's first request to its being ready to draw.
    Histogram& request_to_ready_ns() { return request_to_ready_ns_; }
    // Frames from a tile's first request to the first in which it is drawn.
    Histogram& request_to_drawn_frames() { return request_to_drawn_frames_; }
    Trace* trace() { return &trace_; }

    // Ends the measured time.
    RunSummary summary();
    // Makes the directory where it is missing. Each file is whole or not there.
    Result<void> write(const std::filesystem::path& directory);

  private:
    struct CountedThread {
        CpuGroup group;
        pthread_t thread;
        ThreadCpuClock clock;
        std::int64_t start_ns = 0;
        std::int64_t used_ns = 0;
        bool released = false;

        void stop();
    };

    // Frames that memory is taken for at once: about four minutes at sixty a second, 3 MB.
    static constexpr std::int64_t kFramesPerBlock = 1 << 14;
    using FrameBlock = std::array<FrameRecord, kFramesPerBlock>;

    FrameRecord& stored(std::int64_t index) const;
    Summary summary_of(std::string_view column) const;
    double measured_seconds() const;
    RunSummary::CpuPercent cpu_percent(double seconds) const;
    std::string frames_csv() const;

    RunDescription description_;
    std::vector<std::unique_ptr<FrameBlock>> blocks_;
    std::int64_t frame_count_ = 0;

    TileCounters tiles_;
    Histogram request_to_ready_ns_;
    Histogram request_to_drawn_frames_;
    Trace trace_;

    // The measured time and what it cost.
    mutable Mutex time_mutex_;
    std::int64_t start_ns_ RIDGELINE_GUARDED_BY(time_mutex_) = 0;
    std::int64_t end_ns_ RIDGELINE_GUARDED_BY(time_mutex_) = 0;  // zero while running
    std::int64_t process_cpu_start_ns_ RIDGELINE_GUARDED_BY(time_mutex_) = 0;
    std::int64_t process_cpu_used_ns_ RIDGELINE_GUARDED_BY(time_mutex_) = 0;
    std::vector<CountedThread> threads_ RIDGELINE_GUARDED_BY(time_mutex_);
};

}  // namespace ridgeline::telemetry
