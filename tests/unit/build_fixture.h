// Terrains for the builder's tests: rasters in memory, folders that go with their object, stores read back
// whole.
#pragma once

#include <doctest/doctest.h>
#include <unistd.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "ridgeline/build/error_code.h"
#include "ridgeline/build/row_builder.h"
#include "ridgeline/build/vertex_metric.h"
#include "ridgeline/io/store.h"
#include "support/reference_terrain.h"

namespace ridgeline::test {

class ScratchFolder {
  public:
    ScratchFolder() {
        static int number = 0;
        path_ = std::filesystem::temp_directory_path() /
                ("ridgeline-build-" + std::to_string(::getpid()) + "-" + std::to_string(number++));
        std::filesystem::create_directories(path_);
    }
    ~ScratchFolder() { std::filesystem::remove_all(path_); }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    // Names of what lies in it.
    std::vector<std::string> entries() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(path_))
            names.push_back(entry.path().filename());
        std::sort(names.begin(), names.end());
        return names;
    }

  private:
    std::filesystem::path path_;
};

class MemoryRows final : public build::HeightRows {
  public:
    using Height = std::function<std::int32_t(std::int64_t x, std::int64_t y)>;

    MemoryRows(std::int64_t width, std::int64_t height, const Height& sample) {
        info_.width = width;
        info_.height = height;
        info_.spacing_x_m = 6.0;
        info_.spacing_y_m = 8.0;
        info_.quantum_m = 0.5;
        info_.height_offset_m = 10.0;
        info_.sources = {"memory"};
        for (std::int64_t y = 0; y < height; ++y)
            for (std::int64_t x = 0; x < width; ++x) samples_.push_back(sample(x, y));
    }

    const io::TerrainInfo& info() const override { return info_; }
    bool may_have_nodata() const override { return true; }
    std::int64_t natural_rows() const override { return 7; }
    Result<void> read(std::int64_t row, std::int64_t rows, std::span<std::int32_t> quanta) override {
        if (on_read) RIDGELINE_TRY(on_read(row));
        std::copy_n(samples_.begin() + row * info_.width, rows * info_.width, quanta.begin());
        return {};
    }
    std::vector<std::string> findings() const override { return {}; }

    std::int32_t sample(std::int64_t x, std::int64_t y) const {
        return samples_[static_cast<std::size_t>(y * info_.width + x)];
    }
    // A lattice point within the raster that has a height.
    bool valid(std::int64_t x, std::int64_t y) const {
        return x >= 0 && y >= 0 && x < info_.width && y < info_.height && sample(x, y) != build::kNoHeight;
    }
    // A finest cell, by its north-western corner.
    bool cell_valid(std::int64_t x, std::int64_t y) const {
        return valid(x, y) && valid(x + 1, y) && valid(x, y + 1) && valid(x + 1, y + 1);
    }

    std::function<Result<void>(std::int64_t row)> on_read;

  private:
    io::TerrainInfo info_;
    std::vector<std::int32_t> samples_;
};

// Discs and stripes without heights, at borders and inside, down to single samples.
inline MemoryRows::Height with_voids(MemoryRows::Height height, std::int64_t width, std::uint32_t seed) {
    return [height = std::move(height), width, seed](std::int64_t x, std::int64_t y) {
        const auto cell = static_cast<std::uint32_t>(x / 61 * 7919 + y / 53 * 104729) + seed;
        const std::int64_t dx = x % 61 - 30, dy = y % 53 - 26;
        const bool in_disc =
            cell * 2654435761u >> 30 == 0 && dx * dx + dy * dy < static_cast<std::int64_t>(cell % 600);
        const bool void_here = in_disc || x - y > width - 20 || (x * 31 + y * 17) % 1009 == 0;
        return void_here ? build::kNoHeight : height(x, y);
    };
}

struct Case {
    std::int64_t width, height;
    int tile;
    bool voids;
    std::uint32_t seed;
    build::Metric metric = build::Metric::cone;
};
// Odd sizes, several blocks and roots, nodes larger than blocks, rasters of two rows.
inline const std::vector<Case> kCases = {
    {2, 2, 33, false, 1},     {2, 301, 33, true, 2, build::Metric::geometric},     {140, 77, 65, false, 3},
    {513, 513, 33, true, 4},  {1025, 600, 65, false, 5, build::Metric::geometric}, {1030, 590, 65, false, 8},
    {701, 1100, 33, true, 6}, {1500, 140, 129, true, 7, build::Metric::geometric}};

