// A scene as a store in a directory of its own, with some samples invalid, that foretells made ground; the directory goes
// with the object.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ridgeline/io/store.h"
#include "ridgeline/io/store_writer.h"
#include "support/small_store.h"
#include "unit/select_scene.h"

namespace ridgeline::test {

class StoredScene {
  public:
    StoredScene(const SceneShape& shape, double invalid_share) : scene(shape), directory_(fresh_directory()) {
        choose_valid(shape.seed, invalid_share);
        auto writer = io::StoreWriter::create(path(), io::Replace::never);
        REQUIRE(writer.ok());
        writer->begin(scene.grid());
        std::copy(scene.records().begin(), scene.records().end(), writer->records().begin());
        for (std::int64_t i = 0; i < scene.grid().node_count(); ++i) put(*writer, scene.grid().node_at(i));
        const auto written = writer->finish(info());
        REQUIRE_MESSAGE(written.ok(), (written ? "" : written.error().message));
    }
    ~StoredScene() { std::filesystem::remove_all(directory_); }

    std::filesystem::path path() const { return directory_ / "scene.terrain"; }
    io::Store open() const {
        auto store = io::Store::open(path());
        REQUIRE_MESSAGE(store.ok(), (store ? "" : store.error().message));
        return std::move(store).value();
    }
    bool valid(std::int64_t x, std::int64_t y) const {
        return valid_[static_cast<std::size_t>(y * scene.info().width + x)] != 0;
    }
    // Bilinear, by looking at the four samples; empty where one that matters is invalid.
    std::optional<double> reference(double column, double row) const {
        const auto x = static_cast<std::int64_t>(column), y = static_cast<std::int64_t>(row);
        const double u = column - static_cast<double>(x), v = row - static_cast<double>(y);
        double quanta = 0.0;
        for (int i = 0; i < 4; ++i) {
            const double weight = ((i & 1) != 0 ? u : 1.0 - u) * ((i & 2) != 0 ? v : 1.0 - v);
            if (weight == 0.0) continue;
            if (!valid(x + (i & 1), y + (i >> 1))) return {};
            quanta += weight * scene.quanta(x + (i & 1), y + (i >> 1));
        }
        return scene.info().height_m(quanta);
    }

    Scene scene;

  private:
    io::TerrainInfo info() const {
        io::TerrainInfo info = scene.info();
        info.detail = SmallStore::detail();
        info.invalid_samples = std::ranges::count(valid_, std::uint8_t{0});
        return info;
    }
    static std::filesystem::path fresh_directory() {
        std::string name = (std::filesystem::temp_directory_path() / "ridgeline-select-XXXXXX").string();
        REQUIRE(mkdtemp(name.data()) != nullptr);
        return name;
    }
    // None where no node has data.
    void choose_valid(std::uint64_t seed, double invalid_share) {
        Random random(seed);
        for (std::int64_t y = 0; y < scene.info().height; ++y)
            for (std::int64_t x = 0; x < scene.info().width; ++x)
                valid_.push_back(uniform(random, 0.0, 1.0) >= invalid_share && has_node(x, y) ? 1 : 0);
    }
    bool has_node(std::int64_t x, std::int64_t y) const {
        const io::Grid& grid = scene.grid();
        for (const std::int64_t column : {x, x - 1})
            for (const std::int64_t row : {y, y - 1}) {
                const io::NodeId node{grid.finest(), static_cast<std::int32_t>(column / grid.quads()),
                                      static_cast<std::int32_t>(row / grid.quads())};
                if (column >= 0 && row >= 0 && grid.contains(node) &&
                    scene.records()[static_cast<std::size_t>(grid.linear(node))].has_data())
                    return true;
            }
        return false;
    }
    void put(io::StoreWriter& writer, io::NodeId node) const {
        const auto index = static_cast<select::NodeIndex>(scene.grid().linear(node));
        if (!scene.records()[index].has_data()) return;
        std::vector<std::uint8_t> payload;
        io::encode_heights(heights_of(node), payload);
        REQUIRE(writer.put(io::Layer::heights, node, payload).ok());
        REQUIRE(writer.put(io::Layer::mesh, node, scene.payload(index)).ok());
    }
    io::HeightsTile heights_of(io::NodeId node) const {
        const io::LatticePoint origin = scene.grid().origin(node);
        const std::int64_t step = scene.grid().step(node.level);
        const int quads = scene.grid().quads(), apron = io::HeightsTile::kApron;
        io::HeightsTile tile = scene.heights_tile(node);
        tile.sample_valid.resize(tile.quanta.size());
        tile.cell_valid.assign(static_cast<std::size_t>(quads) * static_cast<std::size_t>(quads), 1);
        for (int row = -apron; row <= quads + apron; ++row)
            for (int column = -apron; column <= quads + apron; ++column) {
                const std::int64_t x = origin.x + column * step, y = origin.y + row * step;
                const bool inside = x >= 0 && y >= 0 && x < scene.info().width && y < scene.info().height;
                tile.sample_valid[tile.at(column, row)] = inside && valid(x, y) ? 1 : 0;
            }
        tile.all_valid = false;
        return tile;
    }

    std::filesystem::path directory_;
    std::vector<std::uint8_t> valid_;
};

}  // namespace ridgeline::test
