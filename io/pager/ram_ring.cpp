// Segregated fits after Masmano et al., "TLSF: a New Dynamic Memory Allocator for Real-Time Systems" (ECRTS
// 2004): free runs in lists by size class, a bit per class that is not empty, boundary tags to merge
// neighbours.
//
// Ours differs in two ways. Tags lie outside the memory, since blocks belong to other threads while tags
// change. And the block's own size class is searched as well, so that allocation fails only where no run is
// long enough: a cache that is nearly always full cannot afford to overlook one.
#include "ridgeline/pager/ram_ring.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "ridgeline/base/units.h"

namespace ridgeline::pager {
namespace {

constexpr std::uint32_t kMaxPages = std::uint32_t{1} << 30;
// How far an allocation looks in its own size class while larger runs exist: a good fit, not the best.
constexpr int kCloseFitSteps = 8;

}  // namespace

Result<RamRing> RamRing::create(std::uint64_t bytes) {
    const std::uint64_t count = bytes / kPageBytes;
    if (count == 0)
        return Error{"RAM cache of " + format_bytes(bytes) + ": too small: use --ram-cache 64MiB or more"};
    if (count > kMaxPages)
        return Error{"RAM cache of " + format_bytes(bytes) + ": too large: 4 TiB is the most"};
    std::unique_ptr<std::byte[], AlignedDelete> memory(new (std::align_val_t{kPageBytes}, std::nothrow)
                                                           std::byte[count * kPageBytes]);
    std::unique_ptr<Page[]> pages(new (std::nothrow) Page[count]);
    if (!memory || !pages)
        return Error{"RAM cache of " + format_bytes(bytes) +
                     ": the system has not that much memory: use a smaller --ram-cache"};
    return RamRing(std::move(memory), std::move(pages), static_cast<std::uint32_t>(count));
}

RamRing::RamRing(std::unique_ptr<std::byte[], AlignedDelete> memory, std::unique_ptr<Page[]> pages,
                 std::uint32_t count)
    : memory_(std::move(memory)), pages_(std::move(pages)), page_count_(count) {
    heads_.fill(kNone);
    insert_free(0, count);
}

// Sizes below 8 have a bin each; above, the three bits after the leading one choose among 8.
int RamRing::bin_of(std::uint32_t pages) {
    if (pages < 8) return static_cast<int>(pages);
    const int octave = std::bit_width(pages) - 4;
    return octave * 8 + static_cast<int>(pages >> octave);
}

int RamRing::first_bin_from(int bin) const {
    for (int word = bin / 64; word < kBinWords; ++word) {
        std::uint64_t bits = occupied_[static_cast<std::size_t>(word)];
        if (word == bin / 64) bits &= ~std::uint64_t{0} << (bin % 64);
        if (bits) return word * 64 + std::countr_zero(bits);
    }
    return kBins;
}

std::uint32_t RamRing::find_in_bin(int bin, std::uint32_t pages, int most_steps) const {
    std::uint32_t run = heads_[static_cast<std::size_t>(bin)];
    for (int step = 0; run != kNone && step < most_steps; ++step, run = pages_[run].next)
        if (pages_[run].run >> 1 >= pages) return run;
    return kNone;
}

std::uint32_t RamRing::find(std::uint32_t pages) const {
    const int bin = bin_of(pages);
    const int larger = first_bin_from(bin + 1);
    const int steps = larger < kBins ? kCloseFitSteps : static_cast<int>(page_count_);
    const std::uint32_t close = find_in_bin(bin, pages, steps);
    if (close != kNone || larger == kBins) return close;
    return heads_[static_cast<std::size_t>(larger)];
}

RamBlock RamRing::allocate(std::size_t bytes) {
    RIDGELINE_CHECK(bytes > 0);
    if (bytes > capacity_bytes() - used_bytes()) return {};
    const std::uint32_t pages = pages_for(bytes);
    const std::uint32_t first = find(pages);
    if (first == kNone) return {};
    const std::uint32_t rest = (pages_[first].run >> 1) - pages;
    remove_free(first);
    if (rest > 0) insert_free(first + pages, rest);
    mark(first, pages, 0);
    used_pages_ += pages;
    return {first, pages};
}

void RamRing::free(RamBlock block) {
    RIDGELINE_CHECK(block && block.first_page < page_count_ &&
                    pages_[block.first_page].run == block.pages << 1);
    used_pages_ -= block.pages;
    std::uint32_t first = block.first_page;
    std::uint32_t end = first + block.pages;
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

void RamRing::mark(std::uint32_t first, std::uint32_t pages, std::uint32_t free) {
    pages_[first].run = pages_[first + pages - 1].run = pages << 1 | free;
}

void RamRing::insert_free(std::uint32_t first, std::uint32_t pages) {
    const auto bin = static_cast<std::size_t>(bin_of(pages));
    mark(first, pages, 1);
    pages_[first].previous = kNone;
    pages_[first].next = heads_[bin];
    if (heads_[bin] != kNone) pages_[heads_[bin]].previous = first;
    heads_[bin] = first;
    occupied_[bin / 64] |= std::uint64_t{1} << (bin % 64);
}

void RamRing::remove_free(std::uint32_t first) {
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

std::uint32_t RamRing::largest_free_pages() const {
    std::uint32_t largest = 0;
    for (const std::uint32_t head : heads_)
        for (std::uint32_t run = head; run != kNone; run = pages_[run].next)
            largest = std::max(largest, pages_[run].run >> 1);
    return largest;
}

}  // namespace ridgeline::pager
