#include "terrain.h"

#include <algorithm>
#include <cmath>

#include "drainage.h"
#include "noise.h"
#include "ridgeline/base/contract.h"

namespace ridgeline::synth {
namespace {

// The landscape is solved over more than the raster, and its rim, where rivers leave, cut off.
constexpr float kMargin = 0.1f;
// Its cells are no smaller than this many samples: below, gullies take over.
constexpr float kSamplesPerCell = 4.0f;

// 3500 m over 82 km, as in a great range; relief grows with the root of the extent, up to the Himalaya's.
float relief_of(float extent_m) { return std::min(6500.0f, 3500.0f * std::sqrt(extent_m / 82e3f)); }

HeightMap landscape_of(const TerrainOptions& options, std::uint32_t seed) {
    const float extent_m = static_cast<float>(options.size) * options.spacing_m;
    return drained_landscape({.extent_m = extent_m * (1.0f + 2.0f * kMargin),
                              .relief_m = relief_of(extent_m),
                              .finest_cell_m = kSamplesPerCell * options.spacing_m,
                              .seed = seed});
}

// From just above what the landscape resolves down to what samples can show.
std::vector<GullyOctave> octaves_between(float cell_m, float spacing_m, std::uint32_t seed) {
    std::vector<GullyOctave> octaves;
    constexpr float kStrength = 0.1f;
    float wavelength_m = 3.4f * cell_m;
    while (wavelength_m > 3.9f * spacing_m) {
        // The finest are damped: furrows of a few samples look like fur.
        const float fade = std::min(1.0f, 0.25f + wavelength_m / (18.0f * spacing_m));
        octaves.push_back(
            {wavelength_m, kStrength * fade, hash(seed + static_cast<std::uint32_t>(octaves.size()))});
        wavelength_m *= 0.5f;
    }
    return octaves;
}

}  // namespace

float highest_relief_m(const TerrainOptions& options) {
    return relief_of(static_cast<float>(options.size) * options.spacing_m);
}

Terrain::Terrain(const TerrainOptions& options)
    : options_(options),
      seed_(hash(static_cast<std::uint32_t>(options.seed) ^
                 hash(static_cast<std::uint32_t>(options.seed >> 32)))),
      landscape_(landscape_of(options, seed_)) {
    margin_nodes_ = kMargin * static_cast<float>(options.size) * options.spacing_m / landscape_.cell_m;
    nodes_per_sample_ = options.spacing_m / landscape_.cell_m;
    octaves_ = octaves_between(landscape_.cell_m, options.spacing_m, seed_ + 1000);
}

Terrain::Profile Terrain::profile_at(const SampleArea& area, int row) const {
    Profile profile;
    profile.first_node = static_cast<int>(node_of(area.column)) - 1;
    const int last_node = static_cast<int>(node_of(area.column + area.columns - 1)) + 2;
    const float position = node_of(row);
    const int node_row = static_cast<int>(position);
    const auto weights = spline_weights(position - static_cast<float>(node_row));
    const auto slopes = spline_slopes(position - static_cast<float>(node_row));
    for (int node = profile.first_node; node <= last_node; ++node) {
        float height_m = 0.0f;
        float slope_y = 0.0f;
        for (int k = 0; k < 4; ++k) {
            const float node_m = landscape_.at(node, node_row + k - 1);
            height_m += weights[static_cast<std::size_t>(k)] * node_m;
            slope_y += slopes[static_cast<std::size_t>(k)] * node_m;
        }
        profile.heights_m.push_back(height_m);
        profile.slopes_y.push_back(slope_y / landscape_.cell_m);
    }
    return profile;
}

void Terrain::lay_landscape(const Profile& profile, const SampleRow& row) const {
    for (std::size_t i = 0; i < row.heights_m.size(); ++i) {
        const float position = node_of(row.first_column + static_cast<int>(i));
        const int node = static_cast<int>(position);
        const auto weights = spline_weights(position - static_cast<float>(node));
        const auto slopes = spline_slopes(position - static_cast<float>(node));
        const auto first = static_cast<std::size_t>(node - 1 - profile.first_node);
        float height_m = 0.0f;
        float slope_x = 0.0f;
        float slope_y = 0.0f;
        for (std::size_t k = 0; k < 4; ++k) {
            height_m += weights[k] * profile.heights_m[first + k];
            slope_x += slopes[k] * profile.heights_m[first + k];
            slope_y += weights[k] * profile.slopes_y[first + k];
        }
        row.heights_m[i] = height_m;
        row.slopes_x[i] = slope_x / landscape_.cell_m;
        row.slopes_y[i] = slope_y;
    }
}

// Uneven ground everywhere, little of it on plains.
void Terrain::roughen(const SampleRow& row) const {
    constexpr float kSamplesPerWave = 6.7f;
    const float wavelength_m = kSamplesPerWave * row.spacing_m;
    const float waves_per_sample = 1.0f / kSamplesPerWave;
    const float y = static_cast<float>(row.row) * waves_per_sample;
    for (std::size_t i = 0; i < row.heights_m.size(); ++i) {
        const float x = static_cast<float>(row.first_column + static_cast<int>(i)) * waves_per_sample;
        const float steepness = std::min(1.0f, std::abs(row.slopes_x[i]) + std::abs(row.slopes_y[i]));
        const float amplitude_m = wavelength_m * (0.002f + 0.014f * steepness);
        row.heights_m[i] += amplitude_m * gradient_noise(x, y, seed_ + 2000);
    }
}

void Terrain::fill(const SampleArea& area, std::span<float> heights_m) const {
    RIDGELINE_CHECK(heights_m.size() ==
                    static_cast<std::size_t>(area.columns) * static_cast<std::size_t>(area.rows));
    std::vector<Gullies> gullies;
    for (const GullyOctave& octave : octaves_) gullies.emplace_back(octave, area, options_.spacing_m);
    const auto columns = static_cast<std::size_t>(area.columns);
    std::vector<float> slopes_x(columns);
    std::vector<float> slopes_y(columns);
    for (int row = 0; row < area.rows; ++row) {
        const SampleRow samples{
            area.column,        area.row + row,
            options_.spacing_m, heights_m.subspan(static_cast<std::size_t>(row) * columns, columns),
            slopes_x,           slopes_y};
        lay_landscape(profile_at(area, samples.row), samples);
        for (const Gullies& octave : gullies) octave.carve(samples);
        roughen(samples);
        for (float& height_m : samples.heights_m)
            height_m = std::round(height_m / kHeightStep_m) * kHeightStep_m;
    }
}

}  // namespace ridgeline::synth
