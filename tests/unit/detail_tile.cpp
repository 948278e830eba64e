// Ground finer than the source, tile by tile: samples never move, neighbours agree, level ground stays level, whoever makes
// it and whenever; and what calibration makes of grounds whose roughness is known.
#include "ridgeline/detail/detail_tile.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <vector>

#include "ridgeline/detail/calibration.h"
#include "ridgeline/detail/finer_ground.h"
#include "ridgeline/detail/made_range.h"

using namespace ridgeline;
using detail::DetailTile;

namespace {

constexpr int kApron = io::HeightsTile::kApron;
constexpr int kShift = 8;
constexpr io::DetailGains kGains{350, 430, 480, 230};

using Ground = std::function<std::int32_t(int column, int row)>;

io::HeightsTile source_tile(int quads, io::NodeId node, const Ground& ground) {
    io::HeightsTile tile;
    tile.quads = quads;
    for (int row = -kApron; row <= quads + kApron; ++row)
        for (int column = -kApron; column <= quads + kApron; ++column)
            tile.quanta.push_back(ground(node.x * quads + column, node.y * quads + row));
    return tile;
}

DetailTile root(int quads, io::NodeId node, const Ground& ground) {
    DetailTile tile;
    detail::make_root(source_tile(quads, node, ground), node, kShift, tile);
    return tile;
}

// The tile of a place so many octaves down, made from the source's along the way.
DetailTile made(int quads, io::NodeId node, int octaves, const Ground& ground) {
    const io::NodeId source{node.level - octaves, node.x >> octaves, node.y >> octaves};
    DetailTile tile = root(quads, source, ground), child;
    for (int octave = octaves - 1; octave >= 0; --octave) {
        const int quarter = (node.x >> octave & 1) + 2 * (node.y >> octave & 1);
        detail::make_child(tile, quarter, kGains, child);
        std::swap(tile, child);
    }
    return tile;
}

Ground random_ground(std::uint32_t seed, int height) {
    return [seed, height](int column, int row) {
        std::mt19937 random(seed ^ static_cast<std::uint32_t>(column * 7919 + row * 104729));
        const double hills = std::sin(0.21 * column) * std::cos(0.17 * row) * height;
        return static_cast<std::int32_t>(hills) + static_cast<std::int32_t>(random() % 9) - 4;
    };
}

}  // namespace

TEST_CASE("a source's samples never move, octave after octave") {
    const Ground ground = random_ground(1, 300);
    for (const int quads : {32, 64}) {
        for (int octaves = 1; octaves <= 4; ++octaves) {
            const io::NodeId node{5 + octaves, 13, 6};
            const DetailTile tile = made(quads, node, octaves, ground);
            CHECK(tile.node == node);
            CHECK(tile.octave == octaves);
            const int step = 1 << octaves;
            int seen = 0;
            for (int row = -kApron; row <= quads + kApron; ++row)
                for (int column = -kApron; column <= quads + kApron; ++column) {
                    const int x = node.x * quads + column, y = node.y * quads + row;
                    if (x % step != 0 || y % step != 0) continue;
                    ++seen;
                    REQUIRE(tile.height(column, row) == ground(x / step, y / step) * (1 << kShift));
                }
            CHECK(seen > 3);
        }
    }
}

TEST_CASE(
    "all tiles that have a sample have it alike, aprons included, whichever source's tile they come from") {
    const Ground ground = random_ground(2, 500);
    constexpr int kQuads = 32;
    for (int octaves = 1; octaves <= 3; ++octaves) {
        std::map<std::pair<int, int>, std::int32_t> heights;
        std::size_t shared = 0;
        // About the corner of four source tiles.
        const int corner = 4 << octaves;
        for (int y = corner - 2; y < corner + 2; ++y)
            for (int x = corner - 2; x < corner + 2; ++x) {
                const DetailTile tile = made(kQuads, {4 + octaves, x, y}, octaves, ground);
                for (int row = -kApron; row <= kQuads + kApron; ++row)
                    for (int column = -kApron; column <= kQuads + kApron; ++column) {
                        const auto [at, is_new] = heights.insert(
                            {{x * kQuads + column, y * kQuads + row}, tile.height(column, row)});
                        shared += is_new ? 0 : 1;
                        REQUIRE(at->second == tile.height(column, row));
                    }
            }
        CHECK(shared > 1000);
    }
}

