// The frame: takes in tiles, draws terrain and sky into a target of exact size, and keeps the GPU's time.
//
// Owns the GPU's side of a walk: slots, surface, programs, target, rings. Render thread only; it never waits
// for the GPU, but where the GPU is so far behind that a frame's own data finds no room. A frame, in this
// order:
//
//   begin_frame(frame)
//   upload(pager, ...)              tiles into slots, under a budget
//   draw(...)                       shadow maps, terrain, what ground is seen, sky
//   read_image(target()) or HUD     by whoever wants them
//   end_frame()
#pragma once

#include <chrono>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/framebuffer.h"
#include "ridgeline/gl/program.h"
#include "ridgeline/gl/staging_ring.h"
#include "ridgeline/gl/texture.h"
#include "ridgeline/gl/timer_query.h"
#include "ridgeline/gl/vertex_array.h"
#include "ridgeline/io/store.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/render/disc_look.h"
#include "ridgeline/render/disc_surface.h"
#include "ridgeline/render/frame_fences.h"
#include "ridgeline/render/frame_uniforms.h"
#include "ridgeline/render/gpu_slots.h"
#include "ridgeline/render/ground_noise.h"
#include "ridgeline/render/ground_readback.h"
#include "ridgeline/render/height_texture.h"
#include "ridgeline/render/imagery_texture.h"
#include "ridgeline/render/mesh_surface.h"
#include "ridgeline/render/quadtree_look.h"
#include "ridgeline/render/quadtree_surface.h"
#include "ridgeline/render/shadow_cascades.h"
#include "ridgeline/render/shadow_maps.h"
#include "ridgeline/render/virtual_texture.h"
#include "ridgeline/select/selection.h"

namespace ridgeline::render {

// How tiles become triangles.
enum class Surface { mesh, disc, quadtree };
// The others take their heights from cached tiles.
constexpr bool samples_heights(Surface surface) { return surface != Surface::mesh; }
// Which surfaces a walk may draw; all: heights have memory of their own.
enum class Surfaces { mesh_only, all };

struct FrameOptions {
    glm::ivec2 size_px{1024, 768};
    Surfaces surfaces = Surfaces::mesh_only;
    QuadtreeOptions quadtree{};
    // Octaves of made ground below the source, up to detail::most_octaves; for surfaces that sample heights.
    int detail_octaves = 0;
    double detail_roughness = 1.0;
    // Of --gpu-cache; chunks take half of it, the other half is the imagery's, where the store has any. Where
    // the disc may be drawn, chunks give half of theirs to heights.
    std::uint64_t gpu_cache_bytes = 512_MiB;
    // What one frame may upload at most, but for its first tile.
    std::uint64_t upload_budget_bytes = 2_MiB;
    // Texels of a shadow map's side.
    int shadow_map_px = 2048;
};

enum class Fill { solid, wireframe };

// What a surface that samples heights is told beside the rest.
struct DiscSight {
    // The frame's, on the lattice of Frame::sampled_info().
    select::EyeFrame eye;
    Frustum visible;
    Box terrain_m;  // of everything that may be drawn
    double eye_above_ground_m = 2.0;
    double projection_px = 512.0;
    // The quadtree instead of the disc: how near its cells split.
    std::optional<select::CellRule> rule;
    // Its tiles turn over `fade` from what was drawn before; 0: they do not.
    pager::Seconds now{0.0}, fade{0.0};
    // Of heights, in the pager's count, that the frame wants: coarse before fine, each with its ancestors.
    std::span<const pager::NodeIndex> tiles;
    // Under the mesh: the source's finest nodes that cells draw in the chunks' place.
    std::span<const select::NearNode> near;
};

struct FrameScene {
    FrameView view;
    // Draws the disc or the quadtree instead of the mesh. With Surfaces::all.
    const DiscSight* disc = nullptr;
    // The mesh's, with made ground: as the quadtree's. With Surfaces::all and detail_octaves.
    const DiscSight* made = nullptr;
    const select::SelectionResult* selection = nullptr;
    const pager::Pager* pager = nullptr;
    // Those for which the selection's casters were found; null: no shadows. After allow_shadows().
    const ShadowCascades* shadows = nullptr;
    // The camera's: which ground the frame shows is read back. After allow_readback(). Null: it is not.
    const select::Sight* sight = nullptr;
    std::uint64_t number = 0;  // comes back with the GPU's time
    Fill fill = Fill::solid;
    // Imagery only where the store has it.
    Cover cover = Cover::tint;
    // The quadtree's level matrix is read back. After allow_level_matrix().
    bool reads_levels = false;
};

struct UploadCounters {
    std::uint64_t bytes = 0;
    std::uint64_t imagery_bytes = 0;  // of them, the page table's in
    std::uint64_t heights_bytes = 0;  // of them those to be sampled, likewise
    std::uint32_t tiles = 0;
};

class Frame {
  public:
    // `store` must outlive it. Errors: level 0 does not fit the cache, the GPU lacks memory or a shader
    // fails.
    static Result<Frame> create(const io::Store& store, const FrameOptions& options);

