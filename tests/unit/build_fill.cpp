// The fill under nodata: a function of position alone, within what surrounds it, without walls.
#include <doctest/doctest.h>

#include "build_fixture.h"
#include "ridgeline/build/block_window.h"
#include "ridgeline/build/scratch_raster.h"

using namespace ridgeline;
using namespace ridgeline::test;
using namespace ridgeline::build;

namespace {

// A raster filled block by block; every window's exact part is compared with the others'.
struct Filled {
    Filled(std::int64_t width, std::int64_t height, const MemoryRows::Height& sample)
        : rows(width, height, sample),
          grid(width, height, 64),
          blocks(grid),
          quanta(static_cast<std::size_t>(width * height), kNoHeight) {
        ScratchFolder folder;
        auto raster = ScratchRaster::create(folder.path() / "samples", width, height);
        REQUIRE(raster);
        std::vector<std::int32_t> all(quanta.size());
        REQUIRE(rows.read(0, height, all));
        REQUIRE(raster->append(all));
        VoidFill fill(grid);
        BlockWindow window;
        std::vector<std::int32_t> packed(static_cast<std::size_t>(kWindow) * kWindow);
        const auto load = [&](std::int64_t block) {
            REQUIRE(raster->read_window(blocks.origin(block), packed));
            window.unpack(grid, blocks.origin(block), packed);
        };
        for (std::int64_t block = 0; block < blocks.count(); ++block) {
            load(block);
            window.set_means(blocks, block, fill);
        }
        fill.finish();
        for (std::int64_t block = 0; block < blocks.count(); ++block) {
            load(block);
            if (window.has_voids()) window.fill(fill);
            compare(blocks.origin(block), window);
        }
    }

    void compare(io::LatticePoint origin, const BlockWindow& window) {
        constexpr std::int64_t kExact = kWindowApron - 8;
        for (std::int64_t row = -kExact; row <= kBlock + kExact; ++row)
            for (std::int64_t column = -kExact; column <= kBlock + kExact; ++column) {
                const std::int64_t x = origin.x + column, y = origin.y + row;
                if (x < 0 || y < 0 || x >= grid.width() || y >= grid.height()) continue;
                std::int32_t& known = quanta[static_cast<std::size_t>(y * grid.width() + x)];
                const std::int32_t found = window.quanta()[BlockWindow::at(column, row)];
                disagreements += known != kNoHeight && known != found;
                changed += rows.valid(x, y) && rows.sample(x, y) != found;
                known = found;
            }
    }
    std::int32_t at(std::int64_t x, std::int64_t y) const {
        return quanta[static_cast<std::size_t>(y * grid.width() + x)];
    }
    // The greatest step between neighbours.
    std::int32_t steepest() const {
        std::int32_t most = 0;
        for (std::int64_t y = 1; y < grid.height(); ++y)
            for (std::int64_t x = 1; x < grid.width(); ++x)
                most = std::max({most, std::abs(at(x, y) - at(x - 1, y)), std::abs(at(x, y) - at(x, y - 1))});
        return most;
    }

    MemoryRows rows;
    io::Grid grid;
    BlockGrid blocks;
    std::vector<std::int32_t> quanta;
    std::int64_t disagreements = 0, changed = 0;
};

}  // namespace

TEST_CASE("fill: windows agree on every sample, and valid samples stay") {
    for (const Case& c : kCases) {
        CAPTURE(c.width);
        const MemoryRows rows = rows_of(c);
        const Filled filled(c.width, c.height,
                            [&](std::int64_t x, std::int64_t y) { return rows.sample(x, y); });
        CHECK(filled.disagreements == 0);
        CHECK(filled.changed == 0);
    }
}

TEST_CASE("fill: stays between the least and the greatest height, even where little is valid") {
    for (const std::int64_t island : {0, 300, 899}) {
        const Filled filled(900, 620, [&](std::int64_t x, std::int64_t y) {
            const bool valid = std::abs(x - island) < 3 && std::abs(y - 300) < 5;
            return valid ? static_cast<std::int32_t>(1000 + x + 7 * y) : kNoHeight;
        });
        const auto [least, greatest] = std::minmax_element(filled.quanta.begin(), filled.quanta.end());
        CHECK(*least >= 1000 + island - 2 + 7 * 296);
        CHECK(*greatest <= 1000 + island + 2 + 7 * 304);
    }
}

TEST_CASE("fill: no wall stands in or around a hole in a slope, whatever the hole's size") {
    for (const std::int64_t radius : {1, 4, 13, 60, 200}) {
        CAPTURE(radius);
        constexpr std::int32_t kSlope = 20;
        const Filled filled(1100, 700, [&](std::int64_t x, std::int64_t y) {
            const std::int64_t dx = x - 530, dy = y - 350;
            return dx * dx + dy * dy < radius * radius ? kNoHeight : static_cast<std::int32_t>(kSlope * x);
        });
        // A level floor under the hole would leave a wall of kSlope * radius.
        CHECK(filled.steepest() <= 4 * kSlope);
    }
}
