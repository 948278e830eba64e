// The terrain's heights on the GPU as one texture of the whole land, of which the tiles that a frame needs are
// there: slots, the page table that says which, and what shaders want to know each frame. The heights' sibling
// of virtual_texture.h; docs/disc.md.
//
//   frame:  begin_frame() ─► store(), release() by turns ─► prepare() ─► bind(), draw
//
// A slot is a layer of an array of 32-bit integers (io/pager/heights_texels.h); the first are level 0's, one a
// root, and never leave. A released slot is given out again when the GPU has finished the last frame that was
// drawn before. Render thread only; after the first frames nothing allocates.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/staging_ring.h"
#include "ridgeline/gl/texture.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/render/page_table.h"
#include "ridgeline/select/view.h"
#include "ridgeline/shaders/shared/disc_uniforms.h"

namespace ridgeline::render {

// How a capacity in bytes is divided; pure arithmetic.
struct HeightSlotsShape {
    int quads = 64;
    int roots = 0;  // layers of level 0
    int slots = 0;  // of all other tiles: the paper's N
    std::uint64_t table_bytes = 0;

    int layers() const { return roots + slots; }
    std::uint64_t total_bytes() const;
};

struct HeightSlotsOptions {
    std::uint64_t capacity_bytes = 0;
    // Which part of --gpu-cache the capacity is, for the message: one of `parts`.
    std::uint64_t parts = 4;
    int max_layers = 2048;
};
// What level 0 and the page table take.
std::uint64_t least_height_bytes(const pager::TileSource& source);
// As many slots as fit, have a layer and can ever be filled. Fails where level 0 does not fit, naming the least
// --gpu-cache, or has more tiles than there are layers.
Result<HeightSlotsShape> plan_height_slots(const pager::TileSource& source,
                                           const HeightSlotsOptions& options);

// What a frame's disc is seen from.
struct DiscView {
    select::EyeFrame eye;
    double eye_above_ground_m = 2.0;  // as drawn
    double projection_px = 512.0;     // pixels of a metre at a metre's distance
};

// As shaders have it, but for the table; pure.
shaders::DiscUniforms disc_uniforms(const io::Grid& grid, const DiscView& view);

class HeightTexture {
  public:
    // Of a source whose heights are paged.
    static Result<HeightTexture> create(const pager::TileSource& source, const HeightSlotsOptions& options);

    // Frames count upwards by one.
    void begin_frame(std::uint32_t frame, std::uint32_t completed_frame);
    enum class Stored { yes, no_room, staging_full };
    struct Outcome {
        Stored stored = Stored::no_room;
        pager::GpuSlot slot{};  // the layer
    };
    // Copies a tile into a free slot, by way of `staging`; a root into its own.
    Outcome store(const pager::Upload& upload, gl::StagingRing& staging);
    void release(pager::GpuSlot slot);
    // A slot was released and is still in use by the GPU.
    bool room_is_coming() const { return !released_.empty(); }

    // Turns table, fades and uniforms to a frame seen like this, for DiscLook.
    void look_from(const DiscView& view, const pager::Pager& pager);
    // The same, and puts them into `ring`; false when the ring has no room: the GPU lags behind.
    bool prepare(const DiscView& view, const pager::Pager& pager, gl::StagingRing& ring);
    // For the passes that read it.
    void bind(const gl::StagingRing& ring) const;

    // What shaders see: an entry of the table (column, row, level), a slot's fade; and whose tile a slot holds.
    std::uint32_t page(const glm::ivec3& at) const {
        return table_.entries(at.z)[static_cast<std::size_t>(at.y * table_.columns() + at.x)];
    }
    float fade(std::uint32_t slot) const { return fades_[slot]; }
    pager::NodeIndex tile(std::uint32_t slot) const { return tile_of_slot_[slot]; }
    const shaders::DiscUniforms& uniforms() const { return uniforms_; }
    // Of the page table's rows that were sent since the last call.
    std::uint64_t take_table_bytes() { return std::exchange(table_bytes_, 0); }
    const HeightSlotsShape& shape() const { return shape_; }
    std::uint64_t used_bytes() const;

  private:
    HeightTexture(const pager::TileSource& source, const HeightSlotsShape& shape);
    Result<void> create_textures();
    bool upload(std::uint32_t layer, std::span<const std::byte> texels, gl::StagingRing& staging);
    std::uint64_t changed_bytes() const;
    void send_table(const gl::StagingRing& ring, gl::StagingRing::Allocation room);
    void fill_fades(const pager::Pager& pager);

    struct Rows {
        int level = 0, first = 0, count = 0;
    };
    struct Released {
        std::uint32_t layer = 0;
        std::uint32_t frame = 0;
    };
    // The part of the ring that the last prepare() filled.
    struct Prepared {
        std::uint64_t uniforms = 0, fades = 0;
    };

    HeightSlotsShape shape_;
    pager::TileSpace tiles_;
    PageTable table_;
    gl::Texture2DArray texture_;
    gl::Texture2DArray table_texture_;
    gl::Sampler sampler_;
    shaders::DiscUniforms uniforms_{};
    std::vector<std::uint32_t> free_;  // layers
    std::vector<Released> released_;   // that the GPU may still read
    std::vector<pager::NodeIndex> tile_of_slot_;
    std::vector<float> fades_;  // by slot
    std::vector<Rows> changed_;
    Prepared prepared_;
    std::uint64_t table_bytes_ = 0;
    std::uint32_t frame_ = 0;
    std::uint32_t completed_frame_ = 0;
};

}  // namespace ridgeline::render
