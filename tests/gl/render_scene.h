// A small terrain on disk, its stage, and pictures of it: what the renderer's tests share.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>

#include "ridgeline/app/walk/stage.h"
#include "ridgeline/gl/screenshot.h"
#include "ridgeline/io/store.h"
#include "ridgeline/jobs/job_system.h"
#include "support/gl_context.h"
#include "support/small_store.h"

namespace ridgeline::test {

// Ridges and a few spikes, so that levels differ everywhere. Whole quanta, one metre each.
inline std::int32_t rugged_quanta(std::int64_t x, std::int64_t y) {
    const double u = static_cast<double>(x), v = static_cast<double>(y);
    const double ridges = 22.0 * std::abs(std::sin(u * 0.031 + 0.7 * std::sin(v * 0.023))) +
                          14.0 * std::abs(std::sin(v * 0.047 + u * 0.011)) +
                          5.0 * std::sin(u * 0.21) * std::sin(v * 0.17);
    const double spikes = (x * 7919 + y * 104729) % 97 == 0 ? 6.0 : 0.0;
    return static_cast<std::int32_t>(std::lround(ridges + spikes));
}

struct SceneOptions {
    std::int64_t width = 257, height = 257;
    int quads = 32;
    std::int32_t (*quanta)(std::int64_t x, std::int64_t y) = rugged_quanta;
    // Called with the store's folder before it is opened; may be empty.
    std::function<void(const std::filesystem::path&)> finish_store{};
    app::StageOptions stage;
};

class RenderScene {
  public:
    explicit RenderScene(const SceneOptions& options)
        : terrain_(io::Grid(options.width, options.height, options.quads), options.quanta),
          store_files_(terrain_) {
        if (options.finish_store) options.finish_store(store_files_.directory());
        auto store = io::Store::open(store_files_.directory());
        REQUIRE_MESSAGE(store.ok(), (store.ok() ? "" : store.error().message));
        store_ = std::make_unique<io::Store>(std::move(store).value());
        open(options.stage);
    }

    // Another stage on the same store.
    void open(const app::StageOptions& options) {
        stage_.reset();
        auto stage = app::TerrainStage::create(*store_, jobs_, options);
        REQUIRE_MESSAGE(stage.ok(), (stage.ok() ? "" : stage.error().message));
        stage_ = std::move(stage).value();
    }

    const io::Store& store() const { return *store_; }
    const io::TerrainInfo& info() const { return store_->info(); }
    app::TerrainStage& stage() { return *stage_; }
    const ReferenceTerrain& terrain() const { return terrain_; }

    // In samples from the north-western corner, and metres over the sea.
    glm::dvec3 place(double column, double row, double height_m) const {
        return {info().world(column, row), height_m};
    }
    double surface_m(double column, double row) const {
        return terrain_.quanta(std::lround(column), std::lround(row));
    }

  private:
    ReferenceTerrain terrain_;
    SmallStore store_files_;
    std::unique_ptr<io::Store> store_;
    jobs::JobSystem jobs_{{.workers = 1}};
    std::unique_ptr<app::TerrainStage> stage_;
};

}  // namespace ridgeline::test
