#include "ridgeline/io/store.h"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

#include "ridgeline/io/mapped_file.h"

namespace ridgeline::io {
namespace {

constexpr const char* kInfoFile = "terrain.json";
constexpr std::array kLayers = {Layer::heights, Layer::mesh};

// Larger payloads than any tile or chunk can need are damage, not data.
constexpr std::uint32_t kMaxPayloadBytes = 16u << 20;

std::string describe(NodeId node) {
    return "node " + std::to_string(node.level) + "/" + std::to_string(node.x) + "/" + std::to_string(node.y);
}

Result<std::string> read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return Error{path.string() + ": not found or not readable: is this a Ridgeline terrain?"};
    return std::string(std::istreambuf_iterator<char>(file), {});
}

Result<std::span<const NodeRecord>> check_table(const MappedFile& file, const Grid& grid) {
    NodesHeader header;
    const NodesHeader expected;
    if (file.bytes().size() < sizeof header) return Error{"cut off"};
    std::memcpy(&header, file.bytes().data(), sizeof header);
    if (std::memcmp(header.magic, expected.magic, sizeof header.magic) != 0) return Error{"not a node table"};
    const auto count = static_cast<std::uint64_t>(grid.node_count());
    if (header.reserved != 0) return Error{"its header is damaged"};
    if (header.record_bytes != sizeof(NodeRecord) || header.record_count != count)
        return Error{"does not fit terrain.json"};
    const auto records = file.bytes().subspan(sizeof header);
    if (records.size() != count * sizeof(NodeRecord)) return Error{"cut off or too long"};
    if (XXH3_64bits(records.data(), records.size()) != header.checksum)
        return Error{"checksum does not match"};
    return std::span(reinterpret_cast<const NodeRecord*>(records.data()), count);
}

bool inside(const PayloadRef& payload, std::uint64_t file_size) {
    return payload.size > 0 && payload.size <= kMaxPayloadBytes && payload.offset <= file_size &&
           payload.size <= file_size - payload.offset;
}

bool plausible(const NodeRecord& record) {
    return std::isfinite(record.error_m) && record.error_m >= 0.0f &&
           record.min_quanta <= record.max_quanta && record.vertex_count > 0 &&
           record.vertex_count <= kMaxChunkVertices && record.index_count % 3 == 0 &&
           record.index_count <= 16 * kMaxChunkVertices;
}

}  // namespace

struct Store::State {
    std::filesystem::path directory;
    TerrainInfo info;
    Grid grid;
    MappedFile nodes;
    std::span<const NodeRecord> records;
    std::array<std::unique_ptr<ByteSource>, kLayers.size()> layers;

    ByteSource& layer(Layer which) const { return *layers[static_cast<std::size_t>(which)]; }
    Result<void> check_records() const;
    Result<void> check_record(NodeId node, const NodeRecord& record) const;
};

const char* layer_file(Layer layer) { return layer == Layer::heights ? "heights.tiles" : "mesh.tiles"; }

std::uint64_t payload_checksum(std::span<const std::uint8_t> bytes) {
    return XXH3_64bits(bytes.data(), bytes.size());
}

Result<void> Store::State::check_record(NodeId node, const NodeRecord& record) const {
    if (!record.has_data())
        return node.level > 0 ? Result<void>() : Result<void>(Error{"a root node without data"});
    if (!plausible(record)) return Error{"impossible values"};
    if (!inside(record.heights, layer(Layer::heights).size()))
        return Error{"its heights tile lies outside heights.tiles"};
    if (!inside(record.mesh, layer(Layer::mesh).size()))
        return Error{"its mesh tile lies outside mesh.tiles"};
    if (node.level == 0) return {};
    const NodeRecord& parent = records[static_cast<std::size_t>(grid.linear(node.parent()))];
    if (!parent.has_data() || parent.error_m < record.error_m) return Error{"its parent does not fit it"};
    return {};
}

Result<void> Store::State::check_records() const {
    for (std::int64_t i = 0; i < grid.node_count(); ++i) {
        const NodeId node = grid.node_at(i);
        if (const auto checked = check_record(node, records[static_cast<std::size_t>(i)]); !checked)
            return Error{describe(node) + ": " + checked.error().message};
    }
    return {};
}

Store::Store(std::unique_ptr<State> state) : state_(std::move(state)) {}
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;
Store::~Store() = default;

Result<Store> Store::open(const std::filesystem::path& directory) {
    auto state = std::make_unique<State>();
    state->directory = directory;
    const auto text = read_text(directory / kInfoFile);
    if (!text) return text.error();
    auto info = terrain_info_from_json(*text);
    if (!info) return Error{(directory / kInfoFile).string() + ": " + info.error().message};
    state->info = std::move(*info);
    state->grid = state->info.grid();
    for (const Layer layer : kLayers) {
        auto file = open_file(directory / layer_file(layer));
        if (!file) return file.error();
        state->layers[static_cast<std::size_t>(layer)] = std::move(*file);
    }
    auto nodes = MappedFile::open(directory / "nodes.bin");
    if (!nodes) return nodes.error();
    state->nodes = std::move(*nodes);
    const auto table = check_table(state->nodes, state->grid);
    const auto damaged = [&](const Error& error) {
        return Error{(directory / "nodes.bin").string() + ": " + error.message + ": build the terrain again"};
    };
    if (!table) return damaged(table.error());
    state->records = *table;
    if (const auto checked = state->check_records(); !checked) return damaged(checked.error());
    return Store(std::move(state));
}

const TerrainInfo& Store::info() const { return state_->info; }
const Grid& Store::grid() const { return state_->grid; }
const std::filesystem::path& Store::directory() const { return state_->directory; }
std::span<const NodeRecord> Store::records() const { return state_->records; }
ByteSource& Store::layer(Layer layer) const { return state_->layer(layer); }

ChunkSpacing Store::chunk_spacing() const {
    return {state_->info.spacing_x_m, state_->info.spacing_y_m, state_->info.quantum_m};
}

ChunkShape Store::chunk_shape() const { return {grid().quads(), state_->info.relief}; }

Result<void> Store::read_payload(Layer layer, NodeId node, std::vector<std::uint8_t>& bytes) const {
    const PayloadRef& payload = layer == Layer::heights ? record(node).heights : record(node).mesh;
    bytes.resize(payload.size);
    RIDGELINE_TRY(state_->layer(layer).read(payload.offset, bytes));
    if (payload_checksum(bytes) != payload.checksum)
        return Error{(state_->directory / layer_file(layer)).string() + ": " + describe(node) +
                     ": checksum does not match: the file is damaged, build the terrain again"};
    return {};
}

Result<void> Store::read_heights(NodeId node, std::vector<std::uint8_t>& bytes, HeightsTile& tile) const {
    RIDGELINE_TRY(read_payload(Layer::heights, node, bytes));
    return decode_heights(bytes, grid().quads(), tile);
}

namespace {

Error damage_of(const Store& store, const std::string& file, const std::string& what) {
    return Error{(store.directory() / file).string() + ": " + what + ": build the terrain again"};
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

}  // namespace

Result<void> verify_store(const Store& store,
                          const std::function<void(std::int64_t, std::int64_t)>& progress) {
    Verifier verifier(store);
    const std::int64_t count = store.grid().node_count();
    for (std::int64_t i = 0; i < count; ++i) {
        RIDGELINE_TRY(verifier.check(store.grid().node_at(i)));
        progress(i + 1, count);
    }
    return verifier.check_sums();
}

}  // namespace ridgeline::io
