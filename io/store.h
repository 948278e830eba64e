// A terrain store that stands on disk, opened for reading: terrain.json, the mapped node records, the layers'
// files; of imagery, where there is any, likewise: it has a quadtree and a table of its own.
//
// Opening checks every record once (offsets inside their files, errors that do not grow downwards); payloads
// are checked by checksum whenever they are read. Immutable after open, so any thread may read; each read is
// one positioned read.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ridgeline/io/byte_source.h"
#include "ridgeline/io/chunk_codec.h"
#include "ridgeline/io/grid.h"
#include "ridgeline/io/heights_tile.h"
#include "ridgeline/io/imagery_record.h"
#include "ridgeline/io/node_record.h"
#include "ridgeline/io/terrain_info.h"

namespace ridgeline::io {

enum class Layer { heights, mesh, imagery };
const char* layer_file(Layer layer);  // "heights.tiles", "mesh.tiles", "imagery.tiles"

// The file of the node records.
constexpr const char* kNodesFile = "nodes.bin";

// It opens with this, then one NodeRecord per node in linear order.
struct NodesHeader {
    char magic[8] = {'R', 'L', 'N', 'O', 'D', 'E', 'S', '1'};
    std::uint32_t record_bytes = sizeof(NodeRecord);
    std::uint32_t reserved = 0;
    std::uint64_t record_count = 0;
    std::uint64_t checksum = 0;  // XXH3-64 of all records' bytes
};
static_assert(sizeof(NodesHeader) == 32);

class Store {
  public:
    static Result<Store> open(const std::filesystem::path& directory);
    // As if it had no imagery, which may be damaged.
    static Result<Store> open_terrain(const std::filesystem::path& directory);
    // What open() checks, but for the imagery, which may be damaged.
    static Result<void> check_terrain(const std::filesystem::path& directory);
    Store(Store&&) noexcept;
    Store& operator=(Store&&) noexcept;
    ~Store();

    const TerrainInfo& info() const;
    const Grid& grid() const;
    const std::filesystem::path& directory() const;
    std::span<const NodeRecord> records() const;
    const NodeRecord& record(NodeId node) const {
        return records()[static_cast<std::size_t>(grid().linear(node))];
    }
    // Whoever has looked at all records gives their memory back: what a walk holds must not grow with the data.
    void forget_records() const;

    // Of the imagery's quadtree; without imagery an empty grid and no records.
    const Grid& imagery_grid() const;
    std::span<const ImageryRecord> imagery_records() const;
    const ImageryRecord& imagery_record(NodeId node) const {
        return imagery_records()[static_cast<std::size_t>(imagery_grid().linear(node))];
    }
    ChunkSpacing chunk_spacing() const;
    ChunkShape chunk_shape() const;

    // Layer::imagery only where info().imagery.
    ByteSource& layer(Layer layer) const;
    // Reads and checks one payload; `bytes` is resized to it. Nodes of Layer::imagery are the imagery's.
    Result<void> read_payload(Layer layer, NodeId node, std::vector<std::uint8_t>& bytes) const;
    Result<void> read_heights(NodeId node, std::vector<std::uint8_t>& bytes, HeightsTile& tile) const;

  private:
    struct State;
    explicit Store(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

std::uint64_t payload_checksum(std::span<const std::uint8_t> bytes);
// "node 3/1/2", for messages.
std::string describe(NodeId node);

// Reads and decodes everything and compares it with the records (checksums, codecs, counts, bounds), and what
// all of it sums up to with terrain.json; every byte of the layers must be some tile's. The error names the
// first damage found. `progress` gets (done, total) nodes.
Result<void> verify_store(const Store& store,
                          const std::function<void(std::int64_t, std::int64_t)>& progress);

}  // namespace ridgeline::io
