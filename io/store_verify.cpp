// verify_store: everything a store holds, read once and compared with what is said of it.
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <utility>

#include "ridgeline/io/imagery_tile.h"
#include "ridgeline/io/store.h"

namespace ridgeline::io {
namespace {

Error damage_of(const Store& store, const std::string& file, const std::string& what) {
    const bool of_imagery = file == layer_file(Layer::imagery);
    return Error{(store.directory() / file).string() + ": " + what + ": build the " +
                 (of_imagery ? "imagery" : "terrain") + " again"};
}

// Whether a layer's payloads lie back to back from its first byte to its last.
class LayerTally {
  public:
    void add(const PayloadRef& payload) {
        ++tiles_;
        bytes_ += payload.size;
        joints_ += place_hash(payload.offset + payload.size) - place_hash(payload.offset);
    }

    Result<void> check(const Store& store, Layer layer, std::int64_t tiles, std::int64_t bytes) const {
        const std::uint64_t size = store.layer(layer).size();
        if (bytes_ != size) return damage_of(store, layer_file(layer), "holds bytes that belong to no tile");
        // Where no payload ends at another's beginning, two places' hashes are left over.
        if (joints_ != place_hash(size) - place_hash(0))
            return damage_of(store, layer_file(layer), "its tiles do not lie back to back");
        if (tiles_ != tiles || std::cmp_not_equal(bytes_, bytes))
            return damage_of(store, kInfoFile, std::string("does not fit ") + layer_file(layer));
        return {};
    }

  private:
    static std::uint64_t place_hash(std::uint64_t offset) { return XXH3_64bits(&offset, sizeof offset); }

    std::int64_t tiles_ = 0;
    std::uint64_t bytes_ = 0;
    std::uint64_t joints_ = 0;
};

// The valid samples of the finest level, each counted once.
class SampleTally {
  public:
    void add(const Grid& grid, NodeId node, const HeightsTile& tile) {
        const LatticePoint origin = grid.origin(node);
        // A node owns its western and northern border; the raster's last row and column have no other owner.
        const auto owned = [&](std::int64_t first, std::int64_t samples) {
            const std::int64_t left = samples - first;
            return static_cast<int>(left <= tile.quads + 1 ? left : tile.quads);
        };
        const int columns = owned(origin.x, grid.width()), rows = owned(origin.y, grid.height());
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) add(tile, tile.at(column, row));
    }

    Result<void> check(const Store& store) const {
        const TerrainInfo& info = store.info();
        if (valid_ + info.invalid_samples != info.width * info.height)
            return damage_of(store, kInfoFile, "invalid_samples does not fit heights.tiles");
        if (valid_ > 0 &&
            (info.min_height_m != info.height_m(least_) || info.max_height_m != info.height_m(greatest_)))
            return damage_of(store, kInfoFile, "range_m does not fit heights.tiles");
        return {};
    }

  private:
    void add(const HeightsTile& tile, std::size_t at) {
        if (!tile.all_valid && tile.sample_valid[at] == 0) return;
        ++valid_;
        least_ = std::min(least_, tile.quanta[at]);
        greatest_ = std::max(greatest_, tile.quanta[at]);
    }

    std::int64_t valid_ = 0;
    std::int32_t least_ = INT32_MAX, greatest_ = INT32_MIN;
};

// Decodes node after node, compares each with its record, and at last all of them with terrain.json.
class Verifier {
  public:
    explicit Verifier(const Store& store) : store_(store) {}

    Result<void> check(NodeId node) {
        const NodeRecord& record = store_.record(node);
        if (!record.has_data()) return {};
        RIDGELINE_TRY(store_.read_payload(Layer::heights, node, bytes_));
        if (auto decoded = decode_heights(bytes_, store_.grid().quads(), heights_); !decoded)
            return damaged(Layer::heights, node, decoded.error());
        RIDGELINE_TRY(store_.read_payload(Layer::mesh, node, bytes_));
        if (auto decoded = check_mesh(node, record); !decoded)
            return damaged(Layer::mesh, node, decoded.error());
        heights_tally_.add(record.heights);
        mesh_tally_.add(record.mesh);
        triangles_ += record.triangle_count;
        if (node.level == store_.grid().finest()) samples_.add(store_.grid(), node, heights_);
        return {};
    }

