// The name of a quadtree node: level 0 is coarsest; x counts eastwards, y southwards (as raster rows do).
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

namespace ridgeline::io {

struct NodeId {
    std::int32_t level = 0;
    std::int32_t x = 0;
    std::int32_t y = 0;

    friend constexpr auto operator<=>(const NodeId&, const NodeId&) = default;

    constexpr NodeId parent() const { return {level - 1, x >> 1, y >> 1}; }
    // quarter = qx + 2*qy: 0 north-west, 1 north-east, 2 south-west, 3 south-east.
    constexpr NodeId child(int quarter) const {
        return {level + 1, 2 * x + (quarter & 1), 2 * y + (quarter >> 1)};
    }
    // Which quarter of its parent this node is.
    constexpr int quarter() const { return (x & 1) + 2 * (y & 1); }
};

// The sides of a node or of a quarter, in the order used by every table of sides.
enum class Side : std::uint8_t { west, east, north, south };
constexpr int kSides = 4;
constexpr int kQuarters = 4;

constexpr int index(Side side) { return static_cast<int>(side); }
constexpr Side opposite(Side side) { return static_cast<Side>(index(side) ^ 1); }

constexpr NodeId neighbour(NodeId node, Side side) {
    constexpr int kDx[kSides] = {-1, 1, 0, 0};
    constexpr int kDy[kSides] = {0, 0, -1, 1};
    return {node.level, node.x + kDx[index(side)], node.y + kDy[index(side)]};
}

struct NodeIdHash {
    // A 64-bit finaliser (Stafford's variant 13 of MurmurHash3's), enough to spread packed coordinates.
    std::size_t operator()(const NodeId& id) const {
        std::uint64_t k = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(id.level)) << 58) ^
                          (static_cast<std::uint64_t>(static_cast<std::uint32_t>(id.y)) << 29) ^
                          static_cast<std::uint64_t>(static_cast<std::uint32_t>(id.x));
        k = (k ^ (k >> 30)) * 0xbf58476d1ce4e5b9ULL;
        k = (k ^ (k >> 27)) * 0x94d049bb133111ebULL;
        return static_cast<std::size_t>(k ^ (k >> 31));
    }
};

}  // namespace ridgeline::io
