// The sun's shadow maps: a depth texture array, a layer a ring, drawn anew each frame from the sun's side.
//
// Casters are drawn by the same vertex stage, with the same morphs and ranges, as the picture, so the ground
// shadows itself as it is drawn. Depth is 1 towards the sun and 0 away from it, as everywhere. Owns the
// texture, its framebuffers and the programs. Render thread only; after the first frames nothing allocates.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/framebuffer.h"
#include "ridgeline/gl/staging_ring.h"
#include "ridgeline/gl/texture.h"
#include "ridgeline/render/chunk_batch.h"
#include "ridgeline/render/shadow_cascades.h"
#include "ridgeline/select/selection.h"

namespace ridgeline::render {

class ShadowMaps {
  public:
    // map_px: texels a map's side; count() maps of four bytes a texel. Fails where the GPU lacks memory.
    static Result<ShadowMaps> create(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                                     const GpuSlots& slots, int map_px);

    // False when the ring has no room: the GPU lags behind.
    bool prepare(const ShadowCascades& cascades, std::span<const select::ShadowCaster> casters,
                 const ChunkPlaces& places, gl::StagingRing& ring);
    // With the frame's uniforms bound. Leaves its own framebuffer and viewport.
    void draw(const GpuSlots& slots, const gl::StagingRing& ring);
    // For the passes that read them: maps and uniforms.
    void bind(const gl::StagingRing& ring) const;

    std::uint64_t bytes() const;
    const SurfaceCounters& counters() const { return batch_.counters(); }

  private:
    static constexpr std::size_t kCount = ShadowCascades::kCount;

    ShadowMaps(ChunkBatch batch, ChunkPrograms programs, int map_px);
    Result<void> create_maps();

    int map_px_;
    gl::Texture2DArray maps_;
    gl::Sampler sampler_;
    std::array<gl::Framebuffer, kCount> framebuffers_;
    ChunkPrograms programs_;
    ChunkBatch batch_;
    std::uint64_t uniforms_offset_ = 0;
};

}  // namespace ridgeline::render
