// Whole stores against a slow and exact reference: heights, validity, vertex sets, errors, bounds.
#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "build_fixture.h"
#include "ridgeline/io/chunk_codec.h"
#include "support/drawn_reference.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

struct Built {
    explicit Built(const Case& c) : rows(rows_of(c)) {
        const auto report = build::build_from_rows(rows, options_for(c, folder.path() / "t.terrain"));
        REQUIRE_MESSAGE(report, (report ? std::string() : report.error().message));
        auto opened = io::Store::open(folder.path() / "t.terrain");
        REQUIRE_MESSAGE(opened, (opened ? std::string() : opened.error().message));
        store.emplace(std::move(*opened));
    }
    ScratchFolder folder;
    MemoryRows rows;
    std::optional<io::Store> store;
};

std::string describe(const Case& c) {
    return std::to_string(c.width) + " x " + std::to_string(c.height) + ", tile " + std::to_string(c.tile);
}

template <class Visit>
void for_each_node_with_data(const io::Store& store, Visit&& visit) {
    for (std::int64_t i = 0; i < store.grid().node_count(); ++i) {
        const io::NodeId node = store.grid().node_at(i);
        if (store.record(node).has_data()) visit(node, store.record(node));
    }
}

// Decodes a node's chunk; the view points into `block`.
io::ChunkView decode(const io::Store& store, io::NodeId node, std::vector<io::ChunkVertex>& block) {
    thread_local io::ChunkScratch scratch;
    const io::NodeRecord& record = store.record(node);
    std::vector<std::uint8_t> heights_bytes, mesh_bytes;
    io::HeightsTile heights;
    REQUIRE(store.read_heights(node, heights_bytes, heights));
    REQUIRE(store.read_payload(io::Layer::mesh, node, mesh_bytes));
    block.resize(io::chunk_layout(record, store.chunk_shape()).total / sizeof(io::ChunkVertex) + 1);
    io::ChunkView view(std::as_writable_bytes(std::span(block)), record, store.chunk_shape());
    REQUIRE(io::decode_chunk(store.grid(), node, record, store.chunk_spacing(), mesh_bytes, heights, scratch,
                             view));
    return view;
}

// Calls visit(x, y, height) for every lattice point of a triangle, in finest samples from the node's corner.
template <class Visit>
void for_each_point(const io::ChunkVertex& a, const io::ChunkVertex& b, const io::ChunkVertex& c,
                    Visit&& visit) {
    const auto x = [](const io::ChunkVertex& v) { return std::int64_t{v.x()}; };
    const auto y = [](const io::ChunkVertex& v) { return std::int64_t{v.y}; };
    const auto area = [&](std::int64_t ax, std::int64_t ay, std::int64_t bx, std::int64_t by, std::int64_t px,
                          std::int64_t py) { return (bx - ax) * (py - ay) - (by - ay) * (px - ax); };
    const std::int64_t whole = area(x(a), y(a), x(b), y(b), x(c), y(c));
    for (std::int64_t py = std::min({y(a), y(b), y(c)}); py <= std::max({y(a), y(b), y(c)}); ++py)
        for (std::int64_t px = std::min({x(a), x(b), x(c)}); px <= std::max({x(a), x(b), x(c)}); ++px) {
            const std::int64_t wa = area(x(b), y(b), x(c), y(c), px, py),
                               wb = area(x(c), y(c), x(a), y(a), px, py);
            const std::int64_t wc = whole - wa - wb;
            const bool inside = whole > 0 ? wa >= 0 && wb >= 0 && wc >= 0 : wa <= 0 && wb <= 0 && wc <= 0;
            if (!inside) continue;
            const auto sum = static_cast<double>(wa) * a.quanta + static_cast<double>(wb) * b.quanta +
                             static_cast<double>(wc) * c.quanta;
            visit(px, py, sum / static_cast<double>(whole));
        }
}

