// The imagery on the GPU as one texture of the whole land, of which the tiles that a frame needs are there:
// slots, the page table that says which, and what the shader wants to know each frame. docs/imagery.md.
//
//   frame:  begin_frame() ─► store(), release() by turns ─► prepare() ─► bind(), draw
//
// Render thread only; after the first frames nothing allocates. The store must outlive it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/staging_ring.h"
#include "ridgeline/gl/texture.h"
#include "ridgeline/io/imagery_info.h"
#include "ridgeline/io/imagery_record.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/platform/camera.h"
#include "ridgeline/render/imagery_slots.h"
#include "ridgeline/render/page_table.h"
#include "ridgeline/shaders/shared/imagery_uniforms.h"

namespace ridgeline::render {

// Who looks along a pixel's long print on the ground. llvmpipe's sampler takes the print from neighbouring
// pixels' coordinates, whatever gradients it is given (Mesa 22.3), and these jump from tile to tile.
enum class PrintFilter { sampler, shader };

struct VirtualTextureOptions {
    ImagerySlotsOptions slots;
    PrintFilter print_filter = PrintFilter::sampler;
};

// As the shader has it; pure. The eye's cell is kept on the lattice, so that the page table's windows are about
// a place that it knows.
shaders::ImageryUniforms imagery_uniforms(const io::ImageryInfo& info, const glm::dvec2& eye_m);

// Whether there is a texel of imagery at every place of the terrain.
bool covers(const io::ImageryInfo& imagery, std::span<const io::ImageryRecord> records,
            const io::TerrainInfo& terrain);

class VirtualTexture {
  public:
    // Of a source with imagery.
    static Result<VirtualTexture> create(const io::ImageryInfo& info, const pager::TileSource& source,
                                         const VirtualTextureOptions& options);

    // Frames count upwards by one.
    void begin_frame(std::uint32_t frame, std::uint32_t completed_frame);
    ImagerySlots::Outcome store(const pager::Upload& upload, gl::StagingRing& staging);
    void release(pager::GpuSlot slot);
    bool room_is_coming() const { return slots_.room_is_coming(); }

    // Puts page table, fades and uniforms of a frame seen like this into `ring`; false when the ring has no
    // room: the GPU lags behind.
    bool prepare(const platform::Camera& camera, const pager::Pager& pager, gl::StagingRing& ring);
    // For the passes that read it.
    void bind(const gl::StagingRing& ring) const;

    // Of the page table's rows that were sent since the last call.
    std::uint64_t take_table_bytes() { return std::exchange(table_bytes_, 0); }
    const ImagerySlots& slots() const { return slots_; }

  private:
    VirtualTexture(const io::ImageryInfo& info, const pager::TileSource& source, ImagerySlots slots);
    std::uint64_t changed_bytes();
    void send_table(const gl::StagingRing& ring, gl::StagingRing::Allocation room);
    void fill_uniforms(const platform::Camera& camera);
    void fill_fades(const pager::Pager& pager);

    struct Rows {
        int level = 0, first = 0, count = 0;
    };
    // The part of the ring that the last prepare() filled.
    struct Prepared {
        std::uint64_t uniforms = 0, fades = 0;
    };

    io::ImageryInfo info_;
    pager::TileSpace tiles_;
    ImagerySlots slots_;
    PageTable table_;
    gl::Texture2DArray table_texture_;
    gl::Sampler table_sampler_;
    gl::Sampler sampler_;
    shaders::ImageryUniforms uniforms_{};
    PrintFilter print_filter_ = PrintFilter::sampler;
    std::vector<pager::NodeIndex> tile_of_slot_;
    std::vector<float> fades_;  // by slot
    std::vector<Rows> changed_;
    Prepared prepared_;
    std::uint64_t table_bytes_ = 0;
    std::uint32_t frame_ = 0;
};

}  // namespace ridgeline::render
