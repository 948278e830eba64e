#include "unit/pager_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <thread>

#include "ridgeline/io/store.h"

namespace ridgeline::pager::test {
namespace {

std::uint64_t mix(std::uint64_t k) {
    k = (k ^ (k >> 30)) * 0xbf58476d1ce4e5b9ULL;
    k = (k ^ (k >> 27)) * 0x94d049bb133111ebULL;
    return k ^ (k >> 31);
}

std::uint64_t seed_of(io::NodeId node) { return io::NodeIdHash{}(node) | 1; }

// The n-th word that the node's payloads and chunk consist of.
std::uint64_t word_of(io::NodeId node, std::uint64_t salt, std::uint64_t n) {
    return mix(seed_of(node) + salt * 0x9e3779b97f4a7c15ULL + n);
}

enum Salt : std::uint64_t { kMesh = 1, kHeights = 2, kChunk = 3, kPacked = 4, kTexels = 5 };

template <class Byte>
void fill(std::span<Byte> bytes, io::NodeId node, Salt salt) {
    for (std::size_t i = 0; i < bytes.size(); i += 8) {
        const std::uint64_t word = word_of(node, salt, i);
        std::memcpy(bytes.data() + i, &word, std::min<std::size_t>(8, bytes.size() - i));
    }
}

template <class Byte>
bool filled(std::span<const Byte> bytes, io::NodeId node, Salt salt) {
    for (std::size_t i = 0; i < bytes.size(); i += 8) {
        const std::uint64_t word = word_of(node, salt, i);
        if (std::memcmp(bytes.data() + i, &word, std::min<std::size_t>(8, bytes.size() - i)) != 0)
            return false;
    }
    return true;
}

io::PayloadRef append(std::vector<std::uint8_t>& file, std::size_t size, io::NodeId node, Salt salt) {
    std::vector<std::uint8_t> bytes(size);
    fill(std::span(bytes), node, salt);
    io::PayloadRef payload{file.size(), io::payload_checksum(bytes), static_cast<std::uint32_t>(size)};
    file.insert(file.end(), bytes.begin(), bytes.end());
    return payload;
}

}  // namespace

Result<void> MemorySource::read(std::uint64_t offset, std::span<std::uint8_t> out) {
    if (before_read) before_read(offset, out.size());
    if (offset + out.size() > bytes.size()) return Error{"past the end"};
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), out.size(), out.begin());
    return {};
}

Result<void> PatternDecoder::decode(const EncodedTile& tile, DecodeScratch&,
                                    std::span<std::byte> block) const {
    if (tile.node == refused) return Error{"the chunk does not decode"};
    if (!filled(tile.mesh, tile.node, kMesh) || !filled(tile.heights, tile.node, kHeights))
        return Error{"damage got past the checksum"};
    fill(block, tile.node, kChunk);
    return {};
}

Result<void> PatternDecoder::decode_imagery(const EncodedImagery& tile, DecodeScratch&,
                                            std::span<std::byte> block) const {
    if (!filled(tile.payload, tile.node, kPacked)) return Error{"damage got past the checksum"};
    fill(block.first(io::kImageryTileBytes), tile.node, kTexels);
    return {};
}

bool intact(const io::ChunkView& chunk, io::NodeId node) { return filled(chunk.geometry(), node, kChunk); }
bool intact(std::span<const std::byte> imagery, io::NodeId node) { return filled(imagery, node, kTexels); }

namespace {

// A level's nodes as stores order them.
std::vector<io::NodeId> in_file_order(const io::Grid& grid, int level) {
    std::vector<io::NodeId> nodes;
    for (std::int64_t i = grid.first(level); i < grid.first(level + 1); ++i) nodes.push_back(grid.node_at(i));
    std::sort(nodes.begin(), nodes.end(), [](io::NodeId a, io::NodeId b) {
        return io::hilbert_index(a.x, a.y, 16) < io::hilbert_index(b.x, b.y, 16);
    });
    return nodes;
}

}  // namespace

FakeStore::FakeStore(const FakeStoreOptions& options) : grid_(options.width, options.height, options.quads) {
    std::mt19937_64 random(options.seed);
    make_chunks(options, random);
    if (options.imagery_width == 0) return;
    imagery_grid_ = io::Grid(options.imagery_width + 1, options.imagery_height + 1, io::kImageryTile);
    make_imagery(random);
}

