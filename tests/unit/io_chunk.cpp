#include <doctest/doctest.h>

#include <map>
#include <set>

#include "ridgeline/io/chunk_codec.h"
#include "ridgeline/io/relief_maker.h"
#include "support/reference_terrain.h"

using namespace ridgeline;
using namespace ridgeline::io;
using ridgeline::test::ReferenceTerrain;

namespace {

struct DecodedChunk {
    NodeRecord record;
    std::vector<std::uint8_t> payload;
    std::vector<ChunkVertex> block;
    ChunkView view;
};

DecodedChunk round_trip(const ReferenceTerrain& terrain, NodeId node, ChunkScratch& scratch) {
    DecodedChunk chunk;
    std::vector<std::uint8_t> payload;
    auto encoded =
        encode_chunk(terrain.grid(), node, ReferenceTerrain::NodeSource(terrain, node), scratch, payload);
    REQUIRE(encoded);
    ReliefBounds bounds;
    ReliefMaker().append(terrain.grid(), node, {}, scratch, terrain.heights_tile(node), *encoded, bounds,
                         payload);
    chunk.payload = payload;
    chunk.record.flags = NodeRecord::kHasData;
    chunk.record.vertex_count = encoded->vertex_count;
    chunk.record.index_count = encoded->index_count;
    chunk.record.triangle_count = encoded->triangle_count;
    chunk.record.min_quanta = encoded->min_quanta;
    chunk.record.max_quanta = encoded->max_quanta;
    chunk.block.resize(chunk_layout(chunk.record, {terrain.grid().quads()}).total / sizeof(ChunkVertex) + 1);
    chunk.view =
        ChunkView(std::as_writable_bytes(std::span(chunk.block)), chunk.record, {terrain.grid().quads()});
    REQUIRE(decode_chunk(terrain.grid(), node, chunk.record, {1.0, 1.0, 1.0}, payload,
                         terrain.heights_tile(node), scratch, chunk.view));
    return chunk;
}

using Point = std::pair<std::uint32_t, std::uint32_t>;

void for_each_node(const Grid& grid, const std::function<void(NodeId)>& visit) {
    for (std::int64_t i = 0; i < grid.node_count(); ++i) visit(grid.node_at(i));
}

// Twice the signed area, counter-clockwise seen from above with rows running south.
std::int64_t twice_area(const ChunkVertex& a, const ChunkVertex& b, const ChunkVertex& c) {
    const auto dx = [](const ChunkVertex& p, const ChunkVertex& q) { return std::int64_t{q.x()} - p.x(); };
    const auto dy = [](const ChunkVertex& p, const ChunkVertex& q) { return std::int64_t{q.y} - p.y; };
    return dy(a, b) * dx(a, c) - dx(a, b) * dy(a, c);
}

std::int64_t covered(const ChunkView& view, const IndexRange& range) {
    std::int64_t sum = 0;
    for (std::uint32_t i = range.first; i < range.first + range.count; i += 3) {
        const auto v = [&](std::uint32_t k) { return view.vertices()[view.indices()[i + k]]; };
        const std::int64_t area = twice_area(v(0), v(1), v(2));
        CHECK(area > 0);
        sum += area;
    }
    return sum;
}

}  // namespace

TEST_CASE("chunk: vertices are exactly the level's vertex set, at their heights, with the parent's surface") {
    ChunkScratch scratch;
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
        const ReferenceTerrain terrain(Grid(161 + 30 * seed, 140, 32),
                                       ReferenceTerrain::random_hills(seed, 40.0, 6.0));
        for_each_node(terrain.grid(), [&](NodeId node) {
            const DecodedChunk chunk = round_trip(terrain, node, scratch);
            const LatticePoint origin = terrain.grid().origin(node);
            const auto extent = terrain.grid().extent(node.level);
            std::map<Point, ChunkVertex> found;
            for (const ChunkVertex& v : chunk.view.vertices()) found[{v.x(), v.y}] = v;
            for (std::int64_t y = 0; y <= extent; ++y)
                for (std::int64_t x = 0; x <= extent; ++x) {
                    const auto at =
                        found.find({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)});
                    const bool in_level = terrain.in_level(node.level, origin.x + x, origin.y + y);
                    if (in_level) REQUIRE(at != found.end());
                    if (at == found.end()) continue;
                    const double own = terrain.surface(node.level, origin.x + x, origin.y + y);
                    const double parent =
                        node.level == 0 ? own : terrain.surface(node.level - 1, origin.x + x, origin.y + y);
                    CHECK(at->second.quanta == std::floor(own + 0.5));
                    // A fan vertex lies on the own edge and does not morph.
                    CHECK(at->second.delta ==
                          (in_level ? std::floor(parent + 0.5) - at->second.quanta : 0.0));
                }
        });
    }
}