    Result<void> check_sums() const {
        const TerrainInfo& info = store_.info();
        RIDGELINE_TRY(heights_tally_.check(store_, Layer::heights, info.heights_tiles, info.heights_bytes));
        RIDGELINE_TRY(mesh_tally_.check(store_, Layer::mesh, info.mesh_tiles, info.mesh_bytes));
        if (triangles_ != info.triangles)
            return damage_of(store_, kInfoFile, "triangles does not fit nodes.bin");
        return samples_.check(store_);
    }

  private:
    Error damaged(Layer layer, NodeId node, const Error& why) const {
        return damage_of(store_, layer_file(layer), describe(node) + ": " + why.message);
    }

    Result<void> check_mesh(NodeId node, const NodeRecord& record) {
        const std::size_t needed = chunk_layout(record, store_.chunk_shape()).total;
        if (block_.size() * sizeof(ChunkVertex) < needed) block_.resize(needed / sizeof(ChunkVertex) + 1);
        const ChunkView chunk(std::as_writable_bytes(std::span(block_)), record, store_.chunk_shape());
        RIDGELINE_TRY(decode_chunk(store_.grid(), node, record, store_.chunk_spacing(), bytes_, heights_,
                                   scratch_, chunk));
        return check_bounds(record, chunk);
    }

    Result<void> check_bounds(const NodeRecord& record, const ChunkView& chunk) const {
        const auto bounded = [&](std::int64_t quanta) {
            return quanta >= record.min_quanta && quanta <= record.max_quanta;
        };
        for (const ChunkVertex& vertex : chunk.vertices())
            if (!bounded(vertex.quanta) || !bounded(std::int64_t{vertex.quanta} + vertex.delta))
                return Error{"its mesh exceeds its stated bounds"};
        return {};
    }

    const Store& store_;
    std::vector<std::uint8_t> bytes_;
    std::vector<ChunkVertex> block_;  // ChunkVertex for its alignment
    HeightsTile heights_;
    ChunkScratch scratch_;
    LayerTally heights_tally_, mesh_tally_;
    SampleTally samples_;
    std::int64_t triangles_ = 0;
};

// The same for the imagery's quadtree.
class ImageryVerifier {
  public:
    explicit ImageryVerifier(const Store& store) : store_(store), block_(kImageryBlockCount) {}

    Result<void> check(NodeId node) {
        const ImageryRecord& record = store_.imagery_record(node);
        if (!record.has_data()) return {};
        RIDGELINE_TRY(store_.read_payload(Layer::imagery, node, bytes_));
        if (auto decoded = decode_imagery(bytes_, scratch_, std::as_writable_bytes(std::span(block_)));
            !decoded)
            return damaged(node, decoded.error().message);
        if (std::any_of(block_.begin(), block_.end(), has_holes) != record.has_holes())
            return damaged(node, "its texels without imagery do not fit its record");
        tally_.add(record.payload());
        return {};
    }

    Result<void> check_sums() const {
        const ImageryInfo& info = *store_.info().imagery;
        return tally_.check(store_, Layer::imagery, info.tiles, info.bytes);
    }

  private:
    Error damaged(NodeId node, const std::string& why) const {
        return damage_of(store_, layer_file(Layer::imagery), describe(node) + ": " + why);
    }

    const Store& store_;
    std::vector<std::uint8_t> bytes_;
    std::vector<Bc1Block> block_;
    ImageryScratch scratch_;
    LayerTally tally_;
};

}  // namespace

Result<void> verify_store(const Store& store,
                          const std::function<void(std::int64_t, std::int64_t)>& progress) {
    const bool with_imagery = store.info().imagery.has_value();
    const std::int64_t nodes = store.grid().node_count();
    const std::int64_t imagery_nodes = with_imagery ? store.imagery_grid().node_count() : 0;
    Verifier verifier(store);
    for (std::int64_t i = 0; i < nodes; ++i) {
        RIDGELINE_TRY(verifier.check(store.grid().node_at(i)));
        progress(i + 1, nodes + imagery_nodes);
    }
    RIDGELINE_TRY(verifier.check_sums());
    if (!with_imagery) return {};
    ImageryVerifier imagery(store);
    for (std::int64_t i = 0; i < imagery_nodes; ++i) {
        RIDGELINE_TRY(imagery.check(store.imagery_grid().node_at(i)));
        progress(nodes + i + 1, nodes + imagery_nodes);
    }
    return imagery.check_sums();
}

}  // namespace ridgeline::io
