// The imagery on the GPU: a virtual texture of BC1 tiles with a mip each, and what the shader wants to know
// each frame. docs/imagery.md.
//
// Render thread only; after the first frames nothing allocates. The store must outlive it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/staging_ring.h"
#include "ridgeline/gl/texture.h"
#include "ridgeline/io/imagery_info.h"
#include "ridgeline/io/imagery_record.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/platform/camera.h"
#include "ridgeline/render/virtual_texture.h"
#include "ridgeline/shaders/shared/imagery_uniforms.h"

namespace ridgeline::render {

// Who looks along a pixel's long print on the ground. llvmpipe's sampler takes the print from neighbouring
// pixels' coordinates, whatever gradients it is given (Mesa 22.3), and these jump from tile to tile.
enum class PrintFilter { sampler, shader };

struct ImageryTextureOptions {
    SlotOptions slots;
    PrintFilter print_filter = PrintFilter::sampler;
};

// As the shader has it; pure. The eye's cell is kept on the lattice, so that the page table's windows are
// about a place that it knows.
shaders::ImageryUniforms imagery_uniforms(const io::ImageryInfo& info, const glm::dvec2& eye_m);

// Whether there is a texel of imagery at every place of the terrain.
bool covers(const io::ImageryInfo& imagery, std::span<const io::ImageryRecord> records,
            const io::TerrainInfo& terrain);

class ImageryTexture {
  public:
    // Of a source with imagery. Errors: level 0 does not fit, the GPU lacks BC1 or memory.
    static Result<ImageryTexture> create(const io::ImageryInfo& info, const pager::TileSource& source,
                                         const ImageryTextureOptions& options);

    VirtualTexture& tiles() { return tiles_; }
    const VirtualTexture& tiles() const { return tiles_; }

    // Puts what a frame seen like this needs into `ring`; false when the ring has no room: the GPU lags
    // behind.
    bool prepare(const platform::Camera& camera, const pager::Pager& pager, gl::StagingRing& ring);
    // For the passes that read it.
    void bind(const gl::StagingRing& ring) const { tiles_.bind(ring, sampler_); }

  private:
    ImageryTexture(const io::ImageryInfo& info, const io::Grid& grid, VirtualTexture tiles,
                   PrintFilter print_filter);
    shaders::ImageryUniforms uniforms(const platform::Camera& camera) const;

    io::ImageryInfo info_;
    int finest_level_ = 0;
    VirtualTexture tiles_;
    gl::Sampler sampler_;
    PrintFilter print_filter_ = PrintFilter::sampler;
};

}  // namespace ridgeline::render