void FakeStore::make_chunks(const FakeStoreOptions& options, std::mt19937_64& random) {
    records.resize(static_cast<std::size_t>(grid_.node_count()));
    for (int level = 0; level < grid_.levels(); ++level)
        for (const io::NodeId node : in_file_order(grid_, level)) {
            io::NodeRecord& record = records[static_cast<std::size_t>(grid_.linear(node))];
            record.flags = io::NodeRecord::kHasData;
            record.vertex_count = 50 + static_cast<std::uint32_t>(random() % options.max_vertices);
            record.index_count = 6 * record.vertex_count;
            record.mesh = append(mesh.bytes, 100 + random() % 2000, node, kMesh);
            record.heights = append(heights.bytes, 100 + random() % 2000, node, kHeights);
        }
}

void FakeStore::make_imagery(std::mt19937_64& random) {
    imagery_records.resize(static_cast<std::size_t>(imagery_grid_.node_count()));
    for (int level = 0; level < imagery_grid_.levels(); ++level)
        for (const io::NodeId node : in_file_order(imagery_grid_, level)) {
            const io::PayloadRef payload = append(imagery.bytes, 100 + random() % 3000, node, kPacked);
            imagery_records[static_cast<std::size_t>(imagery_grid_.linear(node))] = {
                payload.offset, payload.checksum, payload.size, io::ImageryRecord::kHasData};
        }
}

TileSource FakeStore::source() {
    TileSource source;
    source.name = "fake.terrain";
    source.grid = grid_;
    source.records = records;
    source.mesh = &mesh;
    source.heights = &heights;
    if (!imagery_records.empty()) source.imagery = {imagery_grid_, imagery_records, &imagery};
    return source;
}

namespace {

std::uint64_t ring_bytes(const TileSource& source, NodeIndex tile) {
    return RamRing::pages_for(source.decoded_bytes(tile)) * RamRing::kPageBytes;
}

}  // namespace

std::uint64_t FakeStore::tile_bytes() {
    std::uint64_t bytes = 0;
    for (NodeIndex tile = 0; tile < tiles().count(); ++tile) bytes += ring_bytes(source(), tile);
    return bytes;
}

std::uint64_t FakeStore::level0_bytes() {
    std::uint64_t bytes = 0;
    for (const TileKind kind : kEveryTileKind)
        for (NodeIndex root = 0; root < tiles().root_count(kind); ++root)
            bytes += ring_bytes(source(), tiles().begin(kind) + root);
    return bytes;
}

void FakeStore::damage(NodeIndex node) { mesh.bytes[records[node].mesh.offset] ^= 1; }

std::vector<NodeIndex> nodes_around(const io::Grid& grid, double column, double row, int radius) {
    std::vector<NodeIndex> nodes;
    for (int level = 0; level < grid.levels(); ++level) {
        const auto extent = static_cast<double>(grid.extent(level));
        const int x = static_cast<int>(column / extent), y = static_cast<int>(row / extent);
        for (int dy = -radius; dy <= radius; ++dy)
            for (int dx = -radius; dx <= radius; ++dx)
                if (grid.contains({level, x + dx, y + dy}))
                    nodes.push_back(static_cast<NodeIndex>(grid.linear({level, x + dx, y + dy})));
    }
    return nodes;
}

FakeRenderer::FakeRenderer(Pager& pager, FakeStore& store, const Options& options)
    : pager_(pager),
      source_(store.source()),
      tiles_(store.tiles()),
      options_(options),
      used_stamp_(tiles_.count()) {
    node_of_slot_.assign(tiles_.count(), kNoNode);
    for (std::uint32_t slot = 0; slot < tiles_.count(); ++slot) free_slots_.push_back(slot);
    used_.reserve(tiles_.count());
}

void FakeRenderer::frame(std::span<const NodeIndex> wanted) {
    ++frame_;
    now_ += options_.step;
    pager_.begin_frame(frame_, now_);
    upload();
    draw(wanted);
    pager_.touch(used_);
    pager_.request(wanted);
    for (const TileKind kind : kEveryTileKind)
        for (const GpuSlot slot : pager_.take_released_gpu_slots(kind)) release(slot);
    check_kept();
}

