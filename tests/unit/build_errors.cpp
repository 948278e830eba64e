// Errors and levels of vertices, block by block, against the slow global reference.
#include <doctest/doctest.h>

#include <random>

#include "build_fixture.h"
#include "ridgeline/build/block_levels.h"
#include "ridgeline/build/block_window.h"
#include "ridgeline/build/coarse_lattice.h"
#include "ridgeline/build/scratch_raster.h"
#include "ridgeline/build/thresholds.h"
#include "ridgeline/build/vertex_errors.h"

using namespace ridgeline;
using namespace ridgeline::test;
using namespace ridgeline::build;

namespace {

// All blocks of a raster, prepared as the builder does.
struct Blocks {
    explicit Blocks(const Case& c)
        : rows(rows_of(c)),
          grid(c.width, c.height, c.tile - 1),
          blocks(grid),
          metric(c.metric, rows.info()),
          lattice(grid, metric),
          fill(grid) {
        auto created = ScratchRaster::create(folder.path() / "samples", c.width, c.height);
        REQUIRE(created);
        raster.emplace(std::move(*created));
        std::vector<std::int32_t> row(static_cast<std::size_t>(c.width));
        for (std::int64_t y = 0; y < c.height; ++y) {
            REQUIRE(rows.read(y, 1, row));
            REQUIRE(raster->append(row));
        }
        BlockWindow window;
        for (std::int64_t block = 0; block < blocks.count(); ++block) {
            window.unpack(grid, blocks.origin(block), packed(block));
            window.set_means(blocks, block, fill);
        }
        fill.finish();
        VertexErrors errors;
        for (std::int64_t block = 0; block < blocks.count(); ++block) {
            prepare(block, window, errors);
            lattice.hand_up(blocks, block, window, errors);
        }
        lattice.finish();
    }

    std::vector<std::int32_t> packed(std::int64_t block) const {
        std::vector<std::int32_t> samples(static_cast<std::size_t>(kWindow) * kWindow, -1);
        REQUIRE(raster->read_window(blocks.origin(block), samples));
        return samples;
    }
    void prepare(std::int64_t block, BlockWindow& window, VertexErrors& errors) const {
        window.unpack(grid, blocks.origin(block), packed(block));
        if (window.has_voids()) window.fill(fill);
        window.pad();
        find_vertex_errors(window.quanta(), window.flags(), metric, errors);
    }
    // The reference over the heights of the blocks' windows, fill included.
    ReferenceTerrain reference() const {
        std::vector<BlockWindow> windows(static_cast<std::size_t>(blocks.count()));
        VertexErrors errors;
        for (std::int64_t block = 0; block < blocks.count(); ++block)
            prepare(block, windows[static_cast<std::size_t>(block)], errors);
        const auto height = [&](std::int64_t x, std::int64_t y) {
            const std::int64_t block = blocks.block_of({x, y});
            const io::LatticePoint origin = blocks.origin(block);
            return windows[static_cast<std::size_t>(block)]
                .quanta()[BlockWindow::at(x - origin.x, y - origin.y)];
        };
        const auto valid = [this](std::int64_t x, std::int64_t y) { return rows.valid(x, y); };
        ReferenceTerrain terrain(grid, height, valid);
        join_cones(terrain, metric, valid);
        return terrain;
    }

    ScratchFolder folder;
    MemoryRows rows;
    io::Grid grid;
    BlockGrid blocks;
    VertexMetric metric;
    std::optional<ScratchRaster> raster;
    CoarseLattice lattice;
    VoidFill fill;
};

std::uint8_t code_of(std::int64_t half_quanta) {
    return error_code(0, static_cast<std::int32_t>(half_quanta), 0);
}

// Of the vertical error and the cone together.
std::uint8_t code_of(const ReferenceTerrain& reference, std::int64_t x, std::int64_t y) {
    return std::max(code_of(reference.error(x, y)), reference.joined_code(x, y));
}

std::uint8_t fine_code(const VertexErrors& errors, std::int64_t column, std::int64_t row) {
    const VertexKind kind = vertex_kind(column, row);
    const Phases<std::uint8_t>& codes = errors.codes[kind.scale];
    const int offset = first_cell(kind.scale);
    const std::size_t at = codes.at(static_cast<int>(column >> (kind.scale + 1)) + offset,
                                    static_cast<int>(row >> (kind.scale + 1)) + offset);
    if (kind.centre) return codes.centre[at];
    return (column >> kind.scale & 1) != 0 ? codes.x[at] : codes.y[at];
}

}  // namespace

