// Faults on purpose: a byte source that is slow, fails, stops short or lies, to try the pager under what
// disks do.
//
// Deterministic: what happens to the n-th read follows from the seed and n alone. Reads may come from any
// thread; advance() from the render thread; interrupt() from any.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <limits>
#include <string_view>

#include "ridgeline/base/result.h"
#include "ridgeline/base/thread_annotations.h"
#include "ridgeline/io/byte_source.h"

namespace ridgeline::pager {

struct FaultSpec {
    std::chrono::microseconds delay{0};  // before every read
    double error = 0.0;                  // probabilities per read
    double short_read = 0.0;
    double corrupt = 0.0;  // one byte is changed and the read succeeds: only the checksum can tell
    std::uint64_t seed = 1;
    // Reads are sound from this frame on.
    std::uint32_t until_frame = std::numeric_limits<std::uint32_t>::max();

    bool any() const { return delay.count() > 0 || error > 0.0 || short_read > 0.0 || corrupt > 0.0; }
};

// "delay=50ms,error=0.1,short-read=0.05,corrupt=0.01,seed=7,until=600", each part once at most, in any order.
Result<FaultSpec> parse_fault(std::string_view text);

// Sleep that another thread can end for good.
class Interrupt {
  public:
    // False if interrupted, before or meanwhile.
    bool sleep_for(std::chrono::microseconds duration);
    void interrupt();

  private:
    Mutex mutex_;
    std::condition_variable_any wake_;
    bool interrupted_ RIDGELINE_GUARDED_BY(mutex_) = false;
};

class FaultySource final : public io::ByteSource {
  public:
    // `source` must outlive this.
    FaultySource(io::ByteSource& source, const FaultSpec& spec) : source_(source), spec_(spec) {}

    // Fails at once after interrupt().
    Result<void> read(std::uint64_t offset, std::span<std::uint8_t> bytes) override;
    std::uint64_t size() const override { return source_.size(); }

    // Tells the frame, for FaultSpec::until_frame.
    void advance(std::uint32_t frame) { frame_.store(frame, std::memory_order_relaxed); }
    // Ends the delay under way and all later ones.
    void interrupt() { interrupt_.interrupt(); }

  private:
    io::ByteSource& source_;
    FaultSpec spec_;
    std::atomic<std::uint32_t> frame_{0};
    std::atomic<std::uint64_t> reads_{0};
    Interrupt interrupt_;
};

}  // namespace ridgeline::pager
