#include "ridgeline/io/store_writer.h"

#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ridgeline/io/output_file.h"

namespace ridgeline::io {
namespace {

namespace fs = std::filesystem;

constexpr Layer kLayers[] = {Layer::heights, Layer::mesh};
// Neighbours in the scratch file are mostly neighbours in the final one, so copies go through a buffer.
constexpr std::size_t kCopyBytes = 4u << 20;

PayloadRef& payload(NodeRecord& record, Layer layer) {
    return layer == Layer::heights ? record.heights : record.mesh;
}

// "a/b/" and "a/b" are the same directory.
fs::path normalised(const fs::path& path) {
    const fs::path clean = path.lexically_normal();
    return clean.has_filename() ? clean : clean.parent_path();
}

bool is_store(const fs::path& path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored) && fs::exists(path / "terrain.json", ignored);
}

Result<void> check_target(const fs::path& target, Replace replace) {
    std::error_code ignored;
    const auto status = fs::symlink_status(target, ignored);
    if (!fs::exists(status)) return {};
    if (fs::is_symlink(status))
        return Error{target.string() + ": is a symbolic link; name the place that it leads to"};
    if (!is_store(target)) return Error{target.string() + ": exists and is no terrain; choose another name"};
    if (replace == Replace::never) return Error{target.string() + ": exists already; --force replaces it"};
    return {};
}

Result<void> write_file(const fs::path& path, std::span<const std::byte> head,
                        std::span<const std::byte> body) {
    auto file = OutputFile::create(path);
    if (!file) return file.error();
    for (const auto& part : {head, body})
        if (const auto written = file->append(part); !written) return written.error();
    return file->sync();
}

// The nodes of a level along the Hilbert curve.
std::vector<NodeId> hilbert_order(const Grid& grid, int level) {
    const auto longer = static_cast<unsigned>(std::max(grid.nodes_x(level), grid.nodes_y(level)));
    const int order = std::bit_width(longer - 1);
    std::vector<std::pair<std::uint64_t, NodeId>> keyed;
    for (std::int32_t y = 0; y < grid.nodes_y(level); ++y)
        for (std::int32_t x = 0; x < grid.nodes_x(level); ++x)
            keyed.push_back({hilbert_index(x, y, order), {level, x, y}});
    std::sort(keyed.begin(), keyed.end());
    std::vector<NodeId> nodes;
    for (const auto& [key, node] : keyed) nodes.push_back(node);
    return nodes;
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
    auto file = OutputFile::create(directory.path() / layer_file(layer));
    if (!file) return file.error();
    std::vector<std::byte> buffer;
    std::uint64_t end = 0;
    const auto flush = [&]() -> Result<void> {
        const auto written = file->append(buffer);
        buffer.clear();
        if (!written) return written.error();
        file->start_sync();
        if (progress && !progress(done, total)) return Error{"stopped"};
        return {};
    };
    for (int level = 0; level < grid.levels(); ++level)
        for (const NodeId node : hilbert_order(grid, level)) {
            PayloadRef& ref = payload(record(node), layer);
            if (ref.size == 0) continue;
            const std::size_t before = buffer.size();
            buffer.resize(before + ref.size);
            RIDGELINE_TRY(waiting_in(layer)->read_at(ref.offset, std::span(buffer).subspan(before)));
            ref.offset = end;
            end += ref.size;
            ++done;
            if (buffer.size() >= kCopyBytes) RIDGELINE_TRY(flush());
        }
    RIDGELINE_TRY(flush());
    RIDGELINE_TRY(file->sync());
    return end;
}

Result<void> StoreWriter::State::write_nodes() {
    const auto bytes = std::as_bytes(std::span(records));
    NodesHeader header;
    header.record_count = records.size();
    header.checksum = XXH3_64bits(bytes.data(), bytes.size());
    return write_file(directory.path() / "nodes.bin", std::as_bytes(std::span(&header, 1)), bytes);
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
    RIDGELINE_TRY(write_file(state.directory.path() / "terrain.json", std::as_bytes(std::span(text)), {}));
    RIDGELINE_TRY(sync_directory(state.directory.path()));
    // A build takes hours, and others may have come to its target meanwhile.
    RIDGELINE_TRY(check_target(state.target, state.replace));
    RIDGELINE_TRY(state.directory.take_place(state.replace));
    return info;
}

}  // namespace ridgeline::io
