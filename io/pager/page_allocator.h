// Runs of pages out of a fixed number of them; which memory the pages are is the owner's business (the RAM
// ring's, the GPU slots').
//
// An offset allocator: free runs are kept in lists by size, 8 sizes an octave, and merged with their
// neighbours when they come back; no operation allocates, and none walks all pages. One thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "ridgeline/base/result.h"

namespace ridgeline::pager {

// Empty where pages is 0.
struct PageRun {
    std::uint32_t first_page = 0;
    std::uint32_t pages = 0;
    explicit operator bool() const { return pages != 0; }
};

class PageAllocator {
  public:
    static constexpr std::uint32_t kMaxPages = std::uint32_t{1} << 30;

    // 1 to kMaxPages pages. Fails where the system has not the memory for the book-keeping, 12 bytes a page.
    static Result<PageAllocator> create(std::uint32_t page_count);

    // A run of `pages` > 0; empty where no free run is long enough.
    PageRun allocate(std::uint32_t pages);
    // The run must have come from allocate() and not have been freed since.
    void free(PageRun run);

    std::uint32_t page_count() const { return page_count_; }
    std::uint32_t used_pages() const { return used_pages_; }
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

    PageAllocator(std::unique_ptr<Page[]> pages, std::uint32_t count);

    static int bin_of(std::uint32_t pages);
    std::uint32_t find(std::uint32_t pages) const;
    std::uint32_t find_in_bin(int bin, std::uint32_t pages, int most_steps) const;
    int first_bin_from(int bin) const;
    void mark(std::uint32_t first, std::uint32_t pages, std::uint32_t free);
    void insert_free(std::uint32_t first, std::uint32_t pages);
    void remove_free(std::uint32_t first);

    std::unique_ptr<Page[]> pages_;
    std::uint32_t page_count_ = 0;
    std::uint32_t used_pages_ = 0;
    std::array<std::uint32_t, kBins> heads_{};
    std::array<std::uint64_t, kBinWords> occupied_{};
};

}  // namespace ridgeline::pager