TEST_CASE("level ground stays level, and what stands in it keeps its foot within a sample") {
    // A lake with an island and a steep shore.
    const Ground ground = [](int column, int row) {
        const int away = (column - 40) * (column - 40) + (row - 30) * (row - 30);
        if (away < 60) return 400 + column * 3;
        return column > 56 ? 100 + 40 * (column - 56) : 100;
    };
    const auto is_lake = [&](int column, int row) { return ground(column, row) == 100; };
    int level = 0, bumpy = 0;
    for (int octaves = 1; octaves <= 4; ++octaves)
        for (int quarter = 0; quarter < 1 << (2 * octaves); ++quarter) {
            const int x = quarter % (1 << octaves), y = quarter >> octaves;
            const DetailTile tile = made(64, {3 + octaves, x, y}, octaves, ground);
            for (int row = 0; row <= 64; ++row)
                for (int column = 0; column <= 64; ++column) {
                    const int east = x * 64 + column, south = y * 64 + row;
                    const int a = east >> octaves, b = south >> octaves;
                    bool amid_lake = true;
                    for (int i = 0; i < 16; ++i)
                        amid_lake = amid_lake && is_lake(a - 1 + i % 4, b - 1 + i / 4);
                    if (amid_lake) {
                        REQUIRE(tile.height(column, row) == 100 << kShift);
                        ++level;
                    } else {
                        bumpy += tile.height(column, row) != 100 << kShift;
                    }
                }
        }
    CHECK(level > 1000);
    CHECK(bumpy > 1000);
}

TEST_CASE("without gains there are no bumps, and straight slopes stay straight") {
    const Ground plane = [](int column, int row) { return 7 * column - 3 * row; };
    DetailTile tile = root(32, {2, 1, 3}, plane), child;
    for (int octave = 0; octave < 3; ++octave) {
        detail::make_child(tile, 2, {}, child);
        std::swap(tile, child);
    }
    for (int row = 1; row <= 32; ++row)
        for (int column = 1; column <= 32; ++column) {
            CHECK(tile.height(column, row) - tile.height(column - 1, row) == (7 << kShift) / 8);
            CHECK(tile.height(column, row) - tile.height(column, row - 1) == -(3 << kShift) / 8);
        }
}

namespace {

// Ground of a known exponent: spectral sums, the same from every side.
Ground fractal(double exponent, double height) {
    struct Wave {
        double x, y, phase, high;
    };
    std::vector<Wave> waves;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> turn(0.0, 6.283185307179586);
    for (double length = 512.0; length > 1.5; length /= 1.189207115)
        for (int i = 0; i < 4; ++i) {
            const double way = turn(random), k = 6.283185307179586 / length;
            waves.push_back({k * std::cos(way), k * std::sin(way), turn(random),
                             height * std::pow(length / 512.0, exponent)});
        }
    return [waves](int column, int row) {
        double sum = 0.0;
        for (const Wave& wave : waves)
            sum += wave.high * std::sin(wave.x * column + wave.y * row + wave.phase);
        return static_cast<std::int32_t>(std::lround(sum));
    };
}

std::vector<DetailTile> windows_of(const Ground& ground) {
    std::vector<DetailTile> windows;
    for (int i = 0; i < 36; ++i) windows.push_back(root(64, {6, 3 * (i % 6), 3 * (i / 6)}, ground));
    return windows;
}

constexpr detail::CalibrationUnits kUnits{1.0 / (1 << kShift), 1.0};

}  // namespace

TEST_CASE("residuals follow the ground's exponent, and twice as high a ground has twice as large ones") {
    const auto low = detail::calibrate(windows_of(fractal(0.8, 300.0)), kUnits);
    const auto high = detail::calibrate(windows_of(fractal(0.8, 600.0)), kUnits);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(high.face_residual_m[i] == doctest::Approx(2.0 * low.face_residual_m[i]).epsilon(0.02));
        CHECK(high.edge_residual_m[i] == doctest::Approx(2.0 * low.edge_residual_m[i]).epsilon(0.02));
    }
    for (std::size_t i = 0; i < 2; ++i)
        CHECK(std::log2(low.face_residual_m[i + 1] / low.face_residual_m[i]) ==
              doctest::Approx(0.8).epsilon(0.15));
    REQUIRE(low.octaves.size() == io::DetailInfo::kMostOctaves);
    // Gains are worth what slope and roughness are, whatever the height.
    CHECK(high.octaves[0].face_roughness == doctest::Approx(low.octaves[0].face_roughness).epsilon(0.1));
}

TEST_CASE("the ground made below the source is as rough as was foretold, octave by octave") {
    const Ground ground = fractal(0.9, 400.0);
    auto windows = windows_of(ground);
    const auto info = detail::calibrate(windows, kUnits);
    // The octaves' own spacings, as residuals of what was made: each falls from the last as the source's do.
    std::vector<DetailTile> tiles = windows;
    double before = info.face_residual_m[0];
    const double fall = info.face_residual_m[1] / info.face_residual_m[0];
    for (int octave = 0; octave < 3; ++octave) {
        for (DetailTile& tile : tiles) {
            DetailTile child;
            detail::make_child(tile, octave % 4, info.octaves[static_cast<std::size_t>(octave)], child);
            tile = std::move(child);
        }
        const double residual_m = detail::calibrate(tiles, {kUnits.unit_m, 0.0}).face_residual_m[0];
        CAPTURE(octave);
        CHECK(before / residual_m == doctest::Approx(fall).epsilon(0.2));
        before = residual_m;
    }
}

TEST_CASE("a plain has no bumps to foretell, and neither has a terrain without a whole tile") {
    for (const auto& windows : {windows_of([](int, int) { return 12; }), std::vector<DetailTile>()}) {
        const auto info = detail::calibrate(windows, kUnits);
        for (const io::DetailGains& gains : info.octaves) CHECK(gains == io::DetailGains{});
        CHECK(info.face_residual_m[0] == 0.0);
    }
}

