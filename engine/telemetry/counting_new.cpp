// Replaces the global operator new and delete by ones that count and call malloc and free. Linked as an
// object, so that it is not left out of a static library for want of a reference. The forms for arrays and
// for no-throw are left alone: by default they call these.
#include <cstdlib>
#include <new>

#include "ridgeline/telemetry/allocation_counter.h"

namespace {

void* checked(void* memory) {
    if (!memory) throw std::bad_alloc();
    ridgeline::telemetry::count_heap_allocation();
    return memory;
}

}  // namespace

void* operator new(std::size_t size_bytes) { return checked(std::malloc(size_bytes ? size_bytes : 1)); }

void* operator new(std::size_t size_bytes, std::align_val_t alignment) {
    const auto alignment_bytes = static_cast<std::size_t>(alignment);
    // aligned_alloc wants a multiple of the alignment, and not zero.
    const auto whole_bytes = (size_bytes + alignment_bytes - 1) / alignment_bytes * alignment_bytes;
    return checked(std::aligned_alloc(alignment_bytes, whole_bytes ? whole_bytes : alignment_bytes));
}

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
