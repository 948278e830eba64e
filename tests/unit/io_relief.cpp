// What reliefs promise, held against a slow and exact drawn surface, on random terrains with and without
// voids.
#include <doctest/doctest.h>

#include <map>

#include "ridgeline/io/relief_codec.h"
#include "ridgeline/io/relief_lattice.h"
#include "ridgeline/io/relief_maker.h"
#include "ridgeline/io/store.h"
#include "support/drawn_reference.h"
#include "support/reference_terrain.h"

using namespace ridgeline;
using namespace ridgeline::io;
using namespace ridgeline::test;

namespace {

// Heights are exact to far below this; a float's rounding of decoded heights is not.
constexpr double kRounding = 0.01;

struct MadeNode {
    NodeRecord record;
    std::vector<std::uint8_t> payload;
    std::vector<ChunkVertex> block;
    ChunkView view;
};

struct TerrainShape {
    std::int64_t width, height;
    int quads;
    std::uint32_t seed;
    double amplitude, noise;
    bool voids;
    ReliefShape relief{};
};

// Cells without ground: some discs, and whatever lies past the raster.
bool cell_is_valid(const TerrainShape& shape, std::int64_t x, std::int64_t y) {
    if (x + 1 >= shape.width || y + 1 >= shape.height || x < 0 || y < 0) return false;
    const std::int64_t dx = x % 47 - 23, dy = y % 59 - 29;
    const auto disc =
        static_cast<std::uint32_t>(x / 47 * 7919 + y / 59 * 104729 + shape.seed) * 2654435761u >> 29;
    return !shape.voids || disc > 2 || dx * dx + dy * dy > 30 * static_cast<std::int64_t>(disc + 1);
}

class Terrain {
  public:
    explicit Terrain(const TerrainShape& shape)
        : shape_(shape),
          terrain_(Grid(shape.width, shape.height, shape.quads),
                   ReferenceTerrain::random_hills(shape.seed, shape.amplitude, shape.noise)) {
        for (std::int64_t i = grid().node_count() - 1; i >= 0; --i) make(grid().node_at(i));
    }

    const Grid& grid() const { return terrain_.grid(); }
    ChunkShape chunk_shape() const { return {grid().quads(), shape_.relief}; }
    const MadeNode& node(NodeId id) const { return nodes_.at(grid().linear(id)); }
    HeightsTile heights(NodeId id) const {
        HeightsTile tile = terrain_.heights_tile(id);
        const std::int64_t step = grid().step(id.level);
        const LatticePoint origin = grid().origin(id);
        for (int row = 0; row < tile.quads; ++row)
            for (int column = 0; column < tile.quads; ++column) {
                bool any = false;
                for (std::int64_t y = 0; y < step && !any; ++y)
                    for (std::int64_t x = 0; x < step && !any; ++x)
                        any = cell_is_valid(shape_, origin.x + column * step + x, origin.y + row * step + y);
                tile.cell_valid.push_back(any ? 1 : 0);
            }
        const bool all =
            std::find(tile.cell_valid.begin(), tile.cell_valid.end(), 0) == tile.cell_valid.end();
        if (all) tile.cell_valid.clear();
        return tile;
    }

  private:
    void make(NodeId id) {
        MadeNode& made = nodes_[grid().linear(id)];
        ReliefBounds& bounds = bounds_[grid().linear(id)];
        const HeightsTile tile = heights(id);
        auto encoded =
            encode_chunk(grid(), id, ReferenceTerrain::NodeSource(terrain_, id), scratch_, made.payload);
        REQUIRE(encoded);
        maker_.append(grid(), id, shape_.relief, scratch_, tile, *encoded, bounds, made.payload);
        if (id.level > 0) bounds_[grid().linear(id.parent())].add_child(shape_.relief, id.quarter(), bounds);
        made.record.flags = NodeRecord::kHasData | (tile.cell_valid.empty() ? 0u : NodeRecord::kHasMask);
        made.record.vertex_count = encoded->vertex_count;
        made.record.index_count = encoded->index_count;
        made.record.min_quanta = encoded->min_quanta;
        made.record.max_quanta = encoded->max_quanta;
        made.block.resize(chunk_layout(made.record, chunk_shape()).total / sizeof(ChunkVertex) + 1);
        made.view = ChunkView(std::as_writable_bytes(std::span(made.block)), made.record, chunk_shape());
        const auto decoded =
            decode_chunk(grid(), id, made.record, {}, made.payload, tile, scratch_, made.view);
        REQUIRE_MESSAGE(decoded, (decoded ? std::string() : decoded.error().message));
    }