bool FakeRenderer::settle(std::span<const NodeIndex> wanted) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    do {
        frame(wanted);
        if (pager_.settled()) return true;
        std::this_thread::yield();
    } while (std::chrono::steady_clock::now() < end);
    return false;
}

bool FakeRenderer::parent_resident(NodeIndex node) const {
    const io::NodeId id = tiles_.id(node);
    return id.level == 0 || resident(tiles_.index(tiles_.kind(node), id.parent()));
}

bool FakeRenderer::make_room(const Upload& upload) {
    const std::uint64_t& used = gpu_bytes_[index(upload.kind)];
    while (used + upload.bytes > gpu_capacity(upload.kind)) {
        const auto victim = pager_.gpu_victim(upload.node);
        if (!victim) return false;
        REQUIRE(tiles_.kind(victim->node) == upload.kind);
        release(victim->slot);
    }
    return true;
}

void FakeRenderer::upload() {
    bool full[kTileKinds] = {};
    for (const Upload& upload : pager_.ready_to_upload(options_.upload_budget)) {
        if (full[index(upload.kind)] || !parent_resident(upload.node)) continue;
        const io::NodeId id = tiles_.id(upload.node);
        REQUIRE(upload.kind == tiles_.kind(upload.node));
        REQUIRE((upload.kind == TileKind::chunk ? intact(upload.chunk, id) : intact(upload.texels, id)));
        full[index(upload.kind)] = !make_room(upload);
        if (full[index(upload.kind)]) continue;
        gpu_bytes_[index(upload.kind)] += upload.bytes;
        const std::uint32_t slot = free_slots_.back();
        free_slots_.pop_back();
        node_of_slot_[slot] = upload.node;
        pager_.mark_resident(upload.node, GpuSlot{slot});
    }
}

void FakeRenderer::release(GpuSlot slot) {
    NodeIndex& node = node_of_slot_[static_cast<std::uint32_t>(slot)];
    REQUIRE(node != kNoNode);
    // Never what this or the last frame drew.
    REQUIRE((used_stamp_[node] == 0 || used_stamp_[node] + 1 < frame_));
    const TileKind kind = tiles_.kind(node);
    gpu_bytes_[index(kind)] -= kind == TileKind::imagery
                                   ? io::kImageryTileBytes
                                   : io::chunk_layout(source_.record(node), source_.chunk_shape()).ranges;
    free_slots_.push_back(static_cast<std::uint32_t>(slot));
    node = kNoNode;
}

void FakeRenderer::draw(std::span<const NodeIndex> wanted) {
    const SelectionLease lease = pager_.lend_to_selection();
    used_.clear();
    const auto draw_if_resident = [&](NodeIndex node) {
        if (!resident(node) || used_stamp_[node] == frame_) return;
        if (tiles_.kind(node) == TileKind::chunk) REQUIRE(lease.snapshot()[node].resident);
        const io::NodeId id = tiles_.id(node);
        if (id.level > 0 && used_stamp_[tiles_.index(tiles_.kind(node), id.parent())] != frame_) return;
        used_stamp_[node] = frame_;
        used_.push_back(node);
    };
    for (const TileKind kind : kEveryTileKind)
        for (NodeIndex root = 0; root < tiles_.root_count(kind); ++root)
            draw_if_resident(tiles_.begin(kind) + root);
    for (const NodeIndex node : wanted) draw_if_resident(node);
}

void FakeRenderer::check_kept() const {
    REQUIRE(pager_.ram_bytes_used() <= pager_.ram_bytes_capacity());
    for (const TileKind kind : kEveryTileKind) REQUIRE(gpu_bytes_[index(kind)] <= gpu_capacity(kind));
    for (const NodeIndex node : used_) REQUIRE(resident(node));
    for (const NodeIndex node : node_of_slot_) {
        if (node == kNoNode) continue;
        REQUIRE(resident(node));
        REQUIRE(parent_resident(node));
    }
}

}  // namespace ridgeline::pager::test
