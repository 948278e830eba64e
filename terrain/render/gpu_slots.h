// The GPU's cache of chunks: a fixed number of bytes, allocated once, handed out in slots.
//
// A slot is a run of the geometry buffer (vertices, then indices; the same buffer feeds both) and a square:
// one place of fixed size for the node's normals in a texture array and for its validity mask beside it.
// Which node lies in which slot is the residency table's business (io/pager); what leaves is decided there as
// well. A released slot is given out again when the GPU has finished the last frame that drew it, so an
// upload never waits for a draw. Render thread only.
//
//            geometry buffer                          normals (RG16_SNORM array)       masks
//   | v v v v i i | free | v v i | ...          layer 0: 8x8 squares, layer 1: ...     words by square
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/buffer.h"
#include "ridgeline/gl/staging_ring.h"
#include "ridgeline/gl/texture.h"
#include "ridgeline/pager/page_allocator.h"
#include "ridgeline/pager/pager.h"

namespace ridgeline::render {

// How a capacity in bytes is divided; pure arithmetic.
struct GpuSlotsShape {
    int quads = 64;
    int squares_per_side = 0;  // of a layer
    int layers = 0;
    std::uint64_t geometry_bytes = 0;

    int square_count() const { return squares_per_side * squares_per_side * layers; }
    // Of one square: normals and mask.
    static std::uint64_t square_bytes(int quads);
    std::uint64_t total_bytes() const;
};

struct GpuSlotsOptions {
    std::uint64_t capacity_bytes = 0;
    // Which part of --gpu-cache the capacity is, for the message: one of `parts`.
    std::uint64_t parts = 2;
    // What another part needs at least, for the message: the size that it names does for all.
    std::uint64_t least_other_part_bytes = 0;
    int max_layers = 2048;
    int max_texture_size_px = 16384;
};
// The shape that suits the store's own mix of sizes. Fails where level 0 does not fit, naming the least
// --gpu-cache.
Result<GpuSlotsShape> plan_gpu_slots(const pager::TileSource& source, const GpuSlotsOptions& options);

class GpuSlots {
  public:
    static Result<GpuSlots> create(const GpuSlotsShape& shape);

    // Where a slot's parts lie, in the units in which GL takes them.
    struct Place {
        std::uint32_t first_vertex = 0;  // of the geometry buffer seen as vertices
        std::uint32_t first_index = 0;   // seen as indices
        std::uint32_t normals = 0;       // the square, as shaders/shared/terrain_instance.h packs it
        std::uint32_t mask_word = 0;     // of the mask buffer
    };

    enum class Stored { yes, no_room, staging_full };
    struct Outcome {
        Stored stored = Stored::no_room;
        pager::GpuSlot slot{};
    };
    // Copies a chunk into a free slot, by way of `staging`.
    Outcome store(const io::ChunkView& chunk, gl::StagingRing& staging);
    // The slot is free once the GPU has finished with the last frame that drew it.
    void release(pager::GpuSlot slot);

    // Takes back what the GPU has finished with.
    void begin_frame(std::uint32_t completed_frame);
    // `frame` draws the slot.
    void use(pager::GpuSlot slot, std::uint32_t frame) { slots_[index(slot)].last_frame = frame; }

    Place place(pager::GpuSlot slot) const;

    // What was released and is still in use by the GPU makes as much room as the chunk needs.
    bool room_is_coming(const io::ChunkView& chunk) const;

    const gl::Buffer& geometry() const { return geometry_; }
    const gl::Buffer& masks() const { return masks_; }
    const gl::Texture2DArray& normals() const { return normals_; }
    const GpuSlotsShape& shape() const { return shape_; }
    std::uint64_t capacity_bytes() const { return shape_.total_bytes(); }
    std::uint64_t used_bytes() const;

  private:
    struct Slot {
        pager::PageRun run;
        std::uint32_t last_frame = 0;
    };
    struct SquarePlace {
        int layer = 0, column = 0, row = 0;
    };
    GpuSlots(const GpuSlotsShape& shape, pager::PageAllocator runs);
    static std::uint32_t index(pager::GpuSlot slot) { return static_cast<std::uint32_t>(slot); }
    SquarePlace square_place(std::uint32_t square) const;
    void upload(const io::ChunkView& chunk, std::uint32_t square, const gl::StagingRing::Allocation& staged,
                const gl::Buffer& staging);
    void free(std::uint32_t square);

    GpuSlotsShape shape_;
    gl::Buffer geometry_;
    gl::Buffer masks_;
    gl::Texture2DArray normals_;
    pager::PageAllocator runs_;
    std::vector<Slot> slots_;              // by square
    std::vector<std::uint32_t> free_;      // squares
    std::vector<std::uint32_t> released_;  // squares that the GPU may still read
    std::uint64_t released_units_ = 0;
    std::uint32_t completed_frame_ = 0;
};

}  // namespace ridgeline::render
