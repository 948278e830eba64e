#include "ridgeline/io/store.h"

#include <xxhash.h>

#include <array>
#include <cmath>
#include <system_error>
#include <utility>

#include "ridgeline/io/mapped_file.h"
#include "ridgeline/io/record_table.h"

namespace ridgeline::io {
namespace {

constexpr std::array kLayers = {Layer::heights, Layer::mesh, Layer::imagery};

// Larger payloads than any tile or chunk can need are damage, not data.
constexpr std::uint32_t kMaxPayloadBytes = 16u << 20;

const char* what_to_build(Layer layer) { return layer == Layer::imagery ? "imagery" : "terrain"; }

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

// What is not there, or has nothing in it, must be built; what is there and cannot be opened is the system's
// to explain.
Error not_opened(const std::filesystem::path& file, const Error& error, Layer layer) {
    std::error_code ignored;
    const auto status = std::filesystem::status(file, ignored);
    const bool whole =
        std::filesystem::is_regular_file(status) && std::filesystem::file_size(file, ignored) > 0;
    if (whole || status.type() == std::filesystem::file_type::none) return error;
    return Error{error.message + ": build the " + what_to_build(layer) + " again"};
}

}  // namespace

struct Store::State {
    std::filesystem::path directory;
    TerrainInfo info;
    Grid grid;
    MappedFile nodes;
    std::span<const NodeRecord> records;
    Grid imagery_grid;
    MappedFile imagery_nodes;
    std::span<const ImageryRecord> imagery_records;
    std::array<std::unique_ptr<ByteSource>, kLayers.size()> layers;