    // Makes the shadow maps and what draws them, once. They are no tiles and lie outside gpu_cache_bytes.
    Result<void> allow_shadows();

    // Makes the pass that reads back which ground is seen, once. lattice: as SeenGround has it.
    Result<void> allow_readback(const select::GroundLattice& lattice);

    // A new target; what was drawn is lost.
    Result<void> resize(const glm::ivec2& size_px);

    // Frames count upwards by one from 1.
    void begin_frame(std::uint32_t frame);
    // What the pager has ready, most urgent first, under the options' budget.
    UploadCounters upload(pager::Pager& pager) { return upload(pager, options_.upload_budget_bytes); }
    // Makes ground below the source where a frame wants it: a schedule's tiles. With detail_octaves.
    void make_detail(std::span<const select::ScheduledTile> wanted, const MadeMoment& moment,
                     pager::Pager& pager);
    // None of it is drawn any more.
    void forget_detail() { heights_->made()->forget_all(heights_->tiles()); }
    // All of it, waiting for the GPU where the staging ring is full: before the first frame.
    UploadCounters upload_all(pager::Pager& pager);
    void draw(const FrameScene& scene);
    void end_frame();
    // Waits until the GPU has drawn all that was asked of it. Not in a walk.
    void finish();

    // The disc as a frame with this eye would draw it, of the tiles that are there now; and as the last one
    // did. With Surfaces::all; until the next frame's uploads.
    DiscLook look_at_disc(const DiscSight& sight, const pager::Pager& pager);
    // The same of the quadtree. eye_m: the camera's.
    QuadtreeLook look_at_quadtree(const glm::dvec3& eye_m, const DiscSight& sight, const pager::Pager& pager);
    QuadtreeLook quadtree_look(const pager::Pager& pager) {
        return QuadtreeLook(disc_look(pager), *heights_, *quadtree_, pager, disc_eye_);
    }
    // The quadtree's where the mesh leaves the ground under the eye to it, as a frame with this eye would draw it; else
    // nothing.
    std::optional<QuadtreeLook> look_at_made(const glm::dvec3& eye_m, const DiscSight& sight,
                                             std::span<const select::DrawEntry> draws,
                                             const pager::Pager& pager);
    // As the last look_at_made() or draw() found it.
    const MadeRegion& made_region() const { return region_; }
    // Makes what reads the quadtree's level matrix back, once. With Surfaces::all.
    Result<void> allow_level_matrix() { return quadtree_->allow_level_matrix(); }
    const QuadtreeSurface& quadtree() const { return *quadtree_; }
    QuadtreeSurface& quadtree() { return *quadtree_; }
    // For tests: of the last frame that sampled heights.
    const select::EyeFrame& sampled_eye() const { return disc_eye_; }
    const HeightTexture& heights() const { return *heights_; }
    const shaders::DiscUniforms& heights_uniforms() const { return heights_->uniforms(); }
    DiscLook disc_look(const pager::Pager& pager) const { return DiscLook(*heights_, pager, disc_eye_); }

    const gl::Framebuffer& target() const { return target_.framebuffer; }
    const SurfaceCounters& surface_counters() const { return counters_; }
    // Of the shadow maps, all rings together; nothing where none were drawn.
    SurfaceCounters shadow_counters() const;
    std::uint64_t shadow_map_bytes() const { return shadow_maps_ ? shadow_maps_->bytes() : 0; }
    // After allow_readback(); whoever uses what it has read back polls it.
    GroundReader& ground_reader() { return *ground_reader_; }
    const GroundReader& ground_reader() const { return *ground_reader_; }
    std::uint64_t gpu_cache_bytes() const {
        return slots_.used_bytes() + gpu_imagery_bytes() + gpu_heights_bytes();
    }
    std::uint64_t gpu_cache_capacity_bytes() const {
        return slots_.capacity_bytes() + gpu_imagery_capacity_bytes() + gpu_heights_capacity_bytes();
    }
    // The ground of surfaces that sample heights: as the store's, with as many samples as made ground has.
    const io::TerrainInfo& sampled_info() const { return sampled_info_; }
    // How far made ground may lie beside the source's: detail::generous_displacement_m.
    double made_displacement_m() const { return detail::generous_displacement_m(info_, finer_); }
    // Null without made ground.
    const MadeTiles* made_tiles() const { return heights_ ? heights_->made() : nullptr; }
    // The part of both that heights have.
    std::uint64_t gpu_heights_bytes() const { return heights_ ? heights_->tiles().used_bytes() : 0; }
    std::uint64_t gpu_heights_capacity_bytes() const {
        return heights_ ? heights_->tiles().shape().total_bytes() : 0;
    }
    // Tiles of heights beyond level 0 that the GPU can hold; 0 where the disc may not be drawn.
    int height_slots() const { return heights_ ? heights_->tiles().shape().slots : 0; }
    // The imagery's part of both.
    std::uint64_t gpu_imagery_bytes() const { return imagery_ ? imagery_->tiles().used_bytes() : 0; }
    std::uint64_t gpu_imagery_capacity_bytes() const {
        return imagery_ ? imagery_->tiles().shape().total_bytes() : 0;
    }
    // Tiles of imagery beyond level 0 that the GPU can hold; 0 without imagery.
    int imagery_slots() const { return imagery_ ? imagery_->tiles().shape().slots : 0; }
    // Drawing times of earlier frames, in order; call until it gives nothing.
    std::optional<gl::TimerQuery::Measured> take_gpu_time() { return timer_.take(); }

