// A terrain with octaves of made ground below its source: their lattice, and how high their bumps are.
//
// The lattice goes on below the source's: nodes of the source's levels are the same in both, and each octave adds a
// level whose nodes are made from those above (detail_tile.h). Pure; any thread.
#pragma once

#include <vector>

#include "ridgeline/io/detail_info.h"
#include "ridgeline/io/terrain_info.h"

namespace ridgeline::detail {

struct FinerGround {
    // As detail_shift says.
    int shift = 0;
    // An octave each; none: the source alone.
    std::vector<io::DetailGains> gains;

    int octaves() const { return static_cast<int>(gains.size()); }
};

// As many octaves as the store foretells and a lattice can have: nodes of a level count to 65535.
int most_octaves(const io::TerrainInfo& info);
// octaves: up to most_octaves(). roughness: that bumps are multiplied by, 0 to 4; as high as the store foretells with 1.
FinerGround finer_ground(const io::TerrainInfo& info, int octaves, double roughness = 1.0);

// The same ground with 2^octaves samples in each direction where the source has one.
io::TerrainInfo finer_lattice(const io::TerrainInfo& info, int octaves);

// How far made ground may lie beside the source's, in metres: a generous multiple of how far the source's own samples
// lie beside what is interpolated, not a bound. For what is culled by boxes about the ground.
double generous_displacement_m(const io::TerrainInfo& info, const FinerGround& ground);

}  // namespace ridgeline::detail