    TerrainShape shape_;
    ReferenceTerrain terrain_;
    ChunkScratch scratch_;
    ReliefMaker maker_;
    std::map<std::int64_t, MadeNode> nodes_;
    std::map<std::int64_t, ReliefBounds> bounds_;
};

const std::vector<TerrainShape> kShapes = {
    {120, 90, 32, 1, 60.0, 5.0, false},
    {200, 131, 32, 2, 40.0, 30.0, true},
    {300, 200, 64, 3, 60.0, 5.0, true, {6, 16, 20}},
    {257, 257, 128, 4, 90.0, 8.0, false},
    {131, 70, 64, 5, 0.0, 2.0, false, {4, 8, 16}},
    {150, 150, 32, 6, 3000.0, 40.0, true, {2, 32, 14}},
};

std::string describe(const TerrainShape& shape) {
    return std::to_string(shape.width) + " x " + std::to_string(shape.height) + ", quads " +
           std::to_string(shape.quads);
}

template <class Visit>
void for_each_node(const Grid& grid, Visit&& visit) {
    for (std::int64_t i = 0; i < grid.node_count(); ++i) visit(grid.node_at(i));
}

constexpr Morph kMorphs[] = {Morph::own, Morph::parent, Morph::lesser, Morph::random, Morph::random};

}  // namespace

TEST_CASE(
    "relief: every segment lies on or under all that may be drawn of the node, along its whole length") {
    for (const TerrainShape& shape : kShapes) {
        CAPTURE(describe(shape));
        const Terrain terrain(shape);
        std::mt19937 random(shape.seed);
        std::size_t compared = 0;
        for_each_node(terrain.grid(), [&](NodeId id) {
            const MadeNode& node = terrain.node(id);
            const auto extent = static_cast<double>(terrain.grid().extent(id.level));
            const auto segments = segments_of(node.view.relief(), node.record, extent, shape.quads);
            for (const Morph morph : kMorphs)
                CHECK(chains_excess(segments, drawn_triangles(node.view, morph, random)) <= kRounding);
            for (const ChainSegment& segment : segments)
                CHECK(!touches_void(segment, node.view, extent, shape.quads));
            compared += segments.size();
        });
        CHECK(compared > 0);
    }
}

TEST_CASE("relief: maxima bound all that may be drawn of the node and of all below it") {
    for (const TerrainShape& shape : kShapes) {
        CAPTURE(describe(shape));
        const Terrain terrain(shape);
        std::mt19937 random(shape.seed);
        for_each_node(terrain.grid(), [&](NodeId id) {
            const auto own = terrain.grid().origin(id);
            for (const Morph morph : {Morph::own, Morph::parent, Morph::greater, Morph::random}) {
                const auto surface = drawn_triangles(terrain.node(id).view, morph, random);
                for (NodeId above = id; above.level >= 0; above = above.parent()) {
                    const auto origin = terrain.grid().origin(above);
                    const MadeNode& node = terrain.node(above);
                    const Square square{static_cast<double>(own.x - origin.x),
                                        static_cast<double>(own.y - origin.y),
                                        static_cast<double>(terrain.grid().extent(id.level))};
                    CHECK(maxima_excess(node.view.relief(), node.record,
                                        static_cast<double>(terrain.grid().extent(above.level)), square,
                                        surface) <= kRounding);
                    if (above.level == 0) break;
                }
            }
        });
    }
}