  private:
    explicit Frame(const io::Store& store, const FrameOptions& options, GpuSlots slots, MeshSurface surface,
                   gl::StagingRing staging, gl::StagingRing ring);
    Result<void> load_passes();
    Result<void> load_imagery();
    Result<void> load_sampled();

    enum class Stored { yes, no_room, staging_full };
    UploadCounters upload(pager::Pager& pager, std::uint64_t budget_bytes);
    Stored store(pager::Pager& pager, const pager::Upload& upload);
    Stored store_chunk(pager::Pager& pager, const pager::Upload& upload);
    Stored store_tile(VirtualTexture& texture, pager::Pager& pager, const pager::Upload& upload);
    // Null for chunks, and for kinds that the frame does not draw.
    VirtualTexture* texture_of(pager::TileKind kind);
    // Gives back the slots of tiles that have left the pager's memory.
    void release_left(pager::Pager& pager);
    // A tile of the source leaves its slot.
    void forget_made_of(pager::GpuSlot slot, const pager::Pager& pager);
    bool parent_is_resident(const pager::Pager& pager, pager::NodeIndex node) const;
    bool make_room(pager::Pager& pager, const pager::Upload& upload);
    bool make_room(VirtualTexture& texture, pager::Pager& pager, const pager::Upload& upload);
    template <class Prepare>
    void with_room(Prepare prepare);
    void draw_shadow_maps(const FrameScene& scene);
    void prepare_imagery(const FrameScene& scene);
    void draw_mesh(const FrameScene& scene, Cover cover);
    void prepare_heights(const DiscSight& sight, const pager::Pager& pager);
    void draw_disc(const FrameScene& scene, Cover cover);
    void draw_quadtree(const FrameScene& scene, Cover cover);
    QuadtreeScene quadtree_scene(const glm::dvec3& eye_m, const DiscSight& sight, const MadeRegion* region,
                                 const pager::Pager& pager);
    void prepare_made(const FrameScene& scene);
    void gather_tiles(std::span<const pager::NodeIndex> wanted, const MadeRegion* region,
                      const pager::Pager& pager);
    void add_tile(const pager::Pager& pager, pager::NodeIndex tile);
    void add_made_tile(io::NodeId node, std::uint32_t slot);
    void bind_uniforms(const FrameView& view, const io::TerrainInfo& info);
    void bind_sampled_uniforms(const FrameScene& scene);
    void draw_terrain(const FrameScene& scene);
    void draw_sky();

    const io::Store* store_;
    io::TerrainInfo info_;
    io::Grid grid_;
    detail::FinerGround finer_;
    io::TerrainInfo sampled_info_;
    FrameOptions options_;
    GpuSlots slots_;
    MeshSurface surface_;
    std::optional<ShadowMaps> shadow_maps_;
    std::optional<GroundReader> ground_reader_;
    std::optional<ImageryTexture> imagery_;
    std::optional<HeightTexture> heights_;
    std::optional<DiscSurface> disc_;
    std::optional<QuadtreeSurface> quadtree_;
    std::vector<SlottedTile> slotted_;
    MadeRegion region_;
    select::EyeFrame disc_eye_;
    SurfaceCounters counters_;
    gl::StagingRing staging_;  // tiles on their way
    gl::StagingRing ring_;     // uniforms, instances, commands
    gl::RenderTarget target_;
    gl::Program sky_;
    gl::VertexArray no_vertices_;
    gl::Texture2D noise_;
    gl::Sampler noise_sampler_;
    gl::TimerQuery timer_;
    FrameFences fences_;
    std::uint32_t frame_ = 0;
    bool shadows_drawn_ = false;
};

}  // namespace ridgeline::render