// The largest error of a chunk, drawn with plain sides, at the valid samples of its node; quanta.
double measured_error(const io::ChunkView& chunk, const MemoryRows& rows, io::LatticePoint origin) {
    double most = 0.0;
    const auto widen = [&](const io::IndexRange& range) {
        for (std::uint32_t i = range.first; i < range.first + range.count; i += 3) {
            const auto v = [&](std::uint32_t k) { return chunk.vertices()[chunk.indices()[i + k]]; };
            for_each_point(v(0), v(1), v(2), [&](std::int64_t x, std::int64_t y, double height) {
                if (rows.valid(origin.x + x, origin.y + y))
                    most = std::max(most, std::abs(height - rows.sample(origin.x + x, origin.y + y)));
            });
        }
    };
    for (const io::IndexRange& range : chunk.ranges().inside) widen(range);
    for (const auto& sides : chunk.ranges().plain)
        for (const io::IndexRange& range : sides) widen(range);
    return most;
}

}  // namespace

TEST_CASE(
    "builder: every valid sample comes back exactly at every level; cells are valid if any source cell is") {
    for (const Case& c : kCases) {
        CAPTURE(describe(c));
        const Built built(c);
        const io::Grid& grid = built.store->grid();
        std::vector<std::uint8_t> bytes;
        io::HeightsTile tile;
        std::int64_t wrong_samples = 0, wrong_cells = 0;
        for_each_node_with_data(*built.store, [&](io::NodeId node, const io::NodeRecord& record) {
            REQUIRE(built.store->read_heights(node, bytes, tile));
            const std::int64_t step = grid.step(node.level);
            const io::LatticePoint origin = grid.origin(node);
            constexpr int kApron = io::HeightsTile::kApron;
            for (int row = -kApron; row <= tile.quads + kApron; ++row)
                for (int column = -kApron; column <= tile.quads + kApron; ++column) {
                    const std::int64_t x = origin.x + column * step, y = origin.y + row * step;
                    const bool valid = built.rows.valid(x, y);
                    wrong_samples +=
                        (tile.all_valid || tile.sample_valid[tile.at(column, row)] != 0) != valid;
                    if (valid) wrong_samples += tile.quanta[tile.at(column, row)] != built.rows.sample(x, y);
                }
            bool any_invalid = false;
            for (int row = 0; row < tile.quads; ++row)
                for (int column = 0; column < tile.quads; ++column) {
                    bool any = false;
                    for (std::int64_t y = 0; y < step && !any; ++y)
                        for (std::int64_t x = 0; x < step && !any; ++x)
                            any = built.rows.cell_valid(origin.x + column * step + x,
                                                        origin.y + row * step + y);
                    const auto at = static_cast<std::size_t>(row * tile.quads + column);
                    wrong_cells += (tile.all_valid || tile.cell_valid[at] != 0) != any;
                    any_invalid = any_invalid || !any;
                }
            CHECK(record.has_mask() == any_invalid);
        });
        CHECK(wrong_samples == 0);
        CHECK(wrong_cells == 0);
    }
}

TEST_CASE("builder: a node has data if a sample of it is valid; roots always have") {
    for (const Case& c : kCases) {
        CAPTURE(describe(c));
        const Built built(c);
        const io::Grid& grid = built.store->grid();
        for (std::int64_t i = 0; i < grid.node_count(); ++i) {
            const io::NodeId node = grid.node_at(i);
            const io::LatticePoint origin = grid.origin(node);
            bool any = node.level == 0;
            for (std::int64_t y = origin.y; y <= origin.y + grid.extent(node.level) && !any; ++y)
                for (std::int64_t x = origin.x; x <= origin.x + grid.extent(node.level) && !any; ++x)
                    any = built.rows.valid(x, y);
            CHECK(built.store->record(node).has_data() == any);
        }
    }
}

