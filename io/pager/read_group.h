// Which requests are read together: a disk pays per read, so tiles whose payloads are neighbours in all their
// files, small gaps included, come in by one read of each.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>

#include "ridgeline/pager/tile_source.h"

namespace ridgeline::pager {

struct ReadLimits {
    // A read's bytes, unless a single payload needs more: a few milliseconds of a disk, so that something
    // more urgent need not wait long behind it.
    std::uint64_t max_read_bytes = 256 << 10;
    // Bytes read in vain between two payloads: what a disk transfers in the time it takes to begin another
    // read.
    std::uint64_t max_gap_bytes = 32 << 10;
    // Tiles read together: they are decoded before the next read is chosen.
    std::size_t max_members = 32;
};

// A range of bytes of one file; empty where begin equals end.
struct ByteRange {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;

    static ByteRange of(const io::PayloadRef& payload) {
        return {payload.offset, payload.offset + payload.size};
    }
    std::uint64_t bytes() const { return end - begin; }
    bool empty() const { return begin == end; }
    // The smallest range that holds both.
    ByteRange joined(const ByteRange& other) const {
        if (empty()) return other;
        if (other.empty()) return *this;
        return {std::min(begin, other.begin), std::max(end, other.end)};
    }
    // Bytes between both, 0 where they touch or overlap.
    std::uint64_t gap(const ByteRange& other) const {
        if (empty() || other.empty()) return 0;
        if (other.begin > end) return other.begin - end;
        return begin > other.end ? begin - other.end : 0;
    }
};

// What one group reads of its files, which are those of TilePayloads: all tiles of a group are of one kind.
struct ReadRanges {
    ByteRange first;
    ByteRange second;

    static ReadRanges of(const TilePayloads& payloads) {
        return {ByteRange::of(payloads.first), ByteRange::of(payloads.second)};
    }
    ReadRanges joined(const ReadRanges& other) const {
        return {first.joined(other.first), second.joined(other.second)};
    }
    std::uint64_t gap(const ReadRanges& other) const {
        return std::max(first.gap(other.first), second.gap(other.second));
    }
};

struct ReadCandidate {
    std::uint32_t index = 0;  // the caller's, in order of urgency
    ReadRanges ranges;
};

// Reorders the candidates and returns those that are read together with the one that was first: a run in the
// order of the file, most urgent first. `candidates` must not be empty.
std::span<ReadCandidate> choose_group(std::span<ReadCandidate> candidates, const ReadLimits& limits);

}  // namespace ridgeline::pager
