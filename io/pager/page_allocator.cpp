// Segregated fits after Masmano et al., "TLSF: a New Dynamic Memory Allocator for Real-Time Systems" (ECRTS
// 2004): free runs in lists by size class, a bit per class that is not empty, boundary tags to merge
// neighbours.
//
// Ours differs in two ways. Tags lie outside the memory, since blocks belong to other threads while tags
// change. And the block's own size class is searched as well, so that allocation fails only where no run is
// long enough: a cache that is nearly always full cannot afford to overlook one.
#include "ridgeline/pager/page_allocator.h"

#include <algorithm>
#include <bit>
#include <new>
#include <utility>

namespace ridgeline::pager {
namespace {

// How far an allocation looks in its own size class while larger runs exist: a good fit, not the best.
constexpr int kCloseFitSteps = 8;

}  // namespace

Result<PageAllocator> PageAllocator::create(std::uint32_t page_count) {
    RIDGELINE_CHECK(page_count > 0 && page_count <= kMaxPages);
    std::unique_ptr<Page[]> pages(new (std::nothrow) Page[page_count]);
    if (!pages)
        return Error{"memory: not enough of it for a cache of " + std::to_string(page_count) + " pages"};
    return PageAllocator(std::move(pages), page_count);
}

PageAllocator::PageAllocator(std::unique_ptr<Page[]> pages, std::uint32_t count)
    : pages_(std::move(pages)), page_count_(count) {
    heads_.fill(kNone);
    insert_free(0, count);
}

// Sizes below 8 have a bin each; above, the three bits after the leading one choose among 8.
int PageAllocator::bin_of(std::uint32_t pages) {
    if (pages < 8) return static_cast<int>(pages);
    const int octave = std::bit_width(pages) - 4;
    return octave * 8 + static_cast<int>(pages >> octave);
}

int PageAllocator::first_bin_from(int bin) const {
    for (int word = bin / 64; word < kBinWords; ++word) {
        std::uint64_t bits = occupied_[static_cast<std::size_t>(word)];
        if (word == bin / 64) bits &= ~std::uint64_t{0} << (bin % 64);
        if (bits) return word * 64 + std::countr_zero(bits);
    }
    return kBins;
}

std::uint32_t PageAllocator::find_in_bin(int bin, std::uint32_t pages, int most_steps) const {
    std::uint32_t run = heads_[static_cast<std::size_t>(bin)];
    for (int step = 0; run != kNone && step < most_steps; ++step, run = pages_[run].next)
        if (pages_[run].run >> 1 >= pages) return run;
    return kNone;
}

std::uint32_t PageAllocator::find(std::uint32_t pages) const {
    const int bin = bin_of(pages);
    const int larger = first_bin_from(bin + 1);
    const int steps = larger < kBins ? kCloseFitSteps : static_cast<int>(page_count_);
    const std::uint32_t close = find_in_bin(bin, pages, steps);
    if (close != kNone || larger == kBins) return close;
    return heads_[static_cast<std::size_t>(larger)];
}

PageRun PageAllocator::allocate(std::uint32_t pages) {
    RIDGELINE_CHECK(pages > 0);
    if (pages > page_count_ - used_pages_) return {};
    const std::uint32_t first = find(pages);
    if (first == kNone) return {};
    const std::uint32_t rest = (pages_[first].run >> 1) - pages;
    remove_free(first);
    if (rest > 0) insert_free(first + pages, rest);
    mark(first, pages, 0);
    used_pages_ += pages;
    return {first, pages};
}

void PageAllocator::free(PageRun run) {
    RIDGELINE_CHECK(run && run.first_page < page_count_ && pages_[run.first_page].run == run.pages << 1);
    used_pages_ -= run.pages;
    std::uint32_t first = run.first_page;
    std::uint32_t end = first + run.pages;
    if (end < page_count_ && (pages_[end].run & 1)) {
        const std::uint32_t next = end;
        end += pages_[next].run >> 1;
        remove_free(next);
    }
    if (first > 0 && (pages_[first - 1].run & 1)) {
        first -= pages_[first - 1].run >> 1;
        remove_free(first);
    }
    insert_free(first, end - first);
}

void PageAllocator::mark(std::uint32_t first, std::uint32_t pages, std::uint32_t free) {
    pages_[first].run = pages_[first + pages - 1].run = pages << 1 | free;
}

void PageAllocator::insert_free(std::uint32_t first, std::uint32_t pages) {
    const auto bin = static_cast<std::size_t>(bin_of(pages));
    mark(first, pages, 1);
    pages_[first].previous = kNone;
    pages_[first].next = heads_[bin];
    if (heads_[bin] != kNone) pages_[heads_[bin]].previous = first;
    heads_[bin] = first;
    occupied_[bin / 64] |= std::uint64_t{1} << (bin % 64);
}

void PageAllocator::remove_free(std::uint32_t first) {
    const Page& page = pages_[first];
    if (page.next != kNone) pages_[page.next].previous = page.previous;
    if (page.previous != kNone) {
        pages_[page.previous].next = page.next;
        return;
    }
    const auto bin = static_cast<std::size_t>(bin_of(page.run >> 1));
    heads_[bin] = page.next;
    if (page.next == kNone) occupied_[bin / 64] &= ~(std::uint64_t{1} << (bin % 64));
}

std::uint32_t PageAllocator::largest_free_pages() const {
    std::uint32_t largest = 0;
    for (const std::uint32_t head : heads_)
        for (std::uint32_t run = head; run != kNone; run = pages_[run].next)
            largest = std::max(largest, pages_[run].run >> 1);
    return largest;
}

}  // namespace ridgeline::pager
