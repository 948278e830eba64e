#include "ridgeline/io/store_writer.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ridgeline/io/layer_order.h"
#include "ridgeline/io/output_file.h"
#include "ridgeline/io/record_table.h"
#include "ridgeline/io/store_place.h"

namespace ridgeline::io {
namespace {

namespace fs = std::filesystem;

constexpr Layer kLayers[] = {Layer::heights, Layer::mesh};
PayloadRef& payload(NodeRecord& record, Layer layer) {
    return layer == Layer::heights ? record.heights : record.mesh;
}

}  // namespace

struct StoreWriter::State {
    PendingDirectory directory;
    fs::path target;
    Replace replace;
    fs::path scratch;
    std::optional<OutputFile> waiting[std::size(kLayers)];
    Grid grid;
    std::vector<NodeRecord> records;

    NodeRecord& record(NodeId node) { return records[static_cast<std::size_t>(grid.linear(node))]; }
    std::optional<OutputFile>& waiting_in(Layer layer) { return waiting[static_cast<std::size_t>(layer)]; }
    Result<std::uint64_t> order_layer(Layer layer, std::int64_t& done, std::int64_t total,
                                      const Progress& progress);
    Result<void> write_nodes();
    void count(TerrainInfo& info) const;
};

StoreWriter::StoreWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
StoreWriter::StoreWriter(StoreWriter&&) noexcept = default;
StoreWriter& StoreWriter::operator=(StoreWriter&&) noexcept = default;
StoreWriter::~StoreWriter() = default;

Result<StoreWriter> StoreWriter::create(const fs::path& target, Replace replace) {
    const fs::path clean = normalised(target);
    if (clean.empty()) return Error{"the store needs a name"};
    // First, so that what refuses to build has tidied up too.
    PendingDirectory::remove_left(clean);
    RIDGELINE_TRY(check_target(clean, replace));
    auto directory = PendingDirectory::create(clean);
    if (!directory) return directory.error();
    auto state = std::make_unique<State>(State{std::move(*directory), clean, replace, {}, {}, {}, {}});
    state->scratch = state->directory.path() / "scratch";
    std::error_code error;
    if (!fs::create_directory(state->scratch, error))
        return Error{state->scratch.string() + ": " + error.message()};
    for (const Layer layer : kLayers) {
        auto file = OutputFile::create(state->scratch / layer_file(layer));
        if (!file) return file.error();
        state->waiting_in(layer) = std::move(*file);
    }
    return StoreWriter(std::move(state));
}

const fs::path& StoreWriter::directory() const { return state_->directory.path(); }

const fs::path& StoreWriter::scratch() const { return state_->scratch; }

void StoreWriter::begin(const Grid& grid) {
    state_->grid = grid;
    state_->records.assign(static_cast<std::size_t>(grid.node_count()), NodeRecord{});
}

std::span<NodeRecord> StoreWriter::records() { return state_->records; }

Result<void> StoreWriter::put(Layer layer, NodeId node, std::span<const std::uint8_t> bytes) {
    PayloadRef& ref = payload(state_->record(node), layer);
    RIDGELINE_CHECK(ref.size == 0 && !bytes.empty());
    const auto offset = state_->waiting_in(layer)->append(std::as_bytes(bytes));
    if (!offset) return offset.error();
    ref = {*offset, payload_checksum(bytes), static_cast<std::uint32_t>(bytes.size()), 0};
    return {};
}

Result<std::uint64_t> StoreWriter::State::order_layer(Layer layer, std::int64_t& done, std::int64_t total,
                                                      const Progress& progress) {
    LayerCopy copy{grid, *waiting_in(layer),
                   [&](NodeId node) {
                       PayloadRef& ref = payload(record(node), layer);
                       return WaitingPayload{&ref.offset, ref.size};
                   },
                   [&](std::int64_t copied) { return !progress || progress(done += copied, total); }};
    return copy_in_order(copy, directory.path() / layer_file(layer));
}

Result<void> StoreWriter::State::write_nodes() {
    const auto bytes = std::as_bytes(std::span(records));
    const auto header = header_of<NodesHeader>(bytes, records.size());
    return write_file(directory.path() / kNodesFile, std::as_bytes(std::span(&header, 1)), bytes);
}

void StoreWriter::State::count(TerrainInfo& info) const {
    info.triangles = info.heights_tiles = info.mesh_tiles = 0;
    for (const NodeRecord& record : records) {
        info.heights_tiles += record.heights.size > 0 ? 1 : 0;
        info.mesh_tiles += record.mesh.size > 0 ? 1 : 0;
        info.triangles += record.triangle_count;
    }
}

Result<TerrainInfo> StoreWriter::finish(TerrainInfo info, const Progress& progress) {
    State& state = *state_;
    state.count(info);
    std::int64_t done = 0;
    const std::int64_t total = info.heights_tiles + info.mesh_tiles;
    for (const Layer layer : kLayers) {
        const auto bytes = state.order_layer(layer, done, total, progress);
        if (!bytes) return bytes.error();
        (layer == Layer::heights ? info.heights_bytes : info.mesh_bytes) = static_cast<std::int64_t>(*bytes);
        state.waiting_in(layer).reset();
    }
    RIDGELINE_TRY(state.write_nodes());
    std::error_code ignored;
    fs::remove_all(state.scratch, ignored);
    const std::string text = to_json(info);
    RIDGELINE_TRY(write_file(state.directory.path() / kInfoFile, std::as_bytes(std::span(text)), {}));
    RIDGELINE_TRY(sync_directory(state.directory.path()));
    // A build takes hours, and others may have come to its target meanwhile.
    RIDGELINE_TRY(check_target(state.target, state.replace));
    RIDGELINE_TRY(state.directory.take_place(state.replace));
    return info;
}

}  // namespace ridgeline::io
