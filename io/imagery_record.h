// imagery.bin: one fixed-size record per node of the imagery's quadtree, in linear order. Little-endian,
// mapped as it stands. docs/store.md has the byte layout.
#pragma once

#include <cstdint>
#include <type_traits>

#include "ridgeline/io/node_record.h"

namespace ridgeline::io {

// The file's name, beside the layer's payloads.
constexpr const char* kImageryTable = "imagery.bin";

struct ImageryRecord {
    // Some texel of the node has imagery. A node without has no payload, and neither have its children.
    static constexpr std::uint32_t kHasData = 1u << 0;
    // Some texel of its tile, gutter included, has none.
    static constexpr std::uint32_t kHasHoles = 1u << 1;

    std::uint64_t offset = 0;    // in imagery.tiles
    std::uint64_t checksum = 0;  // XXH3-64 of the payload's bytes
    std::uint32_t size = 0;      // bytes; 0 where there is no payload
    std::uint32_t flags = 0;

    bool has_data() const { return (flags & kHasData) != 0; }
    bool has_holes() const { return (flags & kHasHoles) != 0; }
    PayloadRef payload() const { return {offset, checksum, size, 0}; }
};
static_assert(sizeof(ImageryRecord) == 24 && std::is_trivially_copyable_v<ImageryRecord>);

// imagery.bin opens with this.
struct ImageryHeader {
    char magic[8] = {'R', 'L', 'I', 'M', 'A', 'G', 'E', '1'};
    std::uint32_t record_bytes = sizeof(ImageryRecord);
    std::uint32_t reserved = 0;
    std::uint64_t record_count = 0;
    std::uint64_t checksum = 0;  // XXH3-64 of all records' bytes
};
static_assert(sizeof(ImageryHeader) == 32);

}  // namespace ridgeline::io
