// The RAM ring: a fixed number of bytes, allocated once, handed out in blocks of whole pages.
//
// Owns the memory and nothing else: which node lies in which block is the residency table's business, and who
// may write a block is the pager's. One thread at a time calls it (the render thread); the memory of a block
// that is handed out may be written by whichever thread holds the block.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <utility>

#include "ridgeline/base/result.h"
#include "ridgeline/pager/page_allocator.h"

namespace ridgeline::pager {

// A run of pages of the ring; empty where pages is 0.
using RamBlock = PageRun;

class RamRing {
  public:
    // A decoded chunk takes about 80 KiB: pages waste some 2 % of it, and their book-keeping 0.4 %.
    static constexpr std::size_t kPageBytes = 4096;

    // Capacity is `bytes` rounded down to whole pages, one at least. Fails where the system has not that much
    // memory.
    static Result<RamRing> create(std::uint64_t bytes);

    // The smallest block of at least `bytes`; empty where no free run is long enough.
    RamBlock allocate(std::size_t bytes);
    // The block must have come from allocate() and not have been freed since.
    void free(RamBlock block) { pages_.free(block); }

    std::span<std::byte> bytes(RamBlock block) const {
        return {memory_.get() + std::size_t{block.first_page} * kPageBytes,
                std::size_t{block.pages} * kPageBytes};
    }

    static std::uint32_t pages_for(std::size_t bytes) {
        return static_cast<std::uint32_t>((bytes + kPageBytes - 1) / kPageBytes);
    }
    std::uint32_t page_count() const { return pages_.page_count(); }
    std::uint64_t capacity_bytes() const { return std::uint64_t{pages_.page_count()} * kPageBytes; }
    std::uint64_t used_bytes() const { return std::uint64_t{pages_.used_pages()} * kPageBytes; }
    // The longest free run, for messages and tests; walks the free lists.
    std::uint32_t largest_free_pages() const { return pages_.largest_free_pages(); }

  private:
    struct AlignedDelete {
        void operator()(std::byte* memory) const {
            ::operator delete[](memory, std::align_val_t{kPageBytes});
        }
    };
    using Memory = std::unique_ptr<std::byte[], AlignedDelete>;

    RamRing(Memory memory, PageAllocator pages) : memory_(std::move(memory)), pages_(std::move(pages)) {}

    Memory memory_;
    PageAllocator pages_;
};

}  // namespace ridgeline::pager
