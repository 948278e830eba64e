// The mesh surface: draws a selection's chunks as one multi-draw per program.
//
// prepare() turns the draw list into a batch in the frame's ring; draw() binds and draws it. Render thread
// only. After the first frames nothing allocates.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <utility>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/staging_ring.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/render/chunk_batch.h"
#include "ridgeline/render/gpu_slots.h"
#include "ridgeline/render/made_region.h"
#include "ridgeline/select/selection.h"

namespace ridgeline::render {

// Whether the ground is lit through the sun's shadow maps.
enum class Lighting { unshadowed, shadowed };
// What gives it its colours.
enum class Cover { tint, imagery };
// Whether the imagery leaves any ground to the tint.
enum class Coverage { partly, wholly };

class MeshSurface {
  public:
    // Draws from the buffers of `slots`, wherever that is moved.
    static Result<MeshSurface> create(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                                      const GpuSlots& slots);
    // Builds the programs that read shadow maps, and those that read imagery, once.
    Result<void> allow_shadows(const GpuSlots& slots);
    Result<void> allow_imagery(const GpuSlots& slots, Coverage coverage);

    // region: null where chunks draw all ground. False when the ring has no room: the GPU lags behind.
    bool prepare(const select::SelectionResult& selection, const MadeRegion* region,
                 const ChunkPlaces& places, gl::StagingRing& ring);
    // With the frame's uniforms, normals and noise bound, and shadow maps and imagery where they are read.
    void draw(const GpuSlots& slots, const gl::StagingRing& ring, Lighting lighting, Cover cover);

    const SurfaceCounters& counters() const { return batch_.counters(); }

  private:
    explicit MeshSurface(ChunkBatch batch) : batch_(std::move(batch)) {}

    static constexpr std::size_t kTwo = 2;
    ChunkPrograms& programs(Lighting lighting, Cover cover) {
        return programs_[static_cast<std::size_t>(lighting)][static_cast<std::size_t>(cover)];
    }
    Result<void> build(const GpuSlots& slots);

    Lighting most_lighting_ = Lighting::unshadowed;
    Cover most_cover_ = Cover::tint;
    Coverage coverage_ = Coverage::partly;
    std::array<std::array<ChunkPrograms, kTwo>, kTwo> programs_;
    ChunkBatch batch_;
    bool culls_fragments_ = false;
};

}  // namespace ridgeline::render