TEST_CASE("builder: a store opens and verifies whose roots are mostly without heights") {
    ScratchFolder folder;
    const auto height = ReferenceTerrain::random_hills(3, 40.0, 3.0);
    MemoryRows rows(1400, 60, [&](std::int64_t x, std::int64_t y) {
        return x < 700 || x > 710 ? build::kNoHeight : height(x, y);
    });
    const auto options = options_for({1400, 60, 33, true, 3}, folder.path() / "t.terrain");
    REQUIRE(build::build_from_rows(rows, options));
    const auto store = io::Store::open(options.out);
    REQUIRE_MESSAGE(store, (store ? std::string() : store.error().message));
    CHECK(io::verify_store(*store, [](std::int64_t, std::int64_t) {}));
}

TEST_CASE("builder: meshes hold exactly what the propagated errors and the thresholds ask for") {
    for (const Case& c : kCases) {
        CAPTURE(describe(c));
        const Built built(c);
        const io::Grid& grid = built.store->grid();
        const ReferenceTerrain terrain = reference_of(*built.store, built.rows);
        std::vector<io::ChunkVertex> block;
        for_each_node_with_data(*built.store, [&](io::NodeId node, const io::NodeRecord&) {
            const io::ChunkView chunk = decode(*built.store, node, block);
            const io::LatticePoint origin = grid.origin(node);
            std::set<std::pair<std::int64_t, std::int64_t>> found, expected;
            for (const io::ChunkVertex& v : chunk.vertices()) {
                if (!terrain.in_level(node.level, origin.x + v.x(), origin.y + v.y)) continue;  // of a fan
                found.insert({v.x(), v.y});
                CHECK(v.quanta == terrain.quanta(origin.x + v.x(), origin.y + v.y));
            }
            for (std::int64_t y = 0; y <= grid.extent(node.level); ++y)
                for (std::int64_t x = 0; x <= grid.extent(node.level); ++x)
                    if (terrain.in_level(node.level, origin.x + x, origin.y + y)) expected.insert({x, y});
            CHECK(found == expected);
        });
    }
}

TEST_CASE("builder: the stated error bounds the measured one of the node and of all below it, tightly") {
    for (const Case& c : kCases) {
        CAPTURE(describe(c));
        const Built built(c);
        const io::Grid& grid = built.store->grid();
        std::vector<double> measured(static_cast<std::size_t>(grid.node_count()));
        std::vector<io::ChunkVertex> block;
        for (std::int64_t i = grid.node_count() - 1; i >= 0; --i) {
            const io::NodeId node = grid.node_at(i);
            const io::NodeRecord& record = built.store->record(node);
            if (!record.has_data()) continue;
            double& own = measured[static_cast<std::size_t>(i)];
            own = std::max(own,
                           measured_error(decode(*built.store, node, block), built.rows, grid.origin(node)));
            CHECK(record.error_m >= own * built.store->info().quantum_m);
            CHECK(record.error_m <= (own + 0.01) * built.store->info().quantum_m);
            if (node.level == 0) continue;
            double& parent = measured[static_cast<std::size_t>(grid.linear(node.parent()))];
            parent = std::max(parent, own);
        }
    }
}

TEST_CASE("builder: bounds hold the samples, the mesh in every morph state, and the children's bounds") {
    for (const Case& c : kCases) {
        CAPTURE(describe(c));
        const Built built(c);
        const io::Grid& grid = built.store->grid();
        std::vector<io::ChunkVertex> block;
        for_each_node_with_data(*built.store, [&](io::NodeId node, const io::NodeRecord& record) {
            const auto inside = [&](std::int64_t quanta) {
                return record.min_quanta <= quanta && quanta <= record.max_quanta;
            };
            const io::LatticePoint origin = grid.origin(node);
            bool all = true;
            for (std::int64_t y = origin.y; y <= origin.y + grid.extent(node.level); ++y)
                for (std::int64_t x = origin.x; x <= origin.x + grid.extent(node.level); ++x)
                    all = all && (!built.rows.valid(x, y) || inside(built.rows.sample(x, y)));
            for (const io::ChunkVertex& v : decode(*built.store, node, block).vertices())
                all = all && inside(v.quanta) && inside(std::int64_t{v.quanta} + v.delta);
            if (node.level > 0) {
                const io::NodeRecord& parent = built.store->record(node.parent());
                all = all && parent.min_quanta <= record.min_quanta && parent.max_quanta >= record.max_quanta;
            }
            CHECK(all);
        });
    }
}

