// A surface over a whole raster as a field of heights, one at every source sample: the source's own, a
// level's, or whatever nodes were drawn into it.
//
// Four bytes a sample of the roots' area, so for rasters that fit in memory: benches. Reads the store, which
// outlives it. One thread at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/io/chunk_reader.h"

namespace ridgeline::app {

class SurfaceField {
  public:
    explicit SurfaceField(const io::Store& store);

    // The source's samples. Invalid ones are not numbers, and so is everything that interpolates them.
    Result<void> take_samples();
    // A node's mesh, unmorphed, over its area; fill included.
    Result<void> take_mesh(io::NodeId node);
    Result<void> take_level(int level);

    // Heights in metres. Column and row within the raster.
    float at(std::int64_t column, std::int64_t row) const {
        return heights_m_[static_cast<std::size_t>(row * stride_ + column)];
    }
    // Bilinear, from [0, width - 1) x [0, height - 1).
    float at_place(double column, double row) const {
        const auto x = static_cast<std::int64_t>(column), y = static_cast<std::int64_t>(row);
        const float* upper = &heights_m_[static_cast<std::size_t>(y * stride_ + x)];
        const float* lower = upper + stride_;
        const auto u = static_cast<float>(column - static_cast<double>(x));
        const auto v = static_cast<float>(row - static_cast<double>(y));
        return (upper[0] * (1.0f - u) + upper[1] * u) * (1.0f - v) +
               (lower[0] * (1.0f - u) + lower[1] * u) * v;
    }

  private:
    float& point(std::int64_t x, std::int64_t y) {
        return heights_m_[static_cast<std::size_t>(y * stride_ + x)];
    }
    void clear(io::LatticePoint origin, std::int64_t extent);
    void interpolate(io::LatticePoint origin, std::int64_t extent);

    const io::Store& store_;
    io::ChunkReader reader_;
    std::int64_t stride_;  // samples a row of the roots' area
    std::vector<float> heights_m_;
    io::OwnedChunk chunk_;
    io::HeightsTile tile_;
    std::vector<std::uint8_t> tile_bytes_;
};

}  // namespace ridgeline::app
