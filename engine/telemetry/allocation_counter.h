// Counts heap allocations, so that "a frame allocates nothing" can be measured and tested.
//
// Counts only in programs that link ridgeline::allocation_counter, which replaces the global operator new;
// elsewhere all counts stay zero. What calls malloc directly (drivers, C libraries) is not counted. Any
// thread.
#pragma once

#include <cstdint>

namespace ridgeline::telemetry {

// True in a program that links the counter.
bool counts_heap_allocations();

// Calls of operator new since the program began, by all threads and by the calling one.
std::uint64_t heap_allocations();
std::uint64_t heap_allocations_of_this_thread();

// For the replacement of operator new alone.
void count_heap_allocation();

}  // namespace ridgeline::telemetry
