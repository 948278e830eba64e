#include "ridgeline/app/bench/scheduling_clipmaps.h"

#include <algorithm>
#include <cmath>

#include "ridgeline/app/walk/stage.h"
#include "ridgeline/io/chunk.h"
#include "ridgeline/io/imagery_tile.h"

namespace ridgeline::app {
namespace {

constexpr ClipmapFormat kBc1{.block_texels = 4, .block_bytes = sizeof(io::Bc1Block)};
constexpr ClipmapFormat kRgb8{.block_texels = 1, .block_bytes = 3};
constexpr ClipmapFormat kVertexAndNormal{
    .block_texels = 1, .block_bytes = static_cast<int>(sizeof(io::ChunkVertex) + sizeof(io::NormalTexel))};
constexpr ClipmapFormat kSample{.block_texels = 1, .block_bytes = sizeof(std::int32_t)};
constexpr ClipmapFormat kHeight{.block_texels = 1, .block_bytes = sizeof(std::int16_t)};

ClipmapLevel level_of(const io::Grid& grid, int level, const BlockPlace& finest_texels,
                      const glm::dvec2& finest_m) {
    const std::int64_t step = grid.step(level);
    return {.texels = (finest_texels + (step - 1)) / step, .texel_m = finest_m * static_cast<double>(step)};
}

// A pyramid of width x height texels of this size, each level reaching as far as its parent's texels are too
// coarse.
std::vector<ClipmapLevel> texel_levels(const io::Grid& grid, const BlockPlace& texels,
                                       const glm::dvec2& texel_m, const ClipmapView& view) {
    std::vector<ClipmapLevel> levels;
    for (int level = 0; level < grid.levels(); ++level) {
        levels.push_back(level_of(grid, level, texels, texel_m));
        const double coarser_m = 2.0 * std::max(levels.back().texel_m.x, levels.back().texel_m.y);
        levels.back().reach_m = coarser_m * view.projection_px / (view.pixel_error_px * view.side_cosine);
    }
    return levels;
}

std::vector<ClipmapLevel> heights_clipmap(const io::Store& store, const ClipmapView& view,
                                          ClipmapFormats::Heights heights) {
    return heights == ClipmapFormats::Heights::samples ? sample_clipmap(store.info(), view)
                                                       : vertex_clipmap(store.info(), store.records(), view);
}

// 0 where a level has no data.
double median_error_m(const io::Grid& grid, std::span<const io::NodeRecord> records, int level) {
    std::vector<double> errors;
    for (std::int64_t i = grid.first(level); i < grid.first(level + 1); ++i)
        if (const auto& record = records[static_cast<std::size_t>(i)]; record.has_data())
            errors.push_back(double{record.error_m});
    if (errors.empty()) return 0.0;
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::ranges::nth_element(errors, middle);
    return *middle;
}

glm::dvec2 southwards(const glm::dvec2& corner_m, const glm::dvec3& eye_m) {
    return {eye_m.x - corner_m.x, corner_m.y - eye_m.y};
}

}  // namespace

const ClipmapFormats kStoreFormats{kBc1, kVertexAndNormal};
const ClipmapFormats kRgb8Formats{kRgb8, kVertexAndNormal};
const ClipmapFormats kLeanFormats{kBc1, kHeight};
const ClipmapFormats kDiscFormats{kBc1, kSample, ClipmapFormats::Heights::samples};

ClipmapView clipmap_view(const platform::Lens& lens, double pixel_error_px) {
    return {.projection_px = platform::pixels_per_tangent(lens),
            .pixel_error_px = pixel_error_px,
            .side_cosine = std::cos(lens.horizontal_fov.radians() / 2.0)};
}

std::vector<ClipmapLevel> imagery_clipmap(const io::ImageryInfo& info, const ClipmapView& view) {
    return texel_levels(info.grid(), {info.width, info.height}, {info.spacing_x_m, info.spacing_y_m}, view);
}

std::vector<ClipmapLevel> sample_clipmap(const io::TerrainInfo& info, const ClipmapView& view) {
    ClipmapView samples = view;
    samples.pixel_error_px = heights_pixel_error_px(view.projection_px, view.pixel_error_px);
    return texel_levels(info.grid(), {info.width, info.height}, {info.spacing_x_m, info.spacing_y_m},
                        samples);
}

std::vector<ClipmapLevel> vertex_clipmap(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                                         const ClipmapView& view) {
    const io::Grid grid = info.grid();
    std::vector<ClipmapLevel> levels;
    for (int level = 0; level < grid.levels(); ++level) {
        levels.push_back(
            level_of(grid, level, {info.width, info.height}, {info.spacing_x_m, info.spacing_y_m}));
        if (level == 0) continue;
        const double error_m = median_error_m(grid, records, level - 1);
        levels.back().reach_m = error_m * view.projection_px / view.pixel_error_px;
    }
    return levels;
}

StoreClipmaps::StoreClipmaps(const io::Store& store, const ClipmapView& view, const ClipmapFormats& formats)
    : imagery_corner_m_(store.info().imagery->west_m, store.info().imagery->north_m),
      heights_corner_m_(store.info().west_m, store.info().north_m),
      highest_m_(store.info().max_height_m),
      finest_(store.info().grid().finest()),
      bounds_(store.info(), store.records()),
      imagery_(imagery_clipmap(*store.info().imagery, view), formats.imagery),
      heights_(heights_clipmap(store, view, formats.heights_as), formats.heights) {}

SentBytes StoreClipmaps::start(const glm::dvec3& eye_m) {
    SentBytes sent = move_to(eye_m);
    sent.imagery += imagery_.base_bytes();
    sent.heights += heights_.base_bytes();
    return sent;
}

SentBytes StoreClipmaps::move_to(const glm::dvec3& eye_m) {
    const double above_m = above_ground_m(eye_m);
    return {.imagery = imagery_.move_to(southwards(imagery_corner_m_, eye_m), above_m),
            .heights = heights_.move_to(southwards(heights_corner_m_, eye_m), above_m)};
}

// Where there is no ground under the eye, over the highest of all.
double StoreClipmaps::above_ground_m(const glm::dvec3& eye_m) const {
    const glm::dvec2 place(eye_m);
    const auto quanta = bounds_.of({place, place}, finest_);
    const double ground_m = quanta ? bounds_.height_m(quanta->highest, 1.0) : highest_m_;
    return std::max(eye_m.z - ground_m, 0.0);
}

}  // namespace ridgeline::app
