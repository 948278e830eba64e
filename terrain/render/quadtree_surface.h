// The quadtree surface: cells of the ground whose levels the GPU chooses, each the same small grid that takes
// its heights from cached tiles (gpu-quadtree paper). docs/quadtree.md.
//
//   frame:  prepare(scene) ─► divide() ─► draw()
//             blocks            levels ─► balance … ─► turn ─► emit, all on the GPU
//
// What it costs the CPU grows with the tiles, not with the cells. Owns its buffers and programs; heights are
// a HeightTexture's. Render thread only; after the first frames nothing allocates.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "ridgeline/base/geometry.h"
#include "ridgeline/base/result.h"
#include "ridgeline/gl/buffer.h"
#include "ridgeline/gl/program.h"
#include "ridgeline/gl/readback_ring.h"
#include "ridgeline/gl/staging_ring.h"
#include "ridgeline/gl/vertex_array.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/render/chunk_batch.h"
#include "ridgeline/render/ground_programs.h"
#include "ridgeline/render/height_texture.h"
#include "ridgeline/render/level_matrix.h"
#include "ridgeline/render/made_region.h"
#include "ridgeline/render/quadtree_blocks.h"
#include "ridgeline/render/quadtree_lod.h"
#include "ridgeline/render/quadtree_pass_clock.h"
#include "ridgeline/render/tile_turns.h"
#include "ridgeline/select/criterion.h"
#include "ridgeline/select/view.h"

namespace ridgeline::render {

// Where levels are chosen.
enum class LodBy { gpu, cpu };

struct QuadtreeOptions {
    LodBy lod = LodBy::gpu;
    // Cells drawn at a time; more are left out, and counted. These are 4 MiB, and sixteen million triangles.
    std::uint32_t most_cells = 1u << 17;
};

struct QuadtreeScene {
    select::EyeFrame eye;
    glm::dvec3 eye_m{0.0};
    // In the drawn frame, as the selection has it.
    Frustum visible;
    // Of everything that may be drawn.
    Box terrain_m;
    // How near a cell must be to split.
    select::CellRule rule;
    // Of made tiles' heights: how many of the finest levels they are, and their unit.
    int made_octaves = 0;
    double made_unit_m = 0.0;
    // That are on the GPU: coarse before fine, none without its parent.
    std::span<const SlottedTile> tiles;
    // By slot, of heights.
    std::span<const float> fades;
    TurningMoment moment;
    // Where chunks draw the rest of the ground: what is left to cells.
    const MadeRegion* region = nullptr;
};

// Pure.
shaders::QuadtreeUniforms quadtree_uniforms(const io::Grid& grid, const QuadtreeBlocks& blocks,
                                            const QuadtreeScene& scene);

class QuadtreeSurface {
  public:
    // layers: slots of the heights' texture.
    static Result<QuadtreeSurface> create(const io::TerrainInfo& info, int layers,
                                          const QuadtreeOptions& options);
    GroundPrograms& programs() { return programs_; }

    // A slot holds another tile from now on. tile: anything that names it alone.
    void hold(std::uint32_t slot, std::int64_t tile, const shaders::ShapeTile& content);
    // Whether hold() was told of this tile.
    bool holds(std::uint32_t slot, std::int64_t tile) const { return held_[slot] == tile; }

    // What the cells of a slot's tile are like, for the CPU's own use; worked out when it is first asked for.
    const shaders::QuadtreeShape& shape(std::uint32_t slot, const HeightTexture& heights,
                                        const pager::Pager& pager);

    // Turns blocks and uniforms to a frame, for QuadtreeLook.
    void look_from(const QuadtreeScene& scene);
    // The same, and puts them into `ring`; false when the ring has no room: the GPU lags behind.
    bool prepare(const QuadtreeScene& scene, gl::StagingRing& ring);
    // With the heights bound.
    void divide(const HeightTexture& heights, const pager::Pager& pager);
    // With the frame's uniforms, noise and heights bound, and shadow maps and imagery where they are read.
    // ring: as prepare() filled it.
    void draw(Lighting lighting, Cover cover, const gl::StagingRing& ring);

    // As of a few frames ago: nobody waits for the GPU's own count.
    const SurfaceCounters& counters() const { return counters_; }

    // Makes what reads the level matrix back, once.
    Result<void> allow_level_matrix();
    // Asks for the frame's that was just divided. After allow_level_matrix().
    void request_level_matrix();
    // The newest that has arrived, null before that.
    const LevelMatrix* level_matrix() { return levels_reader_ ? levels_reader_->newest() : nullptr; }

    // From now on; null without it.
    void time_passes(bool software) { pass_clock_.emplace(software); }
    QuadtreePassClock* pass_clock() { return pass_clock_ ? &*pass_clock_ : nullptr; }

    // For tests: the passes' results, waiting for the GPU.
    std::vector<shaders::QuadtreeCell> read_cells() const;
    std::vector<shaders::QuadtreeShape> read_shapes() const;
    shaders::QuadtreeCommands read_commands() const;
    const QuadtreeBlocks& blocks() const { return blocks_; }
    const shaders::QuadtreeUniforms& uniforms() const { return uniforms_; }

  private:
    QuadtreeSurface(const io::TerrainInfo& info, int layers, const QuadtreeOptions& options);
    Result<void> create_buffers();
    Result<void> create_passes();
    void find_shapes();
    void divide_here(const HeightTexture& heights, const pager::Pager& pager);
    bool prepare_seams(const QuadtreeScene& scene, gl::StagingRing& ring);
    void bind_buffers() const;
    void balance() const;
    void put_cells();
    template <class Work>
    void run_pass(QuadtreePass pass, Work work);
    void count_cells();

    io::Grid grid_;
    int layers_ = 0;
    int quads_ = 8;  // of a cell's side
    QuadtreeOptions options_;
    GroundPrograms programs_;
    gl::Program shapes_pass_, levels_, balance_, turn_, emit_;
    gl::Buffer shapes_, cells_, instances_, commands_, indices_;
    gl::VertexArray array_;
    gl::ReadbackRing counts_;
    std::optional<LevelMatrixReader> levels_reader_;
    std::optional<QuadtreePassClock> pass_clock_;
    std::vector<shaders::QuadtreeCell> cells_here_;  // the CPU's, on their way to whoever looks at them

    QuadtreeBlocks blocks_;
    TileTurns turns_;
    QuadtreeLod lod_;
    shaders::QuadtreeUniforms uniforms_{};
    std::vector<std::int64_t> held_;            // tiles, by slot; -1 where none was
    std::vector<shaders::ShapeTile> contents_;  // likewise
    std::vector<shaders::QuadtreeShape> shapes_by_slot_;
    std::vector<std::uint8_t> shape_known_;        // of them, by slot
    std::vector<std::uint32_t> shapeless_;         // slots whose tile the GPU has not looked at
    std::uint64_t seams_at_ = 0, seam_bytes_ = 0;  // in the ring; 0 bytes: there are none
    std::uint32_t index_count_ = 0;
    std::uint64_t frame_ = 0;
    SurfaceCounters counters_;
};

}  // namespace ridgeline::render