    ByteSource& layer(Layer which) const {
        const auto& source = layers[static_cast<std::size_t>(which)];
        RIDGELINE_CHECK(source != nullptr);
        return *source;
    }
    Result<void> open_terrain();
    Result<void> open_layer(Layer which);
    Result<void> open_nodes();
    Result<void> open_imagery();
    Result<void> check_records() const;
    Result<void> check_record(NodeId node, const NodeRecord& record) const;
    Result<void> check_imagery_records() const;
    Result<void> check_imagery_record(NodeId node, const ImageryRecord& record) const;
    PayloadRef payload(Layer which, NodeId node) const;
};

const char* layer_file(Layer layer) {
    constexpr std::array kFiles = {"heights.tiles", "mesh.tiles", "imagery.tiles"};
    return kFiles[static_cast<std::size_t>(layer)];
}

std::uint64_t payload_checksum(std::span<const std::uint8_t> bytes) {
    return XXH3_64bits(bytes.data(), bytes.size());
}

std::string describe(NodeId node) {
    return "node " + std::to_string(node.level) + "/" + std::to_string(node.x) + "/" + std::to_string(node.y);
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

Result<void> Store::State::check_imagery_record(NodeId node, const ImageryRecord& record) const {
    if ((record.flags & ~(ImageryRecord::kHasData | ImageryRecord::kHasHoles)) != 0)
        return Error{"impossible values"};
    if (!record.has_data())
        return record.size == 0 && !record.has_holes() ? Result<void>()
                                                       : Result<void>(Error{"impossible values"});
    if (!inside(record.payload(), layer(Layer::imagery).size()))
        return Error{"its tile lies outside imagery.tiles"};
    if (node.level == 0) return {};
    const auto parent = static_cast<std::size_t>(imagery_grid.linear(node.parent()));
    return imagery_records[parent].has_data() ? Result<void>()
                                              : Result<void>(Error{"its parent does not fit it"});
}

Result<void> Store::State::check_imagery_records() const {
    for (std::int64_t i = 0; i < imagery_grid.node_count(); ++i) {
        const NodeId node = imagery_grid.node_at(i);
        const ImageryRecord& record = imagery_records[static_cast<std::size_t>(i)];
        if (const auto checked = check_imagery_record(node, record); !checked)
            return Error{describe(node) + ": " + checked.error().message};
    }
    return {};
}

Result<void> Store::State::open_layer(Layer which) {
    const std::filesystem::path path = directory / layer_file(which);
    auto file = open_file(path);
    if (!file) return not_opened(path, file.error(), which);
    layers[static_cast<std::size_t>(which)] = std::move(*file);
    return {};
}

Result<void> Store::State::open_nodes() {
    auto file = MappedFile::open(directory / kNodesFile);
    if (!file) return not_opened(directory / kNodesFile, file.error(), Layer::heights);
    nodes = std::move(*file);
    const auto table = checked_records<NodeRecord, NodesHeader>(
        nodes.bytes(), static_cast<std::uint64_t>(grid.node_count()));
    const auto damaged = [&](const Error& error) {
        return Error{(directory / kNodesFile).string() + ": " + error.message + ": build the terrain again"};
    };
    if (!table) return damaged(table.error());
    records = *table;
    if (const auto checked = check_records(); !checked) return damaged(checked.error());
    return {};
}

Result<void> Store::State::open_imagery() {
    RIDGELINE_TRY(open_layer(Layer::imagery));
    auto file = MappedFile::open(directory / kImageryTable);
    if (!file) return not_opened(directory / kImageryTable, file.error(), Layer::imagery);
    imagery_nodes = std::move(*file);
    imagery_grid = info.imagery->grid();
    const auto table = checked_records<ImageryRecord, ImageryHeader>(
        imagery_nodes.bytes(), static_cast<std::uint64_t>(imagery_grid.node_count()));
    const auto damaged = [&](const Error& error) {
        return Error{(directory / kImageryTable).string() + ": " + error.message +
                     ": build the imagery again"};
    };
    if (!table) return damaged(table.error());
    imagery_records = *table;
    if (const auto checked = check_imagery_records(); !checked) return damaged(checked.error());
    return {};
}

PayloadRef Store::State::payload(Layer which, NodeId node) const {
    if (which == Layer::imagery)
        return imagery_records[static_cast<std::size_t>(imagery_grid.linear(node))].payload();
    const NodeRecord& record = records[static_cast<std::size_t>(grid.linear(node))];
    return which == Layer::heights ? record.heights : record.mesh;
}

Store::Store(std::unique_ptr<State> state) : state_(std::move(state)) {}
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;
Store::~Store() = default;

Result<void> Store::State::open_terrain() {
    auto read = read_terrain_info(directory);
    if (!read) return read.error();
    info = std::move(*read);
    grid = info.grid();
    RIDGELINE_TRY(open_layer(Layer::heights));
    RIDGELINE_TRY(open_layer(Layer::mesh));
    return open_nodes();
}

Result<Store> Store::open(const std::filesystem::path& directory) {
    auto state = std::make_unique<State>();
    state->directory = directory;
    RIDGELINE_TRY(state->open_terrain());
    if (state->info.imagery) RIDGELINE_TRY(state->open_imagery());
    return Store(std::move(state));
}

Result<Store> Store::open_terrain(const std::filesystem::path& directory) {
    auto state = std::make_unique<State>();
    state->directory = directory;
    RIDGELINE_TRY(state->open_terrain());
    state->info.imagery.reset();
    return Store(std::move(state));
}

Result<void> Store::check_terrain(const std::filesystem::path& directory) {
    State state;
    state.directory = directory;
    return state.open_terrain();
}

const TerrainInfo& Store::info() const { return state_->info; }
const Grid& Store::grid() const { return state_->grid; }
const std::filesystem::path& Store::directory() const { return state_->directory; }
std::span<const NodeRecord> Store::records() const { return state_->records; }
void Store::forget_records() const {
    state_->nodes.forget_pages();
    state_->imagery_nodes.forget_pages();
}
const Grid& Store::imagery_grid() const { return state_->imagery_grid; }
std::span<const ImageryRecord> Store::imagery_records() const { return state_->imagery_records; }
ByteSource& Store::layer(Layer layer) const { return state_->layer(layer); }

ChunkSpacing Store::chunk_spacing() const {
    return {state_->info.spacing_x_m, state_->info.spacing_y_m, state_->info.quantum_m};
}

ChunkShape Store::chunk_shape() const { return {grid().quads(), state_->info.relief}; }

Result<void> Store::read_payload(Layer layer, NodeId node, std::vector<std::uint8_t>& bytes) const {
    const PayloadRef payload = state_->payload(layer, node);
    bytes.resize(payload.size);
    RIDGELINE_TRY(state_->layer(layer).read(payload.offset, bytes));
    if (payload_checksum(bytes) != payload.checksum)
        return Error{(state_->directory / layer_file(layer)).string() + ": " + describe(node) +
                     ": checksum does not match: the file is damaged, build the " + what_to_build(layer) +
                     " again"};
    return {};
}

Result<void> Store::read_heights(NodeId node, std::vector<std::uint8_t>& bytes, HeightsTile& tile) const {
    RIDGELINE_TRY(read_payload(Layer::heights, node, bytes));
    return decode_heights(bytes, grid().quads(), tile);
}

}  // namespace ridgeline::io
