#include "ridgeline/render/quadtree_blocks.h"

#include <algorithm>
#include <bit>

#include "ridgeline/base/contract.h"
#include "ridgeline/shaders/lib/quadtree.h"

namespace ridgeline::render {
namespace {

std::uint32_t packed(io::NodeId node) {
    return static_cast<std::uint32_t>(node.x) | static_cast<std::uint32_t>(node.y) << 16;
}

// Of QuadtreeBlock::slot_and_quarters: chunks draw the ground.
constexpr std::uint32_t kByChunks = 32;

// More than half of the places stay empty.
int bits_for(std::size_t blocks) { return std::countr_zero(std::bit_ceil(2 * blocks + 1)); }

}  // namespace

QuadtreeBlocks::QuadtreeBlocks(const io::Grid& grid, std::size_t most)
    : grid_(grid),
      capacity_(std::min(static_cast<std::size_t>(grid.node_count()), kBlocksPerTile * most)),
      limit_(capacity_),
      place_bits_(bits_for(capacity_)) {
    RIDGELINE_CHECK(grid.nodes_x(grid.finest()) <= 0xffff && grid.nodes_y(grid.finest()) <= 0xffff);
    // A cell has half a word for its block's (QuadtreeInstance::lod).
    RIDGELINE_CHECK(capacity_ < 0xffff);
    built_.reserve(most);
    blocks_.reserve(capacity_);
    seams_.reserve(capacity_);
    table_.resize(std::size_t{1} << place_bits_);
    places_ = table_;
    for (int level = 0; level < grid.levels(); ++level) {
        const auto nodes = static_cast<std::size_t>(grid.first(level + 1) - grid.first(level));
        nodes_[static_cast<std::size_t>(level)].reserve(std::min(nodes, capacity_));
    }
}

// Where a node is, or the empty place where it would be.
std::size_t QuadtreeBlocks::find(io::NodeId node) const {
    const std::size_t mask = places_.size() - 1;
    const int coarseness = grid_.finest() - node.level;
    std::size_t place = shaders::place_hash({node.x, node.y}, coarseness) & mask;
    while (places_[place].block_and_coarseness != 0 &&
           (places_[place].node != packed(node) ||
            static_cast<int>(places_[place].block_and_coarseness & 31u) != coarseness))
        place = (place + 1) & mask;
    return place;
}

bool QuadtreeBlocks::add(const Node& node) {
    shaders::QuadtreePlace& place = places_[find(node.id)];
    if (place.block_and_coarseness != 0) return true;
    if (count_ == limit_) return false;
    ++count_;
    place = {packed(node.id), 1u << 5 | static_cast<std::uint32_t>(grid_.finest() - node.id.level)};
    nodes_[static_cast<std::size_t>(node.id.level)].push_back(node);
    return true;
}

// Roots without data have nothing below them.
bool QuadtreeBlocks::on_ground(io::NodeId node) const {
    return grid_.contains(node) && has({0, node.x >> node.level, node.y >> node.level});
}

bool QuadtreeBlocks::add_about(io::NodeId parent) {
    for (int i = 0; i < 9; ++i) {
        const io::NodeId beside{parent.level, parent.x + i % 3 - 1, parent.y + i / 3 - 1};
        if (on_ground(beside) && !add({beside})) return false;
    }
    return true;
}

// From fine to coarse: what is added asks for neighbours of its own, a level up.
bool QuadtreeBlocks::gather(std::span<const SlottedTile> tiles) {
    // A few tiles need no large table: it goes to the GPU in every frame.
    limit_ = std::min(capacity_, std::max(kFewBlocks, 2 * kBlocksPerTile * tiles.size()));
    place_bits_ = bits_for(limit_);
    places_ = std::span(table_).first(std::size_t{1} << place_bits_);
    std::ranges::fill(places_, shaders::QuadtreePlace{});
    for (auto& nodes : nodes_) nodes.clear();
    count_ = 0;
    for (const SlottedTile& tile : tiles)
        if (!add({tile.node, tile.slot, true})) return false;
    for (int level = grid_.finest(); level > 0; --level)
        for (const Node& node : nodes_[static_cast<std::size_t>(level)])
            if (!add_about(node.id.parent())) return false;
    return true;
}

std::uint32_t QuadtreeBlocks::own_quarters(io::NodeId node) const {
    const std::int64_t half = grid_.extent(node.level) / 2;
    std::uint32_t quarters = 0;
    for (int q = 0; q < io::kQuarters; ++q) {
        const io::NodeId child = node.child(q);
        const bool exists = child.x * half < grid_.width() - 1 && child.y * half < grid_.height() - 1;
        if (exists && !(node.level < grid_.finest() && has(child))) quarters |= 1u << q;
    }
    return quarters;
}

// The block at a node, or of its nearest ancestor, that has a tile of its own; of numbered blocks.
int QuadtreeBlocks::nearest_tile(io::NodeId node) const {
    const int block = static_cast<int>(places_[find(node)].block_and_coarseness >> 5) - 1;
    const shaders::QuadtreeBlock& found = blocks_[static_cast<std::size_t>(block)];
    return shaders::has_own_tile(found) ? block : found.above;
}

void QuadtreeBlocks::number() {
    blocks_.clear();
    for (int level = 0; level < grid_.levels(); ++level)
        for (const Node& node : nodes_[static_cast<std::size_t>(level)]) {
            const int above = level > 0 ? nearest_tile(node.id.parent()) : -1;
            const std::uint32_t slot =
                node.has_tile ? node.slot : shaders::block_slot(blocks_[static_cast<std::size_t>(above)]);
            const int coarseness = grid_.finest() - level;
            blocks_.push_back({{node.id.x, node.id.y},
                               coarseness,
                               slot << 6 | (node.has_tile ? 16u : 0u) | own_quarters(node.id),
                               above,
                               1.0f,
                               {}});
            places_[find(node.id)].block_and_coarseness =
                static_cast<std::uint32_t>(blocks_.size()) << 5 | static_cast<std::uint32_t>(coarseness);
        }
}

void QuadtreeBlocks::build(std::span<const SlottedTile> tiles) {
    if (std::ranges::equal(tiles, built_)) return;
    built_.assign(tiles.begin(), tiles.end());
    while (!gather(tiles)) tiles = tiles.first(tiles.size() / 2);
    number();
}

io::NodeId QuadtreeBlocks::node_of(const shaders::QuadtreeBlock& block) const {
    return {grid_.finest() - block.coarseness, block.node.x, block.node.y};
}

void QuadtreeBlocks::fade(std::span<const float> fades) {
    for (shaders::QuadtreeBlock& block : blocks_)
        if (shaders::has_own_tile(block))
            block.fade = block.above < 0 ? 0.0f : fades[shaders::block_slot(block)];
}

void QuadtreeBlocks::show_all() {
    for (shaders::QuadtreeBlock& block : blocks_) block.slot_and_quarters &= ~kByChunks;
}

void QuadtreeBlocks::show_only(const MadeRegion& region) {
    for (shaders::QuadtreeBlock& block : blocks_) {
        const io::NodeId node = node_of(block);
        const bool shown = node.level >= region.level() && region.concerns(node);
        block.slot_and_quarters = (block.slot_and_quarters & ~kByChunks) | (shown ? 0 : kByChunks);
    }
}

// Coarse blocks come first.
std::span<const NodeSeams> QuadtreeBlocks::seams(const MadeRegion& region) {
    seams_.clear();
    for (const shaders::QuadtreeBlock& block : blocks_) {
        const io::NodeId id = node_of(block);
        if (id.level > region.level()) break;
        const MadeRegion::Node* node = id.level == region.level() ? region.node(id) : nullptr;
        seams_.push_back(node ? node->seams : NodeSeams{});
    }
    return seams_;
}

}  // namespace ridgeline::render