TEST_CASE(
    "error codes: monotone, exact for small errors, within an eighth above, and turned back into bounds") {
    std::mt19937 random(1);
    std::uint8_t last = 0;
    for (std::int32_t doubled = 0; doubled < 5000; ++doubled) {
        const std::uint8_t code = code_of(doubled);
        CHECK(code >= last);
        last = code;
        CHECK(2.0 * largest_error(code) >= doubled);
        CHECK(2.0 * largest_error(code) <= doubled * 1.125);
        CHECK((code == 0) == (doubled == 0));
    }
    for (int i = 0; i < 10000; ++i) {
        const auto doubled = static_cast<std::int32_t>(random() >> (1 + random() % 30));
        const double bound = 2.0 * largest_error(code_of(doubled));
        // Codes are made of floats, which round to nearest.
        CHECK(bound >= doubled * (1.0 - 1e-7));
        CHECK(bound <= doubled * 1.125 + 1.0);
        if (doubled < 1 << 24) CHECK(bound >= doubled);
    }
}

TEST_CASE("vertex errors: equal to the slow global propagation, across blocks, voids and the raster's end") {
    for (const Case& c : kCases) {
        CAPTURE(c.width);
        const Blocks built(c);
        const ReferenceTerrain reference = built.reference();
        BlockWindow window;
        VertexErrors errors;
        std::int64_t wrong = 0;
        for (std::int64_t block = 0; block < built.blocks.count(); ++block) {
            built.prepare(block, window, errors);
            const io::LatticePoint origin = built.blocks.origin(block);
            for (std::int64_t row = 0; row <= kBlock; ++row)
                for (std::int64_t column = 0; column <= kBlock; ++column) {
                    const std::int64_t x = origin.x + column, y = origin.y + row;
                    if (vertex_kind(x, y).scale >= kFineScales || !reference.contains(x, y)) continue;
                    wrong += fine_code(errors, column, row) != code_of(reference, x, y);
                }
        }
        CHECK(wrong == 0);
        for (std::int64_t y = 0; reference.contains(0, y); y += 8)
            for (std::int64_t x = 0; reference.contains(x, y); x += 8) {
                if (vertex_kind(x, y).scale >= vertex_kind(built.grid.extent(0), 0).scale) continue;
                wrong += built.lattice.code(x, y) != code_of(reference, x, y);
            }
        CHECK(wrong == 0);
    }
}

