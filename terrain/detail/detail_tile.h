// Tiles of heights finer than the source: made from their parent alone, the same whoever makes them and whenever.
//
// A tile has the samples of a heights tile, apron included, in units so fine that eight octaves of bumps can be told
// (detail_shift). Pure functions; any thread.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "ridgeline/io/detail_info.h"
#include "ridgeline/io/heights_tile.h"
#include "ridgeline/io/node_id.h"
#include "ridgeline/io/terrain_info.h"

namespace ridgeline::detail {

// A node in one number, for tables of tiles; below 2^62.
constexpr std::int64_t tile_name(io::NodeId node) {
    return std::int64_t{node.level} << 56 | std::int64_t{node.y} << 28 | std::int64_t{node.x};
}

// How many bits a quantum is divided by: to a 32768th of a spacing, where the terrain's range leaves room for it.
int detail_shift(const io::TerrainInfo& info);

struct DetailTile {
    int quads = 64;
    // Of its level, which counts on from the source's finest; that many octaves finer it is.
    io::NodeId node;
    int octave = 0;
    // As HeightsTile::quanta, in quanta / 2^detail_shift.
    std::vector<std::int32_t> heights;

    // column and row count from the node's corner, from -kApron to quads + kApron.
    std::int32_t height(int column, int row) const {
        constexpr int kApron = io::HeightsTile::kApron;
        const int stride = quads + 1 + 2 * kApron;
        return heights[static_cast<std::size_t>((row + kApron) * stride + column + kApron)];
    }
    // As shaders/lib/detail.h asks for it.
    std::int32_t height(const glm::ivec2& at) const { return height(at.x, at.y); }
};

// The source's own tile in finer units. node: of the finest level.
void make_root(const io::HeightsTile& source, io::NodeId node, int shift, DetailTile& tile);
// A quarter of the parent at twice its rate. quarter: as NodeId::quarter counts. gains: of that octave.
void make_child(const DetailTile& parent, int quarter, const io::DetailGains& gains, DetailTile& tile);

}  // namespace ridgeline::detail