namespace {

// A relief whose chains stand `steps` higher than the node's, and whose maxima `codes` lower.
void raise_chains(ReliefView relief, int steps) {
    for (const ReliefAxis axis : {ReliefAxis::east, ReliefAxis::south})
        for (int band = 0; band < relief.shape().bands; ++band)
            for (std::uint16_t& code : relief.heights(axis, band))
                if (code != chain_height::kHidesNothing)
                    code = chain_step::code(std::min(chain_step::of(code) + steps, chain_step::kMost));
}
void lower_maxima(ReliefView relief, int codes) {
    for (std::uint8_t& code : relief.maxima()) code = static_cast<std::uint8_t>(std::max(code - codes, 0));
}

}  // namespace

TEST_CASE("relief: chains two steps higher and maxima one code lower are found out, so both are tight") {
    const TerrainShape shape{150, 150, 32, 8, 60.0, 5.0, false};
    const Terrain terrain(shape);
    std::mt19937 random(1);
    for_each_node(terrain.grid(), [&](NodeId id) {
        // Mostly past the raster, a node is flat.
        if (id.level == 0) return;
        const MadeNode& node = terrain.node(id);
        const ChunkView& chunk = node.view;
        const auto extent = static_cast<double>(terrain.grid().extent(id.level));
        const auto low = drawn_triangles(chunk, Morph::lesser, random);
        const auto high = drawn_triangles(chunk, Morph::greater, random);
        raise_chains(chunk.relief(), 2);
        lower_maxima(chunk.relief(), 1);
        CHECK(chains_excess(segments_of(chunk.relief(), node.record, extent, shape.quads), low) > kRounding);
        if (id.level == terrain.grid().finest())
            CHECK(maxima_excess(chunk.relief(), node.record, extent, {0.0, 0.0, extent}, high) > kRounding);
    });
}

TEST_CASE("relief: with plain ground everywhere, every vertex of every chain hides something") {
    const TerrainShape shape{257, 257, 64, 9, 60.0, 5.0, false};
    const Terrain terrain(shape);
    for_each_node(terrain.grid(), [&](NodeId id) {
        const ChunkShape& of = terrain.chunk_shape();
        if (terrain.node(id).record.has_mask()) return;
        const auto segments =
            segments_of(terrain.node(id).view.relief(), terrain.node(id).record, 1.0, shape.quads);
        CHECK(segments.size() == static_cast<std::size_t>(of.relief.chains() * of.relief.steps));
    });
}

TEST_CASE("relief: the codec gives back whatever lies within the bands and on the steps") {
    std::mt19937 random(3);
    for (const int quads : {32, 64, 128})
        for (const ReliefShape& shape : {ReliefShape{}, ReliefShape{2, 8, 14}, ReliefShape{6, 32, 20}})
            for (const std::int32_t range : {0, 1, 700, 1 << 28}) {
                HeightsTile tile;
                tile.quads = quads;
                NodeRecord record;
                record.min_quanta = -range;
                record.max_quanta = range;
                for (int i = 0; i < tile.stride() * tile.stride(); ++i)
                    tile.quanta.push_back(std::uniform_int_distribution(-range, range)(random));
                std::vector<std::byte> made(shape.bytes()), back(shape.bytes());
                const ReliefView relief(made, shape);
                for (const ReliefAxis axis : {ReliefAxis::east, ReliefAxis::south})
                    for (int band = 0; band < shape.bands; ++band) {
                        const LatticeRange places = band_range(shape, quads, band);
                        for (std::uint16_t& code : relief.heights(axis, band))
                            code =
                                random() % 9 == 0
                                    ? chain_height::kHidesNothing
                                    : chain_step::code(static_cast<int>(random() % (chain_step::kMost + 1)));
                        for (std::uint8_t& across : relief.across(axis, band))
                            across = static_cast<std::uint8_t>(
                                std::uniform_int_distribution(places.first, places.last)(random));
                    }
                for (std::uint8_t& code : relief.maxima()) code = static_cast<std::uint8_t>(random());
                std::vector<std::uint8_t> payload;
                encode_relief(relief, record, tile, payload);
                REQUIRE(decode_relief(payload, record, tile, ReliefView(back, shape)));
                CHECK(made == back);
                for (std::size_t size = 0; size < payload.size(); size += 7)
                    CHECK_FALSE(
                        decode_relief(std::span(payload).first(size), record, tile, ReliefView(back, shape)));
            }
}
