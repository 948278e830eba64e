#include "ridgeline/telemetry/allocation_counter.h"

#include <atomic>
#include <memory>

namespace ridgeline::telemetry {
namespace {

// Constant-initialised: operator new is called before any constructor has run.
constinit std::atomic<std::uint64_t> of_all_threads{0};
constinit thread_local std::uint64_t of_this_thread = 0;

}  // namespace

void count_heap_allocation() {
    of_all_threads.fetch_add(1, std::memory_order_relaxed);
    ++of_this_thread;
}

bool counts_heap_allocations() {
    const auto before = of_this_thread;
    // Called by name: a new-expression may be optimised away.
    ::operator delete(::operator new(1));
    return of_this_thread != before;
}

std::uint64_t heap_allocations() { return of_all_threads.load(std::memory_order_relaxed); }
std::uint64_t heap_allocations_of_this_thread() { return of_this_thread; }

}  // namespace ridgeline::telemetry