TEST_CASE("chunk: every quarter is covered once, with plain sides and with fans") {
    ChunkScratch scratch;
    const ReferenceTerrain terrain(Grid(300, 200, 32), ReferenceTerrain::random_hills(9, 60.0, 8.0));
    for_each_node(terrain.grid(), [&](NodeId node) {
        const DecodedChunk chunk = round_trip(terrain, node, scratch);
        const ChunkRanges& ranges = chunk.view.ranges();
        const std::int64_t half = terrain.grid().extent(node.level) / 2;
        std::int64_t indices = 0;
        for (int q = 0; q < kQuarters; ++q) {
            std::int64_t plain = covered(chunk.view, ranges.inside[q]), fan = plain;
            for (int s = 0; s < kSides; ++s) {
                plain += covered(chunk.view, ranges.plain[q][s]);
                fan += covered(chunk.view, ranges.fan[q][s]);
                indices += ranges.plain[q][s].count;
                CHECK(covered(chunk.view, ranges.plain[q][s]) > 0);
            }
            indices += ranges.inside[q].count;
            CHECK(plain == 2 * half * half);
            if (node.level < terrain.grid().finest()) CHECK(fan == 2 * half * half);
        }
        CHECK(indices == 3 * std::int64_t{chunk.record.triangle_count});
        CHECK(ranges.inside[0].first == 0);
    });
}

TEST_CASE(
    "chunk: fans hold exactly the finer neighbour's border vertices, at the heights to which it morphs") {
    ChunkScratch scratch;
    const ReferenceTerrain terrain(Grid(257, 257, 32), ReferenceTerrain::random_hills(4, 50.0, 10.0));
    std::map<std::int64_t, DecodedChunk> chunks;
    for_each_node(terrain.grid(), [&](NodeId node) {
        chunks[terrain.grid().linear(node)] = round_trip(terrain, node, scratch);
    });
    int compared = 0;
    for_each_node(terrain.grid(), [&](NodeId node) {
        if (node.level == terrain.grid().finest() || !terrain.grid().contains(neighbour(node, Side::east)))
            return;
        const DecodedChunk& coarse = chunks[terrain.grid().linear(node)];
        for (const int q : {1, 3}) {
            // Points of the coarse node's eastern side, and of the finer node beyond it.
            std::map<std::uint32_t, std::int32_t> own, finer;
            const IndexRange& fan = coarse.view.ranges().fan[q][index(Side::east)];
            const auto extent = static_cast<std::uint32_t>(terrain.grid().extent(node.level));
            for (std::uint32_t i = fan.first; i < fan.first + fan.count; ++i) {
                const ChunkVertex& v = coarse.view.vertices()[coarse.view.indices()[i]];
                if (v.x() == extent) own[v.y] = v.quanta;
            }
            const NodeId beyond = neighbour(node, Side::east).child(q == 1 ? 0 : 2);
            const DecodedChunk& fine = chunks[terrain.grid().linear(beyond)];
            for (const ChunkVertex& v : fine.view.vertices())
                if (v.x() == 0 &&
                    (v.morph_class() != vertex_class::kInterior || v.y == 0 || v.y == extent / 2))
                    if (terrain.in_level(beyond.level, terrain.grid().origin(beyond).x,
                                         terrain.grid().origin(beyond).y + v.y))
                        finer[v.y + (q == 3 ? extent / 2 : 0)] = v.quanta + v.delta;
            CHECK(own == finer);
            ++compared;
        }
    });
    CHECK(compared > 20);
}

TEST_CASE("chunk: every cut and every flipped bit is an error or another chunk, never a crash") {
    ChunkScratch scratch;
    const ReferenceTerrain terrain(Grid(129, 129, 32), ReferenceTerrain::random_hills(5, 30.0, 4.0));
    const NodeId node{1, 1, 0};
    DecodedChunk chunk = round_trip(terrain, node, scratch);
    const std::vector<std::uint8_t>& payload = chunk.payload;
    const HeightsTile heights = terrain.heights_tile(node);
    const auto decode = [&](std::span<const std::uint8_t> bytes) {
        return decode_chunk(terrain.grid(), node, chunk.record, {1.0, 1.0, 1.0}, bytes, heights, scratch,
                            chunk.view)
            .ok();
    };
    for (std::size_t size = 0; size < payload.size(); ++size)
        CHECK_FALSE(decode(std::span(payload).first(size)));
    for (std::size_t bit = 0; bit < payload.size() * 8; ++bit) {
        auto damaged = payload;
        damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (1u << (bit % 8)));
        (void)decode(damaged);
    }
    CHECK(decode(payload));
}

TEST_CASE("chunk: normals of a plane are the plane's, with the south at the bottom") {
    ChunkScratch scratch;
    const ReferenceTerrain terrain(Grid(65, 65, 32), [](std::int64_t x, std::int64_t y) {
        return static_cast<std::int32_t>(2 * x - 3 * y);
    });
    const DecodedChunk chunk = round_trip(terrain, {1, 0, 0}, scratch);
    const NormalTexel n = chunk.view.normals()[33 * 16 + 16];
    const double length = std::sqrt(4.0 + 9.0 + 1.0);
    CHECK(n.east / 32767.0 == doctest::Approx(-2.0 / length).epsilon(0.001));
    CHECK(n.north / 32767.0 == doctest::Approx(-3.0 / length).epsilon(0.001));
}
