// The mesh surface: draws a selection's chunks as one multi-draw per program.
//
// prepare() turns the draw list into indirect commands and instances, in memory of the frame's ring; draw()
// binds and draws them. Index ranges that touch are merged, so a whole node without finer neighbours is one
// command; empty ones are never passed on (Mesa 22.3 drops a multi-draw that has one). Nodes with holes or
// past the raster's border are drawn by a program of their own, because dropping fragments costs every other
// node the early depth test. Render thread only. After the first frames nothing allocates.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ridgeline/base/result.h"
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
};

class MeshSurface {
  public:
    // Draws from the buffers of `slots`, wherever that is moved.
    static Result<MeshSurface> create(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                                      const GpuSlots& slots);

    struct Scene {
        const select::SelectionResult* selection = nullptr;
        const pager::Pager* pager = nullptr;
        GpuSlots* slots = nullptr;
        std::uint32_t frame = 0;
    };
    // False when the ring has no room: the GPU lags behind.
    bool prepare(const Scene& scene, gl::StagingRing& ring);
    // With the frame's uniforms, normals and noise bound.
    void draw(const GpuSlots& slots, const gl::StagingRing& ring);

    const SurfaceCounters& counters() const { return counters_; }

  private:
    MeshSurface(const io::TerrainInfo& info, std::span<const io::NodeRecord> records);
    void set_up_vertices(const GpuSlots& slots);
    void append(const select::DrawEntry& entry, const Scene& scene);
    shaders::TerrainInstance instance(const select::DrawEntry& entry, const Scene& scene) const;
    bool is_cut(const select::DrawEntry& entry) const;
    void append_commands(const select::DrawEntry& entry, const Scene& scene,
                         std::vector<DrawCommand>& commands);
    bool upload(gl::StagingRing& ring);
    void multi_draw(const gl::Program& program, std::uint64_t offset_bytes, std::size_t count) const;

    // The part of the ring that the last prepare() filled.
    struct Prepared {
        std::uint64_t instances = 0, morphs = 0, commands = 0;  // offsets in bytes
        std::uint64_t morph_bytes = 0;
    };

    io::TerrainInfo info_;
    io::Grid grid_;
    std::span<const io::NodeRecord> records_;
    gl::Program whole_program_;
    gl::Program cut_program_;
    gl::VertexArray vertices_;

    std::vector<shaders::TerrainInstance> instances_;
    std::vector<select::MorphTable> morphs_;
    std::vector<DrawCommand> whole_;
    std::vector<DrawCommand> cut_;
    Prepared prepared_;
    SurfaceCounters counters_;
};

}  // namespace ridgeline::render
