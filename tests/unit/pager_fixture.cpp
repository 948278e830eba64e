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

enum Salt : std::uint64_t { kMesh = 1, kHeights = 2, kChunk = 3 };

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

bool intact(const io::ChunkView& chunk, io::NodeId node) { return filled(chunk.geometry(), node, kChunk); }

FakeStore::FakeStore(const FakeStoreOptions& options) : grid_(options.width, options.height, options.quads) {
    std::mt19937_64 random(options.seed);
    records.resize(static_cast<std::size_t>(grid_.node_count()));
    for (int level = 0; level < grid_.levels(); ++level) {
        std::vector<io::NodeId> nodes;
        for (std::int64_t i = grid_.first(level); i < grid_.first(level + 1); ++i)
            nodes.push_back(grid_.node_at(i));
        std::sort(nodes.begin(), nodes.end(), [&](io::NodeId a, io::NodeId b) {
            return io::hilbert_index(a.x, a.y, 16) < io::hilbert_index(b.x, b.y, 16);
        });
        for (const io::NodeId node : nodes) {
            io::NodeRecord& record = records[static_cast<std::size_t>(grid_.linear(node))];
            record.flags = io::NodeRecord::kHasData;
            record.vertex_count = 50 + static_cast<std::uint32_t>(random() % options.max_vertices);
            record.index_count = 6 * record.vertex_count;
            record.mesh = append(mesh.bytes, 100 + random() % 2000, node, kMesh);
            record.heights = append(heights.bytes, 100 + random() % 2000, node, kHeights);
        }
    }
}

TileSource FakeStore::source() {
    TileSource source;
    source.name = "fake.terrain";
    source.grid = grid_;
    source.records = records;
    source.mesh = &mesh;
    source.heights = &heights;
    return source;
}

std::uint64_t FakeStore::chunk_bytes() const {
    std::uint64_t bytes = 0;
    for (const io::NodeRecord& record : records)
        bytes += RamRing::pages_for(io::chunk_layout(record, {.quads = grid_.quads()}).total) *
                 RamRing::kPageBytes;
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
    : pager_(pager), store_(store), options_(options), used_stamp_(store.records.size()) {
    const std::size_t slots = store.records.size();
    node_of_slot_.assign(slots, kNoNode);
    for (std::uint32_t slot = 0; slot < slots; ++slot) free_slots_.push_back(slot);
    used_.reserve(slots);
}

void FakeRenderer::frame(std::span<const NodeIndex> wanted) {
    ++frame_;
    now_ += options_.step;
    pager_.begin_frame(frame_, now_);
    upload();
    draw(wanted);
    pager_.touch(used_);
    pager_.request(wanted);
    for (const GpuSlot slot : pager_.take_released_gpu_slots()) release(slot);
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

void FakeRenderer::upload() {
    for (const Upload& upload : pager_.ready_to_upload(options_.upload_budget)) {
        const io::NodeId id = store_.id(upload.node);
        if (id.level > 0 && !resident(store_.index(id.parent()))) continue;
        REQUIRE(intact(upload.chunk, id));
        while (gpu_bytes_ + upload.bytes > options_.gpu_bytes) {
            const auto victim = pager_.gpu_victim(upload.node);
            if (!victim) break;
            release(victim->slot);
        }
        if (gpu_bytes_ + upload.bytes > options_.gpu_bytes) continue;
        gpu_bytes_ += upload.bytes;
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
    gpu_bytes_ -= io::chunk_layout(store_.records[node], {.quads = store_.grid().quads()}).ranges;
    free_slots_.push_back(static_cast<std::uint32_t>(slot));
    node = kNoNode;
}

void FakeRenderer::draw(std::span<const NodeIndex> wanted) {
    const SelectionLease lease = pager_.lend_to_selection();
    used_.clear();
    const auto draw_if_resident = [&](NodeIndex node) {
        if (!lease.snapshot()[node].resident || used_stamp_[node] == frame_) return;
        const io::NodeId id = store_.id(node);
        if (id.level > 0 && used_stamp_[store_.index(id.parent())] != frame_) return;
        used_stamp_[node] = frame_;
        used_.push_back(node);
    };
    for (NodeIndex node = 0; node < static_cast<NodeIndex>(store_.grid().first(1)); ++node)
        draw_if_resident(node);
    for (const NodeIndex node : wanted) draw_if_resident(node);
}

void FakeRenderer::check_kept() const {
    REQUIRE(pager_.ram_bytes_used() <= pager_.ram_bytes_capacity());
    REQUIRE(gpu_bytes_ <= options_.gpu_bytes);
    for (const NodeIndex node : used_) REQUIRE(resident(node));
    for (const NodeIndex node : node_of_slot_) {
        if (node == kNoNode) continue;
        REQUIRE(resident(node));
        const io::NodeId id = store_.id(node);
        if (id.level > 0) REQUIRE(resident(store_.index(id.parent())));
    }
}

}  // namespace ridgeline::pager::test