inline MemoryRows rows_of(const Case& c) {
    auto height = ReferenceTerrain::random_hills(c.seed, 60.0, 7.0);
    return MemoryRows(c.width, c.height, c.voids ? with_voids(height, c.width, c.seed) : height);
}

inline build::BuildOptions options_for(const Case& c, const std::filesystem::path& out) {
    build::BuildOptions options;
    options.out = out;
    options.metric = c.metric;
    options.tile = c.tile;
    options.jobs = 3;
    return options;
}

// Joins the cones of a metric, vertex by vertex.
inline void join_cones(ReferenceTerrain& terrain, const build::VertexMetric& metric,
                       const ReferenceTerrain::Valid& valid) {
    if (!metric.has_cones()) return;
    terrain.join([&](std::int64_t x, std::int64_t y, std::int64_t s) {
        const build::ConeScale& cones = metric.cones(std::countr_zero(static_cast<std::uint64_t>(s)));
        for (const std::int64_t dy : {-s, std::int64_t{0}, s})
            for (const std::int64_t dx : {-s, std::int64_t{0}, s})
                if (!valid(x + dx, y + dy)) return std::uint8_t{0};
        const auto face = [&](std::int64_t west, std::int64_t north) {
            return build::face_of(terrain.quanta(west, north), terrain.quanta(west + s, north),
                                  terrain.quanta(west, north + s), terrain.quanta(west + s, north + s),
                                  cones);
        };
        const float square =
            build::squared_chord(face(x - s, y - s), face(x, y - s), face(x - s, y), face(x, y));
        return build::error_code_of_square(cones.height_squared * square);
    });
}

// The code whose bound this is, in quanta.
inline std::uint8_t code_below(double bound) {
    std::uint8_t code = 0;
    while (code < 255 && build::largest_error_of_square(code) < bound * (1.0 - 1e-12)) ++code;
    return code;
}

// The slow terrain with the heights that a store has at its finest level, fill included, and the store's
// thresholds.
inline ReferenceTerrain reference_of(const io::Store& store, const MemoryRows& rows) {
    const io::Grid& grid = store.grid();
    std::map<std::int64_t, io::HeightsTile> tiles;
    std::vector<std::uint8_t> bytes;
    const auto height = [&](std::int64_t x, std::int64_t y) {
        const auto column = static_cast<std::int32_t>(
            std::min<std::int64_t>(x / grid.quads(), grid.nodes_x(grid.finest()) - 1));
        const auto row = static_cast<std::int32_t>(
            std::min<std::int64_t>(y / grid.quads(), grid.nodes_y(grid.finest()) - 1));
        const io::NodeId node{grid.finest(), column, row};
        io::HeightsTile& tile = tiles[grid.linear(node)];
        if (tile.quanta.empty()) REQUIRE(store.read_heights(node, bytes, tile));
        const io::LatticePoint origin = grid.origin(node);
        return tile.quanta[tile.at(static_cast<int>(x - origin.x), static_cast<int>(y - origin.y))];
    };
    ReferenceTerrain terrain(grid, height,
                             [&rows](std::int64_t x, std::int64_t y) { return rows.valid(x, y); });
    for (int level = 0; level < grid.levels(); ++level) {
        const double halves =
            2.0 * store.info().thresholds_m[static_cast<std::size_t>(level)] / store.info().quantum_m;
        terrain.set_threshold(level, static_cast<std::int64_t>(halves));
        if (store.info().metric == "cone")
            terrain.set_joined_threshold(
                level, code_below(store.info().cone_thresholds_m[static_cast<std::size_t>(level)] /
                                  store.info().quantum_m));
    }
    const auto metric = store.info().metric == "cone" ? build::Metric::cone : build::Metric::geometric;
    join_cones(terrain, build::VertexMetric(metric, store.info()),
               [&rows](std::int64_t x, std::int64_t y) { return rows.valid(x, y); });
    return terrain;
}

inline std::map<std::string, std::string> file_contents(const std::filesystem::path& folder) {
    std::map<std::string, std::string> contents;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::ifstream file(entry.path(), std::ios::binary);
        contents[entry.path().filename()] = std::string(std::istreambuf_iterator<char>(file), {});
    }
    return contents;
}

}  // namespace ridgeline::test
