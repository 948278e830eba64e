// Tiles of one kind on the GPU as one texture of the whole land, of which those that a frame needs are there:
// slots, the page table that says which, and their fades. The mechanism that imagery_texture.h and
// height_texture.h share; docs/imagery.md.
//
//   frame:  begin_frame() ─► store(), release() by turns ─► look_from() ─► send() ─► bind(), draw
//
// A slot is a layer of one texture array, not a place in an atlas: a filter that reaches past a tile's gutter
// then meets its edge again, never another tile. Which tile lies in which slot is the residency table's
// business (io/pager). Render thread only; after the first frames nothing allocates.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/staging_ring.h"
#include "ridgeline/gl/texture.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/render/layer_slots.h"
#include "ridgeline/render/page_table.h"
#include "ridgeline/render/slot_plan.h"

namespace ridgeline::render {

// How a tile's bytes lie, and the texture that they go to.
struct TileTexels {
    GLenum format = GL_R32I;  // sized or compressed internal format
    gl::TexelLayout layout;
    struct Mip {
        int side_px = 0;
        std::uint64_t offset_bytes = 0;  // in the tile
    };
    std::vector<Mip> mips;  // finest first
    std::string label;
};

// Where shaders read it.
struct TextureBindings {
    GLuint uniforms = 0;  // block
    GLuint fades = 0;     // storage block
    GLuint table = 0;     // texture unit
    GLuint tiles = 0;     // texture unit
};

struct VirtualTextureOptions {
    pager::TileKind kind = pager::TileKind::imagery;
    // The pager's grid of the kind, or one that goes on below it: with tiles that are made, not paged.
    io::Grid grid;
    int tile_bits = shaders::kTileTexelBits;  // PageTable's
    SlotShape shape;
    TileTexels texels;
    TextureBindings bindings;
};

class VirtualTexture {
  public:
    // Errors: the GPU lacks memory.
    static Result<VirtualTexture> create(const pager::TileSpace& tiles, const VirtualTextureOptions& options);

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

    // Tiles that are made where they are to lie, whose parents are there: who makes them keeps track of them, releases
    // them before their parents leave, and says how far they still look like these. Nothing where no slot is free.
    std::optional<std::uint32_t> claim(io::NodeId made);
    void release_made(io::NodeId made, std::uint32_t slot);
    // Of a tile of either sort that is there.
    std::optional<std::uint32_t> slot_of(io::NodeId node) const { return table_.slot_of(node); }
    void set_fade(std::uint32_t slot, float fade) { fades_[slot] = fade; }
    const gl::Texture2DArray& texture() const { return texture_; }

    bool has_room() const { return !slots_.full(); }
    // A slot was released and is still in use by the GPU.
    bool room_is_coming() const { return slots_.room_is_coming(); }

    // Turns table and fades to a frame whose eye is over a place of the lattice, in finest texels.
    void look_from(const glm::ivec2& cell, const pager::Pager& pager);
    // Puts the frame's uniforms, the fades and what changed of the table into `ring`; false when the ring has
    // no room: the GPU lags behind.
    bool send(std::span<const std::byte> uniforms, gl::StagingRing& ring);
    // What send() put there. tile_sampler: for the tiles.
    void bind(const gl::StagingRing& ring, const gl::Sampler& tile_sampler) const;

    // What shaders see: an entry of the table (column, row, level), a slot's fade; and whose tile a slot
    // holds.
    std::uint32_t page(const glm::ivec3& at) const {
        return table_.entries(at.z)[static_cast<std::size_t>(at.y * table_.columns() + at.x)];
    }
    float fade(std::uint32_t slot) const { return fades_[slot]; }
    std::span<const float> fades() const { return fades_; }
    // kNoNode of one that was made.
    pager::NodeIndex tile(std::uint32_t slot) const { return tile_of_slot_[slot]; }
    const glm::ivec2& window_bits() const { return table_.window_bits(); }

    // Of the page table's rows that were sent since the last call.
    std::uint64_t take_table_bytes() { return std::exchange(table_bytes_, 0); }
    const SlotShape& shape() const { return shape_; }
    std::uint64_t used_bytes() const;

  private:
    VirtualTexture(const pager::TileSpace& tiles, const VirtualTextureOptions& options);
    Result<void> create_textures();
    bool upload(std::uint32_t layer, std::span<const std::byte> texels, gl::StagingRing& staging);
    std::uint64_t changed_bytes() const;
    void send_table(const gl::StagingRing& ring, gl::StagingRing::Allocation room);

    struct Rows {
        int level = 0, first = 0, count = 0;
    };
    // The part of the ring that the last send() filled.
    struct Sent {
        std::uint64_t uniforms = 0, uniform_bytes = 0, fades = 0;
    };

    pager::TileSpace tiles_;
    pager::TileKind kind_;
    io::Grid grid_;
    SlotShape shape_;
    TileTexels texels_;
    TextureBindings bindings_;
    LayerSlots slots_;
    PageTable table_;
    gl::Texture2DArray texture_;
    gl::Texture2DArray table_texture_;
    gl::Sampler table_sampler_;
    std::vector<pager::NodeIndex> tile_of_slot_;
    std::vector<float> fades_;  // by slot
    std::vector<Rows> changed_;
    Sent sent_;
    std::uint64_t table_bytes_ = 0;
    std::uint32_t frame_ = 0;
};

}  // namespace ridgeline::render
