// Replaces the global operator new and delete, in all their forms, by ones that count and call malloc and
// free. (By default the forms for arrays and for no-throw call the plain ones, but not under the sanitizers.)
// Linked as an object, so that it is not left out of a static library for want of a reference.
#include <cstdlib>
#include <new>

#include "ridgeline/telemetry/allocation_counter.h"

namespace {

void* counted(void* memory) {
    if (memory) ridgeline::telemetry::count_heap_allocation();
    return memory;
}

void* allocate(std::size_t size_bytes) { return counted(std::malloc(size_bytes ? size_bytes : 1)); }

void* allocate(std::size_t size_bytes, std::align_val_t alignment) {
    const auto alignment_bytes = static_cast<std::size_t>(alignment);
    // aligned_alloc wants a multiple of the alignment, and not zero.
    const auto whole_bytes = (size_bytes + alignment_bytes - 1) / alignment_bytes * alignment_bytes;
    return counted(std::aligned_alloc(alignment_bytes, whole_bytes ? whole_bytes : alignment_bytes));
}

void* or_throw(void* memory) {
    if (!memory) throw std::bad_alloc();
    return memory;
}

}  // namespace

void* operator new(std::size_t size) { return or_throw(allocate(size)); }
void* operator new[](std::size_t size) { return or_throw(allocate(size)); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return allocate(size); }

void* operator new(std::size_t size, std::align_val_t align) { return or_throw(allocate(size, align)); }
void* operator new[](std::size_t size, std::align_val_t align) { return or_throw(allocate(size, align)); }
void* operator new(std::size_t size, std::align_val_t align, const std::nothrow_t&) noexcept {
    return allocate(size, align);
}
void* operator new[](std::size_t size, std::align_val_t align, const std::nothrow_t&) noexcept {
    return allocate(size, align);
}

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }

void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t, const std::nothrow_t&) noexcept { std::free(memory); }
