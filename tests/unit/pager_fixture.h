// A store of random bytes in memory, a decoder that can tell whether they are right, and a renderer that
// draws nothing: what the pager is tried with.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "ridgeline/io/byte_source.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/pager/tile_source.h"

namespace ridgeline::pager::test {

// Bytes in memory as a file; counts reads, and can be made to wait.
class MemorySource final : public io::ByteSource {
  public:
    Result<void> read(std::uint64_t offset, std::span<std::uint8_t> out) override;
    std::uint64_t size() const override { return bytes.size(); }

    std::vector<std::uint8_t> bytes;
    // Called before every read, on the reading thread.
    std::function<void(std::uint64_t offset, std::size_t size)> before_read;
};

// Fills the block with bytes that follow from the node; an error where the payloads are not the node's own.
class PatternDecoder final : public TileDecoder {
  public:
    Result<void> decode(const EncodedTile& tile, DecodeScratch& scratch,
                        std::span<std::byte> block) const override;
    Result<void> decode_imagery(const EncodedImagery& tile, DecodeScratch& scratch,
                                std::span<std::byte> block) const override;
    // The node whose payloads are refused although they are whole.
    io::NodeId refused{-1, 0, 0};
};

// True where the chunk holds what PatternDecoder wrote for the node.
bool intact(const io::ChunkView& chunk, io::NodeId node);
bool intact(std::span<const std::byte> imagery, io::NodeId node);

struct FakeStoreOptions {
    std::int64_t width = 1025, height = 769;  // samples
    int quads = 32;
    std::uint64_t seed = 1;
    // Vertices a chunk has at most; 16 bytes each.
    std::uint32_t max_vertices = 800;
    // Texels; 0: no imagery.
    std::int64_t imagery_width = 0, imagery_height = 0;
};

class FakeStore {
  public:
    explicit FakeStore(const FakeStoreOptions& options = {});
    TileSource source();
    TileSpace tiles() const { return {grid_, imagery_grid_}; }
    const io::Grid& grid() const { return grid_; }
    const io::Grid& imagery_grid() const { return imagery_grid_; }
    NodeIndex index(io::NodeId node) const { return static_cast<NodeIndex>(grid_.linear(node)); }
    io::NodeId id(NodeIndex node) const { return grid_.node_at(node); }
    std::uint64_t tile_bytes();    // of all tiles, in the ring
    std::uint64_t level0_bytes();  // of level 0's
    // Changes one byte of the node's mesh payload.
    void damage(NodeIndex node);

    MemorySource mesh, heights, imagery;
    std::vector<io::NodeRecord> records;
    std::vector<io::ImageryRecord> imagery_records;

  private:
    void make_chunks(const FakeStoreOptions& options, std::mt19937_64& random);
    void make_imagery(std::mt19937_64& random);

    io::Grid grid_;
    io::Grid imagery_grid_;
};

// Nodes around a place, level by level: (2*radius+1)^2 of them where they exist.
std::vector<NodeIndex> nodes_around(const io::Grid& grid, double column, double row, int radius);

// Walks the pager through frames as a renderer would, and checks in each what must always hold.
class FakeRenderer {
  public:
    struct Options {
        std::uint64_t gpu_bytes = std::uint64_t{1} << 30;  // chunks'
        std::uint64_t gpu_imagery_bytes = std::uint64_t{1} << 30;
        std::size_t upload_budget = std::size_t{1} << 20;
        Seconds step{1.0 / 60.0};
    };
    FakeRenderer(Pager& pager, FakeStore& store, const Options& options);

    // One frame that wants these nodes and draws those of them that are resident under resident parents.
    void frame(std::span<const NodeIndex> wanted);
    // Frames with the same wants until the pager says that all is settled; gives up after a minute.
    bool settle(std::span<const NodeIndex> wanted);

    std::uint32_t frame_number() const { return frame_; }
    bool resident(NodeIndex node) const { return pager_.state(node) == TileState::resident; }
    const std::vector<NodeIndex>& used() const { return used_; }

  private:
    std::uint64_t gpu_capacity(TileKind kind) const {
        return kind == TileKind::chunk ? options_.gpu_bytes : options_.gpu_imagery_bytes;
    }
    bool parent_resident(NodeIndex node) const;
    bool make_room(const Upload& upload);
    void upload();
    void release(GpuSlot slot);
    void draw(std::span<const NodeIndex> wanted);
    void check_kept() const;

    Pager& pager_;
    TileSource source_;
    TileSpace tiles_;
    Options options_;
    std::uint32_t frame_ = 0;
    Seconds now_{};
    std::uint64_t gpu_bytes_[kTileKinds] = {};
    std::vector<NodeIndex> node_of_slot_;  // kNoNode: free
    std::vector<std::uint32_t> free_slots_;
    std::vector<NodeIndex> used_;
    std::vector<std::uint32_t> used_stamp_;
};

}  // namespace ridgeline::pager::test
