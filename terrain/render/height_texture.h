// The terrain's heights on the GPU: a virtual texture of 32-bit integers (io/pager/heights_texels.h), and
// what the disc's shaders want to know each frame. docs/disc.md.
//
// Render thread only; after the first frames nothing allocates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>

#include "ridgeline/base/result.h"
#include "ridgeline/detail/finer_ground.h"
#include "ridgeline/gl/staging_ring.h"
#include "ridgeline/gl/texture.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/render/made_heights.h"
#include "ridgeline/render/made_tiles.h"
#include "ridgeline/render/virtual_texture.h"
#include "ridgeline/select/view.h"
#include "ridgeline/shaders/shared/disc_uniforms.h"

namespace ridgeline::render {

// What a frame's disc is seen from.
struct DiscView {
    select::EyeFrame eye;
    double eye_above_ground_m = 2.0;  // as drawn
    double projection_px = 512.0;     // pixels of a metre at a metre's distance
};

// As shaders have it, but for the table and made tiles; pure.
shaders::DiscUniforms disc_uniforms(const io::Grid& grid, const DiscView& view);

class HeightTexture {
  public:
    // Of a source whose heights are paged, on the lattice that holds the made octaves. Errors: level 0 does not fit, the
    // GPU lacks memory.
    static Result<HeightTexture> create(const pager::TileSource& source, const detail::FinerGround& ground,
                                        const SlotOptions& options);

    // Null without octaves.
    MadeTiles* made() { return made_ ? &*made_ : nullptr; }
    const MadeTiles* made() const { return made_ ? &*made_ : nullptr; }
    // What a slot holds, as shaders see it, from the pager's copies; until the next call, or the pager's next request.
    std::span<const std::byte> texels(std::uint32_t slot, const pager::Pager& pager) const;
    // One texel of it.
    std::int32_t texel(const glm::ivec2& at, std::uint32_t slot, const pager::Pager& pager) const;

    VirtualTexture& tiles() { return tiles_; }
    const VirtualTexture& tiles() const { return tiles_; }

    // Turns tiles and uniforms to a frame seen like this, for DiscLook.
    void look_from(const DiscView& view, const pager::Pager& pager);
    // The same, and puts them into `ring`; false when the ring has no room: the GPU lags behind.
    bool prepare(const DiscView& view, const pager::Pager& pager, gl::StagingRing& ring);
    // For the passes that read it.
    void bind(const gl::StagingRing& ring) const { tiles_.bind(ring, sampler_); }

    const shaders::DiscUniforms& uniforms() const { return uniforms_; }
    int quads() const { return grid_.quads(); }
    // The lattice that all tiles lie on.
    const io::Grid& grid() const { return grid_; }

  private:
    HeightTexture(const io::Grid& grid, const detail::FinerGround& ground, VirtualTexture tiles);

    io::Grid grid_;
    glm::ivec4 detail_;  // as shaders have it
    VirtualTexture tiles_;
    std::optional<MadeTiles> made_;
    std::unique_ptr<MadeHeights> made_heights_;  // what it has worked out is kept
    gl::Sampler sampler_;
    shaders::DiscUniforms uniforms_{};
};

}  // namespace ridgeline::render
