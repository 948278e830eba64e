// The GPU's cache of imagery: a fixed number of slots, each a layer of one BC1 texture array with its mip.
//
// Layers, not places in an atlas: a filter that reaches past a tile's gutter then meets its edge again, never
// another tile. The first layers are level 0's, one a root, and never leave. Which tile lies in which slot is
// the residency table's business (io/pager). Whatever is in the page table may be sampled by any frame, so a
// released slot is given out again when the GPU has finished the last frame that was drawn before. Render
// thread only.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/staging_ring.h"
#include "ridgeline/gl/texture.h"
#include "ridgeline/pager/pager.h"

namespace ridgeline::render {

// How a capacity in bytes is divided; pure arithmetic.
struct ImagerySlotsShape {
    int roots = 0;  // layers of level 0
    int slots = 0;  // of all other tiles: the paper's N
    std::uint64_t table_bytes = 0;

    int layers() const { return roots + slots; }
    std::uint64_t total_bytes() const;
};

struct ImagerySlotsOptions {
    std::uint64_t capacity_bytes = 0;
    // Which part of --gpu-cache the capacity is, for the message: one of `parts`.
    std::uint64_t parts = 2;
    int max_layers = 2048;
};
// What level 0 and the page table take.
std::uint64_t least_imagery_bytes(const pager::TileSource& source);
// As many slots as fit, have a layer and can ever be filled. Fails where level 0 does not fit, naming the least
// --gpu-cache, or has more tiles than there are layers.
Result<ImagerySlotsShape> plan_imagery_slots(const pager::TileSource& source,
                                             const ImagerySlotsOptions& options);

class ImagerySlots {
  public:
    // Fails where the GPU lacks BC1 or memory.
    static Result<ImagerySlots> create(const ImagerySlotsShape& shape);

    enum class Stored { yes, no_room, staging_full };
    struct Outcome {
        Stored stored = Stored::no_room;
        pager::GpuSlot slot{};  // the layer
    };
    // Copies a tile's texels into a free slot, by way of `staging`.
    Outcome store(std::span<const std::byte> texels, gl::StagingRing& staging);
    // The same for a root, whose slot is its own.
    Outcome store_root(int root, std::span<const std::byte> texels, gl::StagingRing& staging);
    // The slot is free once the GPU has finished with `frame`, the last that could sample it.
    void release(pager::GpuSlot slot, std::uint32_t frame);
    // Takes back what the GPU has finished with.
    void begin_frame(std::uint32_t completed_frame);
    // A slot was released and is still in use by the GPU.
    bool room_is_coming() const { return !released_.empty(); }

    const gl::Texture2DArray& texture() const { return texture_; }
    const ImagerySlotsShape& shape() const { return shape_; }
    // Of tiles that are there, and their bytes.
    int used_slots() const { return shape_.slots - static_cast<int>(free_.size()); }
    std::uint64_t used_bytes() const;

  private:
    struct Released {
        std::uint32_t layer = 0;
        std::uint32_t frame = 0;
    };
    explicit ImagerySlots(const ImagerySlotsShape& shape);
    bool upload(std::uint32_t layer, std::span<const std::byte> texels, gl::StagingRing& staging);

    ImagerySlotsShape shape_;
    gl::Texture2DArray texture_;
    std::vector<std::uint32_t> free_;  // layers
    std::vector<Released> released_;   // that the GPU may still read
    std::uint32_t completed_frame_ = 0;
};

}  // namespace ridgeline::render
