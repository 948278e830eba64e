// One node's fixed-size record in nodes.bin: bounds, errors, and where its payloads lie. Little-endian,
// mapped as it stands. docs/store.md has the byte layout.
#pragma once

#include <cstdint>
#include <type_traits>

namespace ridgeline::io {

// Where one payload lies in its layer's file. size 0: the node has none.
struct PayloadRef {
    std::uint64_t offset = 0;
    std::uint64_t checksum = 0;  // XXH3-64 of the payload's bytes
    std::uint32_t size = 0;      // bytes
    std::uint32_t reserved = 0;
};

struct NodeRecord {
    // Some sample of the node is valid. A node without has no payloads and is never drawn.
    static constexpr std::uint32_t kHasData = 1u << 0;
    // Some cell of the node is invalid: its chunk carries a mask.
    static constexpr std::uint32_t kHasMask = 1u << 1;

    PayloadRef heights;
    PayloadRef mesh;
    // True maximum vertical error of the node's mesh over all source samples, never less than its children's;
    // metres.
    float error_m = 0.0f;
    // Heights, in quanta, that bound the node's samples and its mesh in every morph state.
    std::int32_t min_quanta = 0;
    std::int32_t max_quanta = 0;
    std::uint32_t flags = 0;
    // Sizes of the decoded chunk (chunk.h): vertices with fan vertices; indices of every range together.
    std::uint32_t vertex_count = 0;
    std::uint32_t index_count = 0;
    // Triangles of the whole node drawn plain.
    std::uint32_t triangle_count = 0;
    std::uint32_t reserved = 0;

    bool has_data() const { return (flags & kHasData) != 0; }
    bool has_mask() const { return (flags & kHasMask) != 0; }
};

static_assert(sizeof(PayloadRef) == 24 && sizeof(NodeRecord) == 80);
static_assert(std::is_trivially_copyable_v<NodeRecord>);

}  // namespace ridgeline::io
