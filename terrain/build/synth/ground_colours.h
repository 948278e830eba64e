// What the made-up ground looks like from above: colours by height, slope, hollows and a little chance.
//
// Meadows and forest below, rock where it is steep, scree and snow above, gravel along streams. No light
// falls on it: whoever draws it lights it. Const after construction: any number of threads may ask for areas
// at once; what an area holds does not depend on how the picture is cut into areas.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "terrain.h"

namespace ridgeline::synth {

constexpr std::size_t kColourBytes = 3;  // red, green, blue, sRGB-coded

class GroundColours {
  public:
    // `ratio` texels a sample; texel (ratio · x, ratio · y) has its centre on sample (x, y).
    GroundColours(const Terrain& terrain, const TerrainOptions& options, int ratio);

    // Texels along either side.
    static std::int64_t side(std::int64_t samples, int ratio) { return (samples - 1) * ratio + 1; }

    // Colours of an area counted in texels, row by row.
    void fill(const SampleArea& area, std::span<std::uint8_t> colours) const;

  private:
    // What decides the colour, at a sample, and between samples by bilinear mixing.
    struct Ground {
        float height = 0.0f;     // of the highest relief
        float slope = 0.0f;      // rise per metre
        float hollow = 0.0f;     // metres below what lies around, per metre of distance: of gullies,
        float valley = 0.0f;     // and of valleys
        float patches = 0.0f;    // chance, over kilometres,
        float clearings = 0.0f;  // and over a hundred metres
    };
    // Samples under an area, and the ground at each of them.
    struct Plot {
        SampleArea area;
        std::vector<Ground> ground;
    };
    struct Colour {
        float red = 0.0f, green = 0.0f, blue = 0.0f;
    };

    Plot survey(const SampleArea& texels) const;
    Colour colour_of(const Ground& ground, float east_m, float south_m) const;
    static Ground between(const Ground& a, const Ground& b, float t);
    static Colour mixed(const Colour& a, const Colour& b, float t);

    const Terrain& terrain_;
    TerrainOptions options_;
    int ratio_;
    float texel_m_;
    float relief_m_;
    std::uint32_t seed_;
};

}  // namespace ridgeline::synth
