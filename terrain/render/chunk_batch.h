// Draw entries as the GPU takes them: instances, morph tables and indirect commands, in the frame's ring.
//
// A batch holds several lists of commands over the same instances, for passes that draw different parts of
// one set of nodes. Index ranges that touch are merged, so a whole node without finer neighbours is one
// command; empty ones are never passed on (Mesa 22.3 drops a multi-draw that has one). Nodes with holes or
// past the raster's border go to a program of their own, because dropping fragments costs every other node
// the early depth test. Render thread only. After the first frames nothing allocates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/gl/program.h"
#include "ridgeline/gl/staging_ring.h"
#include "ridgeline/gl/vertex_array.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/render/gpu_slots.h"
#include "ridgeline/select/selection.h"
#include "ridgeline/shaders/shared/terrain_instance.h"

namespace ridgeline::render {

// As glMultiDrawElementsIndirect reads it.
struct DrawCommand {
    std::uint32_t index_count = 0;
    std::uint32_t instance_count = 1;
    std::uint32_t first_index = 0;
    std::int32_t base_vertex = 0;
    std::uint32_t base_instance = 0;
};
static_assert(sizeof(DrawCommand) == 20);

// Sorts ranges by their start, drops empty ones and joins those that touch; returns how many are left at the
// front.
std::size_t merge_ranges(std::span<io::IndexRange> ranges);

struct SurfaceCounters {
    std::uint64_t triangles = 0;
    std::uint32_t draws = 0;
    std::uint32_t left_out = 0;  // of the quadtree's cells, for want of room
};

// Where chunks are, in the frame that is drawn.
struct ChunkPlaces {
    const pager::Pager* pager = nullptr;
    GpuSlots* slots = nullptr;
    std::uint32_t frame = 0;
    // Of the frame's lattice, where it is finer than the source's: by so many octaves; and of both the eye's cells.
    int finer_octaves = 0;
    glm::ivec2 source_eye{0}, finer_eye{0};

    // From the eye's cell to a place so far from the source's.
    glm::ivec2 from_eye(const glm::ivec2& source_from_eye) const {
        if (finer_octaves == 0) return source_from_eye;
        return ((source_from_eye + source_eye) << finer_octaves) - finer_eye;
    }
};

// Of nodes drawn whole, and of those that are cut.
struct ChunkPrograms {
    gl::Program whole;
    gl::Program cut;
};
// From passes/terrain.vert and a fragment stage; cut adds RIDGELINE_CUT to the defines.
Result<ChunkPrograms> chunk_programs(const char* fragment_stage, const GpuSlotsShape& shape,
                                     const std::vector<gl::ShaderDefine>& defines);

class ChunkBatch {
  public:
    // Draws from the buffers of `slots`, wherever that is moved. records outlives it.
    ChunkBatch(const io::TerrainInfo& info, std::span<const io::NodeRecord> records, const GpuSlots& slots,
               std::size_t list_count);

    void clear();
    // lists: bit l: list l draws the entry.
    void append(const select::DrawEntry& entry, const ChunkPlaces& places, unsigned lists);
    // False when the ring has no room: the GPU lags behind.
    bool upload(gl::StagingRing& ring);

    // Binds what all lists share; then draw any of them.
    void bind(const GpuSlots& slots, const gl::StagingRing& ring);
    void draw(std::size_t list, const ChunkPrograms& programs) const;

    // Of all lists together.
    const SurfaceCounters& counters() const { return counters_; }

  private:
    void set_up_vertices(const GpuSlots& slots);
    shaders::TerrainInstance instance(const select::DrawEntry& entry, const ChunkPlaces& places) const;
    bool is_cut(const select::DrawEntry& entry) const;
    void use_slots(const select::DrawEntry& entry, const ChunkPlaces& places) const;
    void find_commands(const select::DrawEntry& entry, const ChunkPlaces& places);
    void multi_draw(const gl::Program& program, std::uint64_t offset_bytes, std::size_t count) const;

    struct List {
        std::vector<DrawCommand> whole, cut;
        std::uint64_t offset_bytes = 0;  // in the ring; cut follows whole without a gap
    };
    // The part of the ring that the last upload() filled.
    struct Uploaded {
        std::uint64_t instances = 0, morphs = 0, morph_bytes = 0;
    };

    io::TerrainInfo info_;
    io::Grid grid_;
    std::span<const io::NodeRecord> records_;
    gl::VertexArray vertices_;
    std::vector<shaders::TerrainInstance> instances_;
    std::vector<select::MorphTable> morphs_;
    std::vector<List> lists_;
    std::vector<DrawCommand> found_;  // of one entry
    Uploaded uploaded_;
    SurfaceCounters counters_;
};

}  // namespace ridgeline::render
