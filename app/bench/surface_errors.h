// How a surface differs from the source: heights and normals everywhere, and the skyline as seen from random
// places.
//
// The skyline is where the ground ends under the sky: per column of the picture, the steepest line of sight
// that some ground reaches. Pure functions over fields; any thread.
#pragma once

#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "ridgeline/app/bench/surface_field.h"
#include "ridgeline/telemetry/summary.h"

namespace ridgeline::app {

struct GroundErrors {
    double mean_m = 0.0, worst_m = 0.0;  // of heights, at every valid sample
    double normal_degrees = 0.0;         // mean angle between normals of finest cells
};
GroundErrors ground_errors(const io::TerrainInfo& info, const SurfaceField& source,
                           const SurfaceField& surface);

// An eye in lattice places and metres.
struct Eye {
    double column = 0.0, row = 0.0;
    double height_m = 0.0;
};

struct SkylineOptions {
    int columns = 256;             // all round
    double from_m = 0.0;           // ground nearer than this is left out
    double projection_px = 512.0;  // pixels that a slope of 1 spans: 1024 pixels across 90 degrees
};

// Random places over valid ground, a tenth of the raster's sides away from its border, by turns 2, 30 and
// 200 m above it.
std::vector<Eye> random_eyes(const io::TerrainInfo& info, const SurfaceField& source, int count,
                             std::uint32_t seed);

constexpr double kNoGround = -std::numeric_limits<double>::infinity();

// Of one column: the slope of the steepest line of sight that meets ground, and where it does.
struct SkylinePoint {
    double slope = kNoGround;
    double away_m = 0.0;
};
// Clockwise from north, all round.
std::vector<SkylinePoint> skyline(const io::TerrainInfo& info, const SurfaceField& field, const Eye& eye,
                                  const SkylineOptions& options);

// How far apart the skylines of the two are, in pixels, for every column in which there is ground. Where the
// source has no height, neither counts.
void append_skyline_errors(const io::TerrainInfo& info, const SurfaceField& source,
                           const SurfaceField& surface, const Eye& eye, const SkylineOptions& options,
                           std::vector<double>& errors_px);

}  // namespace ridgeline::app