namespace {

// The share of a range's margin that is taken up by what is made below a tile, children and all.
double taken_up(const DetailTile& tile, const detail::UnitRange& samples, const detail::UnitRange& range,
                int octaves) {
    const double margin = std::max(1.0, static_cast<double>(samples.least - range.least));
    double share = 0.0;
    for (int row = 0; row <= tile.quads; ++row)
        for (int column = 0; column <= tile.quads; ++column) {
            const std::int64_t height = tile.height(column, row);
            const std::int64_t beside = std::max(samples.least - height, height - samples.most);
            share = std::max(share, static_cast<double>(beside) / margin);
        }
    for (int quarter = 0; quarter < 4 && tile.octave < octaves; ++quarter) {
        DetailTile child;
        detail::make_child(tile, quarter, kGains, child);
        share = std::max(share, taken_up(child, samples, range, octaves));
    }
    return share;
}

}  // namespace

TEST_CASE("what is made below a tile stays within its range, with room to spare") {
    constexpr int kOctaves = 4;
    const std::vector<io::DetailGains> gains(kOctaves, kGains);
    double most = 0.0;
    for (const int height : {0, 3, 60, 900})
        for (std::uint32_t seed = 0; seed < 3; ++seed) {
            const DetailTile tile = root(32, {5, 3, 4}, random_ground(seed, height));
            for (int quarter = 0; quarter < 4; ++quarter) {
                DetailTile child;
                detail::make_child(tile, quarter, kGains, child);
                const detail::UnitRange range = detail::made_range(tile, quarter, gains);
                detail::UnitRange samples{tile.height(16, 16), tile.height(16, 16)};
                for (int row = 0; row <= 32; row += 2)
                    for (int column = 0; column <= 32; column += 2) {
                        samples.least = std::min<std::int64_t>(samples.least, child.height(column, row));
                        samples.most = std::max<std::int64_t>(samples.most, child.height(column, row));
                    }
                most = std::max(most, taken_up(child, samples, range, kOctaves));
            }
        }
    MESSAGE("of the margin, ", most, " at most");
    CHECK(most < 0.4);
    CHECK(most > 0.02);
}

TEST_CASE("units leave room for the range, and are as fine as the spacing asks for") {
    io::TerrainInfo info;
    info.spacing_x_m = info.spacing_y_m = 20.0;
    info.quantum_m = 1.0;
    info.min_height_m = 0.0;
    info.max_height_m = 3900.0;
    CHECK(detail::detail_shift(info) == 10);
    info.quantum_m = 1.0 / 32.0;
    CHECK(detail::detail_shift(info) == 5);
    info.min_height_m = -11000.0;
    info.spacing_x_m = 0.5;
    // 352 000 quanta take 19 bits.
    CHECK(detail::detail_shift(info) == 7);
    info.quantum_m = 1e-6;
    CHECK(detail::detail_shift(info) == 0);
}

TEST_CASE("The lattice with made octaves has the source's nodes where the source has them") {
    std::mt19937 random(12);
    for (int trial = 0; trial < 200; ++trial) {
        const auto width = static_cast<std::int64_t>(2 + random() % 3000);
        const auto height = static_cast<std::int64_t>(2 + random() % 3000);
        const io::Grid source(width, height, 32 << random() % 3);
        const int octaves = static_cast<int>(random() % 9);
        if (source.levels() + octaves > io::Grid::kMaxLevels) continue;
        const io::Grid finer = source.finer(octaves);
        REQUIRE(finer.levels() == source.levels() + octaves);
        for (int level = 0; level < source.levels(); ++level) {
            CHECK(finer.nodes_x(level) == source.nodes_x(level));
            CHECK(finer.nodes_y(level) == source.nodes_y(level));
            CHECK(finer.first(level) == source.first(level));
            CHECK(finer.step(level) == source.step(level) << octaves);
        }
    }
}

TEST_CASE("There are as many octaves as a store foretells, and a lattice has room for") {
    io::TerrainInfo info;
    info.width = info.height = 8193;
    CHECK(detail::most_octaves(info) == 0);
    info.detail = io::DetailInfo{.octaves = std::vector<io::DetailGains>(8, kGains)};
    CHECK(detail::most_octaves(info) == 8);
    info.width = 16385;
    CHECK(detail::most_octaves(info) == 7);
    info.detail->octaves.resize(3);
    CHECK(detail::most_octaves(info) == 3);
    const auto ground = detail::finer_ground(info, 2, 0.5);
    CHECK(ground.octaves() == 2);
    CHECK(ground.gains[1] == io::DetailGains{175, 215, 240, 115});
    CHECK(detail::finer_ground(info, 1, 0.0).gains[0] == io::DetailGains{});
    // What is multiplied stays within the bits that the passes have for it.
    info.detail->octaves[0] = {8191, 8191, 8191, 8191};
    CHECK(detail::finer_ground(info, 1, 4.0).gains[0] == info.detail->octaves[0]);
}