TEST_CASE("levels: closed under ancestry, nested, and the same for every block that holds the vertex") {
    for (const Case& c : kCases) {
        CAPTURE(c.width);
        const Blocks built(c);
        std::vector<std::uint8_t> thresholds;
        for (int level = 0; level < built.grid.levels(); ++level)
            thresholds.push_back(static_cast<std::uint8_t>(9 * (built.grid.finest() - level)));
        const Levels levels(built.grid, thresholds);
        const std::int64_t columns = built.blocks.columns() * kBlock + 1,
                           count = columns * (built.blocks.rows() * kBlock + 1);
        std::vector<std::uint8_t> level_of(static_cast<std::size_t>(count), 255);
        BlockWindow window;
        VertexErrors errors;
        BlockLevels block_levels;
        std::int64_t disagreements = 0, orphans = 0;
        for (std::int64_t block = 0; block < built.blocks.count(); ++block) {
            built.prepare(block, window, errors);
            const io::LatticePoint origin = built.blocks.origin(block);
            block_levels.find(errors, built.lattice, levels, origin);
            for (std::int64_t row = 0; row <= kBlock; ++row)
                for (std::int64_t column = 0; column <= kBlock; ++column) {
                    std::uint8_t& level =
                        level_of[static_cast<std::size_t>((origin.y + row) * columns + origin.x + column)];
                    const std::uint8_t found = block_levels.at(column, row);
                    disagreements += level != 255 && level != found;
                    level = found;
                }
        }
        CHECK(disagreements == 0);
        // A vertex needs the two ends of its hypotenuse and the two corners opposite; over the blocks' area.
        const auto needs = [&](std::uint8_t level, std::int64_t x, std::int64_t y) {
            if (x < 0 || y < 0 || x >= columns || y * columns + x >= count) return;
            orphans += level_of[static_cast<std::size_t>(y * columns + x)] > level;
        };
        for (std::int64_t i = 0; i < count; ++i) {
            const std::int64_t x = i % columns, y = i / columns;
            const std::uint8_t level = level_of[static_cast<std::size_t>(i)];
            const VertexKind kind = vertex_kind(x, y);
            const std::int64_t s = std::int64_t{1} << kind.scale;
            if (level >= levels.levels() || s >= built.grid.extent(0)) continue;
            const auto [a, b] = ReferenceTerrain::ends(x, y);
            needs(level, a.x, a.y);
            needs(level, b.x, b.y);
            // The corners beside the hypotenuse: a centre's are the other two of its square, an edge vertex's
            // the centres of its scale.
            const bool across = !kind.centre && (x >> kind.scale & 1) == 0;
            const std::int64_t dx = kind.centre ? a.x - x
                                    : across    ? s
                                                : 0,
                               dy = kind.centre ? y - a.y
                                    : across    ? 0
                                                : s;
            needs(level, x + dx, y + dy);
            needs(level, x - dx, y - dy);
        }
        CHECK(orphans == 0);
    }
}

TEST_CASE(
    "thresholds: no level exceeds the mean or the most allowed where a coarser code would do, never "
    "increasing") {
    for (const Case& c : kCases) {
        CAPTURE(c.width);
        const Blocks built(c);
        const VertexBudget budget{300, 700};
        Thresholds thresholds(built.grid, built.blocks, budget);
        BlockCounts counts(built.grid, built.blocks);
        BlockWindow window;
        VertexErrors errors;
        for (std::int64_t block = 0; block < built.blocks.count(); ++block) {
            built.prepare(block, window, errors);
            counts.clear();
            counts.add_fine(errors);
            counts.finish();
            thresholds.add(block, Thresholds::Part::fine, counts);
            counts.clear();
            counts.add_coarse(built.lattice, built.blocks.origin(block));
            counts.finish();
            thresholds.add(block, Thresholds::Part::coarse, counts);
        }
        std::vector<std::int64_t> nodes;
        for (int level = 0; level < built.grid.levels(); ++level)
            nodes.push_back(std::int64_t{built.grid.nodes_x(level)} * built.grid.nodes_y(level));
        const auto chosen = thresholds.choose(nodes);
        CHECK(std::is_sorted(chosen.rbegin(), chosen.rend()));
        const ReferenceTerrain reference = built.reference();
        for (int level = 0; level < built.grid.levels(); ++level) {
            std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> by_node;
            std::int64_t sum = 0, most = 0;
            for (std::int64_t y = 0; y < built.blocks.rows() * kBlock && reference.contains(0, y); ++y)
                for (std::int64_t x = 0; x < built.blocks.columns() * kBlock && reference.contains(x, y);
                     ++x) {
                    if (vertex_kind(x, y).scale >= vertex_kind(built.grid.extent(0), 0).scale) continue;
                    if (code_of(reference, x, y) <= chosen[static_cast<std::size_t>(level)]) continue;
                    const std::int64_t extent = built.grid.extent(level);
                    most = std::max(most, ++by_node[{x / extent, y / extent}]);
                    ++sum;
                }
            CHECK(sum <= budget.mean * nodes[static_cast<std::size_t>(level)]);
            CHECK(most <= budget.most);
        }
    }
}
