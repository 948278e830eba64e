// How our moodycamel queues differ from their defaults.
#pragma once

#include <concurrentqueue/concurrentqueue.h>

#include <cstddef>
#include <new>

namespace ridgeline::jobs {

struct QueueTraits : moodycamel::ConcurrentQueueDefaultTraits {
    // Blocks that a producer can have in use before its index of them grows: of 32 elements each, so 4096
    // elements.
    static constexpr std::size_t EXPLICIT_INITIAL_INDEX_SIZE = 128;
    static constexpr std::size_t IMPLICIT_INITIAL_INDEX_SIZE = 128;

    // Through operator new, so that whoever counts allocations sees those of queues too.
    static void* malloc(std::size_t size_bytes) { return ::operator new(size_bytes, std::nothrow); }
    static void free(void* memory) { ::operator delete(memory); }
};

}  // namespace ridgeline::jobs
