// The RAM ring: a fixed number of bytes, allocated once, handed out in blocks of whole pages.
//
// Owns the memory and nothing else: which node lies in which block is the residency table's business, and who
// may write a block is the pager's. An offset allocator: free runs of pages are kept in lists by size, 8
// sizes an octave, and merged with their neighbours when they come back; no operation allocates, and none
// walks the ring. One thread at a time calls it (the render thread); the memory of a block that is handed out
// may be written by whichever thread holds the block.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>

#include "ridgeline/base/result.h"

namespace ridgeline::pager {

// A run of pages of the ring; empty where pages is 0.
struct RamBlock {
    std::uint32_t first_page = 0;
    std::uint32_t pages = 0;
    explicit operator bool() const { return pages != 0; }
};

class RamRing {
  public:
    // A decoded chunk takes about 80 KiB: pages waste some 2 % of it, and their book-keeping 0.4 %.
    static constexpr std::size_t kPageBytes = 4096;

    // Capacity is `bytes` rounded down to whole pages. Fails where the system has not that much memory.
    static Result<RamRing> create(std::uint64_t bytes);

    // The smallest block of at least `bytes`; empty where no free run is long enough.
    RamBlock allocate(std::size_t bytes);
    // The block must have come from allocate() and not have been freed since.
    void free(RamBlock block);

    std::span<std::byte> bytes(RamBlock block) const {
        return {memory_.get() + std::size_t{block.first_page} * kPageBytes,
                std::size_t{block.pages} * kPageBytes};
    }

    static std::uint32_t pages_for(std::size_t bytes) {
        return static_cast<std::uint32_t>((bytes + kPageBytes - 1) / kPageBytes);
    }
    std::uint32_t page_count() const { return page_count_; }
    std::uint64_t capacity_bytes() const { return std::uint64_t{page_count_} * kPageBytes; }
    std::uint64_t used_bytes() const { return std::uint64_t{used_pages_} * kPageBytes; }
    // The longest free run, for messages and tests; walks the free lists.
    std::uint32_t largest_free_pages() const;

  private:
    static constexpr std::uint32_t kNone = 0xffffffffu;
    // 8 bins an octave up to 2^31 pages.
    static constexpr int kBins = 8 * 30;
    static constexpr int kBinWords = (kBins + 63) / 64;

    // One per page, meaningful at the first page of a run and, for `run`, also at its last.
    struct Page {
        std::uint32_t run = 0;  // pages in the run << 1 | 1 if free
        std::uint32_t next = kNone;
        std::uint32_t previous = kNone;
    };
    struct AlignedDelete {
        void operator()(std::byte* memory) const {
            ::operator delete[](memory, std::align_val_t{kPageBytes});
        }
    };

    RamRing(std::unique_ptr<std::byte[], AlignedDelete> memory, std::unique_ptr<Page[]> pages,
            std::uint32_t count);

    static int bin_of(std::uint32_t pages);
    std::uint32_t find(std::uint32_t pages) const;
    std::uint32_t find_in_bin(int bin, std::uint32_t pages, int most_steps) const;
    int first_bin_from(int bin) const;
    void mark(std::uint32_t first, std::uint32_t pages, std::uint32_t free);
    void insert_free(std::uint32_t first, std::uint32_t pages);
    void remove_free(std::uint32_t first);

    std::unique_ptr<std::byte[], AlignedDelete> memory_;
    std::unique_ptr<Page[]> pages_;
    std::uint32_t page_count_ = 0;
    std::uint32_t used_pages_ = 0;
    std::array<std::uint32_t, kBins> heads_{};
    std::array<std::uint64_t, kBinWords> occupied_{};
};

}  // namespace ridgeline::pager
