// The synthesised ground: drained landscape, gullies and a little unevenness, as heights at any sample.
//
// Const after construction: any number of threads may ask for areas at once. What an area holds does not
// depend on how the raster is cut into areas.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gullies.h"
#include "height_map.h"

namespace ridgeline::synth {

struct TerrainOptions {
    int size = 8193;  // samples along either side
    float spacing_m = 10.0f;
    std::uint64_t seed = 1;
};

// About how high the highest summits are.
float highest_relief_m(const TerrainOptions& options);

// Heights are whole multiples of this: exact in the store's own quantum, and kinder to compression than
// noise.
constexpr float kHeightStep_m = 1.0f / 32.0f;

class Terrain {
  public:
    explicit Terrain(const TerrainOptions& options);

    // Heights of the area's samples, row by row.
    void fill(const SampleArea& area, std::span<float> heights_m) const;

  private:
    // One row of the landscape under an area: its spline already taken across rows.
    struct Profile {
        int first_node = 0;
        std::vector<float> heights_m, slopes_y;
    };
    Profile profile_at(const SampleArea& area, int row) const;
    void lay_landscape(const Profile& profile, const SampleRow& row) const;
    void roughen(const SampleRow& row) const;
    float node_of(int sample) const { return margin_nodes_ + static_cast<float>(sample) * nodes_per_sample_; }

    TerrainOptions options_;
    std::uint32_t seed_;
    HeightMap landscape_;
    float margin_nodes_ = 0.0f;
    float nodes_per_sample_ = 1.0f;
    std::vector<GullyOctave> octaves_;
};

}  // namespace ridgeline::synth
