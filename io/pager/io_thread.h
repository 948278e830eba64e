// The I/O thread: reads what the newest batch asks for, most urgent first, and hands it to workers for
// decoding.
//
// Owns the thread, the buffers that encoded payloads pass through, and the queues; all sized at start. The
// render thread fills and publishes batches and receives completions; nothing it calls here waits. Destroying
// it joins the thread and waits for the few decodes under way; injected delays end at once. Requests that
// were neither completed nor cancelled by then are forgotten.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <thread>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/jobs/counter.h"
#include "ridgeline/jobs/mailbox.h"
#include "ridgeline/jobs/queue.h"
#include "ridgeline/pager/fault.h"
#include "ridgeline/pager/read_group.h"
#include "ridgeline/pager/request.h"
#include "ridgeline/pager/tile_source.h"

namespace ridgeline::jobs {
class JobSystem;
}
namespace ridgeline::telemetry {
class Recorder;
class Trace;
}  // namespace ridgeline::telemetry

namespace ridgeline::pager {

struct IoThreadOptions {
    FaultSpec fault{};
    ReadLimits limits{};
    // Decodes with the workers at a time.
    std::uint32_t max_decodes = 2;
    // Reads repeated before a failure is reported, after first_pause and four times that and so on.
    int quick_retries = 2;
    std::chrono::microseconds first_pause{10'000};
    // Null, or takes the thread's CPU time and traces of reads and decodes.
    telemetry::Recorder* recorder = nullptr;
};

// Since the start; of one kind of tile.
struct IoCounters {
    std::uint64_t reads = 0;
    std::uint64_t bytes_read = 0;
    std::uint64_t retried = 0;
};

class IoThread {
  public:
    using Batch = std::vector<BatchRequest>;

    // All that is passed by reference must outlive this.
    IoThread(const TileSource& source, const TileDecoder& decoder, jobs::JobSystem& jobs, RequestBoard& board,
             const IoThreadOptions& options);
    ~IoThread();
    IoThread(const IoThread&) = delete;
    IoThread& operator=(const IoThread&) = delete;

    // Render thread: fill with every request that still stands, most urgent first, and publish; it replaces
    // the batch before. Holds some older batch at first.
    Batch& draft() { return batches_.draft(); }
    void publish();
    // Render thread.
    bool receive(Completion& completion) { return completions_.receiver().receive(completion); }
    // Tells the frame, for FaultSpec::until_frame.
    void advance(std::uint32_t frame);
    // Any thread.
    IoCounters counters(TileKind kind) const;

  private:
    using Clock = std::chrono::steady_clock;

    // A request that the I/O thread reads.
    struct Reading {
        BatchRequest request;
        int attempts = 0;  // that failed
        Clock::time_point due{};
    };
    // What one decode job works with; the I/O thread's while free, the worker's while the job is under way.
    struct DecodeSlot {
        BatchRequest request;
        std::vector<std::uint8_t> first, second;  // as TilePayloads has them
        DecodeScratch scratch;
    };
    // The files of one kind of tile, as TilePayloads has them; imagery has no second.
    struct Files {
        std::optional<FaultySource> first, second;
    };
    struct AtomicCounters {
        std::atomic<std::uint64_t> reads{0}, bytes_read{0}, retried{0};
    };
    struct LargestPayloads {
        std::size_t first = 0, second = 0;
    };

    static LargestPayloads largest_payloads(const TileSource& source);
    template <class Visit>
    void for_each_file(Visit visit);
    void run_on_io_thread();
    void run_rounds_on_io_thread();
    bool stopping() const { return stopping_.load(std::memory_order_relaxed); }
    void sleep_on_io_thread(Clock::time_point until);

    bool choose_on_io_thread();
    bool choose_from_batch_on_io_thread();
    bool choose_from_retries_on_io_thread();
    void add_candidate_on_io_thread(std::uint32_t index, NodeIndex tile);

    void read_on_io_thread();
    Result<void> read_range_on_io_thread(std::optional<FaultySource>& source, const ByteRange& range,
                                         std::vector<std::uint8_t>& buffer);
    Result<void> check_on_io_thread(NodeIndex tile) const;
    void hand_over_on_io_thread(const BatchRequest& request);
    bool wait_for_slot_on_io_thread();
    void retry_or_fail_on_io_thread(const Reading& reading, const Error& error);
    void decode_on_worker(std::uint32_t slot);
    Result<void> decode_on_worker(DecodeSlot& slot);

    const TileSource& source_;
    const TileSpace tiles_;
    const TileDecoder& decoder_;
    jobs::JobSystem& jobs_;
    RequestBoard& board_;
    IoThreadOptions options_;
    telemetry::Trace* trace_;
    std::array<Files, kTileKinds> files_;

    jobs::Mailbox<Batch> batches_;
    jobs::Queue<Completion> completions_;
    jobs::Queue<std::uint32_t> returned_slots_;
    std::vector<DecodeSlot> slots_;
    jobs::Counter decodes_;
    std::array<AtomicCounters, kTileKinds> counts_;
    std::atomic<bool> stopping_{false};

    // The I/O thread's own.
    Batch* batch_ = nullptr;
    std::uint32_t next_ = 0;  // in the batch
    std::vector<Reading> group_, retries_;
    std::vector<ReadCandidate> candidates_;
    TileKind reading_ = TileKind::chunk;  // what the group holds
    std::vector<std::uint8_t> first_bytes_, second_bytes_;
    ReadRanges ranges_;
    std::vector<std::uint32_t> free_slots_;

    std::thread thread_;
};

}  // namespace ridgeline::pager
