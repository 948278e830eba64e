#include "ground_colours.h"

#include <algorithm>
#include <cmath>

#include "noise.h"
#include "ridgeline/base/contract.h"

namespace ridgeline::synth {
namespace {

// Samples to the places with which a sample is compared to tell gullies and valleys.
constexpr int kGullyReach = 2;
constexpr int kValleyReach = 12;

constexpr float kPatch_m = 1700.0f;
constexpr float kClearing_m = 160.0f;
constexpr float kTuft_m = 24.0f;
// Crowns of trees, stones: as small as texels can show.
constexpr float kGrain_m = 7.0f;
constexpr float kGrain_texels = 2.6f;
// Layers of rock show on walls, so far apart in height.
constexpr float kLayer = 0.011f;

// std::lerp keeps promises that nobody needs here, and takes most of the time for it.
float towards(float a, float b, float t) { return a + (b - a) * t; }

}  // namespace

GroundColours::GroundColours(const Terrain& terrain, const TerrainOptions& options, int ratio)
    : terrain_(terrain),
      options_(options),
      ratio_(ratio),
      texel_m_(options.spacing_m / static_cast<float>(ratio)),
      relief_m_(highest_relief_m(options)),
      seed_(hash(static_cast<std::uint32_t>(options.seed) ^ 0x632be5abu)) {}

GroundColours::Ground GroundColours::between(const Ground& a, const Ground& b, float t) {
    return {towards(a.height, b.height, t),   towards(a.slope, b.slope, t),
            towards(a.hollow, b.hollow, t),   towards(a.valley, b.valley, t),
            towards(a.patches, b.patches, t), towards(a.clearings, b.clearings, t)};
}

GroundColours::Colour GroundColours::mixed(const Colour& a, const Colour& b, float t) {
    return {towards(a.red, b.red, t), towards(a.green, b.green, t), towards(a.blue, b.blue, t)};
}

GroundColours::Plot GroundColours::survey(const SampleArea& texels) const {
    const int last = options_.size - 1;
    const auto until = [&](int first, int count) { return std::min((first + count - 1) / ratio_ + 1, last); };
    Plot plot;
    plot.area.column = texels.column / ratio_;
    plot.area.row = texels.row / ratio_;
    plot.area.columns = until(texels.column, texels.columns) - plot.area.column + 1;
    plot.area.rows = until(texels.row, texels.rows) - plot.area.row + 1;

    // Heights around it as well, as far as there are any.
    const int west = std::max(plot.area.column - kValleyReach, 0);
    const int north = std::max(plot.area.row - kValleyReach, 0);
    const SampleArea wide{west, north,
                          std::min(plot.area.column + plot.area.columns + kValleyReach, options_.size) - west,
                          std::min(plot.area.row + plot.area.rows + kValleyReach, options_.size) - north};
    std::vector<float> heights_m(static_cast<std::size_t>(wide.columns) *
                                 static_cast<std::size_t>(wide.rows));
    terrain_.fill(wide, heights_m);
    const auto height_m = [&](int column, int row) {
        const int x = std::clamp(column - wide.column, 0, wide.columns - 1);
        const int y = std::clamp(row - wide.row, 0, wide.rows - 1);
        return heights_m[static_cast<std::size_t>(y) * static_cast<std::size_t>(wide.columns) +
                         static_cast<std::size_t>(x)];
    };
    const auto sunk = [&](int column, int row, int reach) {
        const float around = height_m(column - reach, row) + height_m(column + reach, row) +
                             height_m(column, row - reach) + height_m(column, row + reach);
        return (around / 4.0f - height_m(column, row)) / (static_cast<float>(reach) * options_.spacing_m);
    };
    for (int row = plot.area.row; row < plot.area.row + plot.area.rows; ++row)
        for (int column = plot.area.column; column < plot.area.column + plot.area.columns; ++column) {
            const float run_m = 2.0f * options_.spacing_m;
            const float east = (height_m(column + 1, row) - height_m(column - 1, row)) / run_m;
            const float south = (height_m(column, row + 1) - height_m(column, row - 1)) / run_m;
            const float x_m = static_cast<float>(column) * options_.spacing_m;
            const float y_m = static_cast<float>(row) * options_.spacing_m;
            plot.ground.push_back({height_m(column, row) / relief_m_, std::sqrt(east * east + south * south),
                                   sunk(column, row, kGullyReach), sunk(column, row, kValleyReach),
                                   fractal_noise(x_m / kPatch_m, y_m / kPatch_m, seed_, 3),
                                   fractal_noise(x_m / kClearing_m, y_m / kClearing_m, seed_ + 10, 2)});
        }
    return plot;
}

GroundColours::Colour GroundColours::colour_of(const Ground& ground, float east_m, float south_m) const {
    constexpr Colour kMeadow{104, 116, 62}, kDryGrass{150, 138, 92}, kAlpine{126, 122, 82},
        kForest{44, 62, 36}, kLightForest{72, 86, 46}, kRock{122, 115, 106}, kPaleRock{150, 142, 130},
        kScree{158, 152, 142}, kGravel{136, 130, 118}, kSnow{240, 243, 248};
    const float tufts = gradient_noise(east_m / kTuft_m, south_m / kTuft_m, seed_ + 20);
    const float grain_m = std::max(kGrain_m, kGrain_texels * texel_m_);
    const float grain = gradient_noise(east_m / grain_m, south_m / grain_m, seed_ + 21);
    const float height = ground.height + 0.008f * tufts;
    const float slope = ground.slope + 0.06f * tufts;
    const float chance = 0.6f * ground.patches + 0.3f * ground.clearings;

    const float snow_line =
        0.68f + 0.08f * chance + 0.3f * std::max(0.0f, slope - 0.75f) - 0.6f * ground.hollow;
    const float snow = smooth_step(snow_line - 0.01f, snow_line + 0.02f, height);
    Colour colour = kSnow;
    if (snow < 1.0f) {
        colour = mixed(kMeadow, kDryGrass, smooth_step(-0.3f, 0.5f, chance + 0.2f * tufts));
        colour = mixed(colour, kAlpine, smooth_step(0.3f, 0.55f, height + 0.1f * chance));
        const float tree_line = 0.5f + 0.06f * chance + 0.5f * ground.valley;
        const float wood = chance + 0.15f * tufts + 3.0f * ground.valley + 0.1f;
        const float forest = smooth_step(tree_line + 0.02f, tree_line - 0.03f, height) *
                             smooth_step(1.15f, 0.85f, slope) * smooth_step(-0.06f, 0.04f, wood);
        const Colour crowns = mixed(kForest, kLightForest, smooth_step(-0.6f, 0.9f, grain + 0.4f * tufts));
        colour = mixed(colour, crowns, forest);

        const float bare = slope + 0.35f * smooth_step(0.45f, 0.8f, height) - 0.5f * ground.hollow;
        colour = mixed(colour, kScree, smooth_step(0.62f, 0.78f, bare) * smooth_step(0.3f, 0.5f, height));
        if (const float wall = smooth_step(0.82f, 1.0f, bare); wall > 0.0f) {
            const float layers =
                0.5f + 0.5f * std::sin(6.2831853f * ground.height / kLayer + 3.0f * ground.clearings);
            colour = mixed(colour, mixed(kRock, kPaleRock, 0.6f * layers + 0.25f * (grain + 1.0f)), wall);
        }
        const float stream = smooth_step(0.06f, 0.12f, ground.hollow) * smooth_step(0.3f, 0.15f, slope);
        colour = mixed(mixed(colour, kGravel, stream), kSnow, snow);
    }
    // Nothing is quite even; snow nearly is.
    const float shade = 1.0f + (0.05f * grain + 0.03f * tufts) * (1.0f - 0.7f * snow);
    return {colour.red * shade, colour.green * shade, colour.blue * shade};
}

void GroundColours::fill(const SampleArea& area, std::span<std::uint8_t> colours) const {
    RIDGELINE_CHECK(colours.size() == static_cast<std::size_t>(area.columns) *
                                          static_cast<std::size_t>(area.rows) * kColourBytes);
    const Plot plot = survey(area);
    const auto at = [&](int column, int row) -> const Ground& {
        const int x = std::min(column - plot.area.column, plot.area.columns - 1);
        const int y = std::min(row - plot.area.row, plot.area.rows - 1);
        return plot.ground[static_cast<std::size_t>(y) * static_cast<std::size_t>(plot.area.columns) +
                           static_cast<std::size_t>(x)];
    };
    const auto byte = [](float value) {
        return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 255.0f) + 0.5f);
    };
    std::size_t out = 0;
    for (int row = area.row; row < area.row + area.rows; ++row) {
        const int y = row / ratio_;
        const float down = static_cast<float>(row % ratio_) / static_cast<float>(ratio_);
        for (int column = area.column; column < area.column + area.columns; ++column) {
            const int x = column / ratio_;
            const float across = static_cast<float>(column % ratio_) / static_cast<float>(ratio_);
            const Ground ground = between(between(at(x, y), at(x + 1, y), across),
                                          between(at(x, y + 1), at(x + 1, y + 1), across), down);
            const Colour colour =
                colour_of(ground, static_cast<float>(column) * texel_m_, static_cast<float>(row) * texel_m_);
            colours[out++] = byte(colour.red);
            colours[out++] = byte(colour.green);
            colours[out++] = byte(colour.blue);
        }
    }
}

}  // namespace ridgeline::synth
