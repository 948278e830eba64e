// A request on its way from the render thread through the I/O thread and a worker back.
//
// What a request says (BatchRequest) travels by value, so nobody reads what another may rewrite. What is left
// to agree on is who may go on with it: one atomic word per request slot, generation and state together,
// changed by compare-and-swap. A ticket of an older generation matches nothing, so a slot may be used again
// the moment its request is cancelled, whatever stale batches the I/O thread still holds.
//
//   render: open → queued      I/O: queued → reading → decoding | failed      render: close, when completed
//   render: cancel from queued or reading; the block is then the render thread's again at once
//
// From decoding on, the block is the worker's until the completion arrives.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ridgeline/base/contract.h"
#include "ridgeline/pager/residency.h"

namespace ridgeline::pager {

struct RequestTicket {
    std::uint32_t slot = 0;
    std::uint32_t generation = 0;
};

// One tile to be read and decoded into `block`.
struct BatchRequest {
    RequestTicket ticket;
    NodeIndex tile = kNoNode;
    std::span<std::byte> block;
};

// The end of a request that was not cancelled.
struct Completion {
    RequestTicket ticket;
    TileState outcome = TileState::ready;  // or failed, damaged
    std::chrono::steady_clock::time_point time;
    std::string message;  // what went wrong
};

class RequestBoard {
  public:
    explicit RequestBoard(std::uint32_t slots)
        : words_(new std::atomic<std::uint64_t>[slots]), slots_(slots) {
        for (std::uint32_t i = 0; i < slots; ++i) words_[i].store(word(0, TileState::absent));
        for (std::uint32_t i = slots; i > 0; --i) free_.push_back(i - 1);
    }

    // Render thread.
    std::uint32_t slots() const { return slots_; }
    bool full() const { return free_.empty(); }
    RequestTicket open() {
        RIDGELINE_CHECK(!full());
        const std::uint32_t slot = free_.back();
        free_.pop_back();
        const std::uint32_t generation = generation_of(words_[slot].load(std::memory_order_relaxed));
        words_[slot].store(word(generation, TileState::queued), std::memory_order_release);
        return {slot, generation};
    }
    // True: the request is over and its ticket void. False: too late, it will be completed.
    bool cancel(RequestTicket ticket) {
        return retire(ticket, TileState::queued) || retire(ticket, TileState::reading);
    }
    // After the completion. False: the ticket is void already.
    bool close(RequestTicket ticket) {
        return retire(ticket, TileState::decoding) || retire(ticket, TileState::failed);
    }

    // Any thread: absent where the ticket is void.
    TileState state(RequestTicket ticket) const {
        const std::uint64_t now = words_[ticket.slot].load(std::memory_order_acquire);
        return generation_of(now) == ticket.generation ? static_cast<TileState>(now & 0xff)
                                                       : TileState::absent;
    }

    // I/O thread: takes the request one state on; false where it was cancelled or is elsewhere.
    bool advance(RequestTicket ticket, TileState from, TileState to) {
        std::uint64_t expected = word(ticket.generation, from);
        return words_[ticket.slot].compare_exchange_strong(expected, word(ticket.generation, to),
                                                           std::memory_order_acq_rel);
    }

  private:
    static std::uint64_t word(std::uint32_t generation, TileState state) {
        return std::uint64_t{generation} << 8 | static_cast<std::uint64_t>(state);
    }
    static std::uint32_t generation_of(std::uint64_t word) { return static_cast<std::uint32_t>(word >> 8); }

    bool retire(RequestTicket ticket, TileState from) {
        std::uint64_t expected = word(ticket.generation, from);
        if (!words_[ticket.slot].compare_exchange_strong(
                expected, word(ticket.generation + 1, TileState::absent), std::memory_order_acq_rel))
            return false;
        free_.push_back(ticket.slot);
        return true;
    }

    std::unique_ptr<std::atomic<std::uint64_t>[]> words_;
    std::uint32_t slots_;
    std::vector<std::uint32_t> free_;  // render thread
};

}  // namespace ridgeline::pager