TEST_CASE("builder: reliefs lie under what is drawn of a node, over what is drawn of it and below it") {
    for (const Case& c : kCases) {
        CAPTURE(describe(c));
        const Built built(c);
        const io::Grid& grid = built.store->grid();
        std::mt19937 random(c.seed);
        std::vector<std::vector<io::ChunkVertex>> blocks(static_cast<std::size_t>(grid.node_count()));
        for_each_node_with_data(*built.store, [&](io::NodeId node, const io::NodeRecord& record) {
            const auto place = static_cast<std::size_t>(grid.linear(node));
            const io::ChunkView chunk = decode(*built.store, node, blocks[place]);
            const auto extent = static_cast<double>(grid.extent(node.level));
            // What it costs to look at all of them exactly is spent in test_io.
            if (node.level > 0 && random() % 4 != 0) return;
            const auto surface = drawn_triangles(chunk, Morph::random, random);
            const auto segments = segments_of(chunk.relief(), record, extent, grid.quads());
            CHECK(chains_excess(segments, surface) <= 0.01);
            CHECK(chains_excess(segments, drawn_triangles(chunk, Morph::lesser, random)) <= 0.01);
            for (const ChainSegment& segment : segments)
                CHECK(!touches_void(segment, chunk, extent, grid.quads()));
            const io::LatticePoint own = grid.origin(node);
            for (io::NodeId above = node;; above = above.parent()) {
                const io::LatticePoint origin = grid.origin(above);
                const io::NodeRecord& of = built.store->record(above);
                auto& block = blocks[static_cast<std::size_t>(grid.linear(above))];
                const io::ChunkView view(std::as_writable_bytes(std::span(block)), of,
                                         built.store->chunk_shape());
                const Square square{static_cast<double>(own.x - origin.x),
                                    static_cast<double>(own.y - origin.y), extent};
                CHECK(maxima_excess(view.relief(), of, static_cast<double>(grid.extent(above.level)), square,
                                    surface) <= 0.01);
                if (above.level == 0) break;
            }
        });
    }
}

TEST_CASE("builder: stores pass verification and say what is in them") {
    for (const Case& c : kCases) {
        CAPTURE(describe(c));
        const Built built(c);
        const auto verified = io::verify_store(*built.store, [](std::int64_t, std::int64_t) {});
        CHECK_MESSAGE(verified, (verified ? std::string() : verified.error().message));
        std::int64_t invalid = 0;
        for (std::int64_t y = 0; y < c.height; ++y)
            for (std::int64_t x = 0; x < c.width; ++x) invalid += built.rows.valid(x, y) ? 0 : 1;
        const io::TerrainInfo& info = built.store->info();
        CHECK(info.invalid_samples == invalid);
        CHECK(info.triangles > 0);
        CHECK(info.heights_bytes == static_cast<std::int64_t>(built.store->layer(io::Layer::heights).size()));
        CHECK(info.mesh_bytes == static_cast<std::int64_t>(built.store->layer(io::Layer::mesh).size()));
        CHECK(std::is_sorted(info.thresholds_m.rbegin(), info.thresholds_m.rend()));
    }
}

TEST_CASE("builder: the same input gives the same bytes on any number of threads") {
    for (const Case& c : kCases) {
        CAPTURE(describe(c));
        ScratchFolder folder;
        std::map<std::string, std::string> first;
        for (const int jobs : {1, 3, 2}) {
            MemoryRows rows = rows_of(c);
            auto options = options_for(c, folder.path() / ("jobs" + std::to_string(jobs)));
            options.jobs = jobs;
            REQUIRE(build::build_from_rows(rows, options));
            const auto contents = file_contents(options.out);
            CHECK(contents.size() == 4);
            if (first.empty()) first = contents;
            CHECK(contents == first);
        }
    }
}
