// The terrain as a walk shows it: pager, selection and frame, stepped together in the one order that keeps
// every frame whole.
//
//   begin ─► uploads ─► selection (a job) ─► eye lift ─► touch, hold back, request ─► draw ─► end
//              ▲                                │ lifted: select again                        │
//              └── until settled, where a frame waits for its tiles ◄── other ground is seen ──┘
//
// Where a texture over the ground is scheduled, its tiles are chosen in the selection's job, from the ground
// that an earlier frame saw; a frame that waits for its tiles is drawn again when its own ground chooses
// others.
//
// Each frame is drawn from a selection made for its own eye. Render thread only; it waits for its selection
// and, when asked to, for tiles. The store and the job system must outlive it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "ridgeline/base/result.h"
#include "ridgeline/jobs/job_system.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/render/frame.h"
#include "ridgeline/select/criterion.h"
#include "ridgeline/select/ground_schedule.h"
#include "ridgeline/select/ground_source.h"
#include "ridgeline/select/selection.h"
#include "ridgeline/stage/horizon_survey.h"
#include "ridgeline/stage/tile_wants.h"
#include "ridgeline/telemetry/trace.h"

namespace ridgeline::stage {

enum class TileWait { never, settle };

struct StageOptions {
    render::FrameOptions frame;
    pager::PagerOptions pager;
    std::string criterion = "screen_error";
    select::CriterionOptions criterion_options{};
    double pixel_error = 1.0;
    select::HorizonMode horizon = select::HorizonMode::ridges;
    // settle: every frame waits until nothing more can arrive for it, and morphs by time are at their end.
    TileWait wait = TileWait::never;
    // Raised by whoever wants the walk to end: a frame then waits no longer. May be null.
    const std::atomic<bool>* stop = nullptr;
    select::CasterSet shadows = select::CasterSet::none;
    // Its tiles are chosen in every frame; a store's imagery takes its place.
    std::optional<select::ScheduledTexture> scheduled;
    telemetry::Trace* trace = nullptr;
};

// What a frame shows.
struct StageMoment {
    std::uint64_t number = 0;
    platform::Camera camera;
    double exaggeration = 1.0;
    // How the camera moves; what it may reveal soon is paged ahead.
    double speed_m_per_s = 0.0;
    Angle turn_per_second;
    pager::Seconds now{0.0};
    render::Daylight daylight;
    std::optional<render::PlainBackground> background;
    render::Fill fill = render::Fill::solid;
    // Imagery where the store has it; tint: nothing of it is asked for.
    render::Cover cover = render::Cover::imagery;
    // The disc only with FrameOptions::surfaces; under the mesh, no heights are asked for.
    render::Surface surface = render::Surface::mesh;
    // Ground below the source, with FrameOptions::detail_octaves and a surface that samples heights.
    bool detail = true;
    // The quadtree's level matrix comes back (level_matrix()). After allow_level_matrix().
    bool reads_levels = false;
};

// What a frame may make of ground below the source: some tenth of its time in software (docs/detail.md).
constexpr int kMadeTilesPerFrame = 4;

// How many pixels a sample of the disc's heights may cover: as few as their normals want, and never coarser
// than the rings, for which one of twice their spacing would be too coarse as far as they reach.
double heights_pixel_error_px(double projection_px, double pixel_error_px);

// The same of made tiles.
double made_pixel_error_px(double projection_px, double pixel_error_px);

// The camera as selection knows it, at rest.
select::Camera selection_camera(const platform::Camera& camera);

// What a frame cost.
struct StageReport {
    double eye_lift_m = 0.0;
    double selection_ms = 0.0;       // the job's own time
    double schedule_ms = 0.0;        // ... and of it what choosing the texture's tiles took
    double selection_wait_ms = 0.0;  // from submitting it to having its result
    double upload_ms = 0.0;
    double make_ms = 0.0;  // of the render thread, giving commands for made ground; in software, making it
    double draw_ms = 0.0;  // of the render thread, giving commands
    std::uint64_t bytes_uploaded = 0;
    std::uint64_t imagery_bytes_uploaded = 0;  // of them
    std::uint64_t heights_bytes_uploaded = 0;  // of them, to be sampled: not the chunks'
    std::size_t imagery_wanted = 0;            // tiles, ancestors included
    std::size_t imagery_missing = 0;
    std::size_t heights_wanted = 0;  // likewise, for the disc
    std::size_t heights_missing = 0;
    // How many frames ago the ground was seen by which tiles were chosen; nothing without a readback yet.
    std::optional<std::uint64_t> readback_age;
    std::uint64_t readback_stalls = 0;
    std::size_t tiles_scheduled = 0;
    select::SelectionCounters selection;
    render::SurfaceCounters surface;
    render::SurfaceCounters shadow;  // of the shadow maps
};

// The ground under a place, as the last frame had it.
struct GroundBelow {
    double mesh_m = 0.0;   // of the finest chunk that is there, unmorphed, in the drawn frame
    double drawn_m = 0.0;  // as drawn
    int level = 0;
};

// The pager's chunks, which stand still while selection has its lease.
class PagedGround final : public select::GroundSource {
  public:
    explicit PagedGround(const pager::Pager& pager) : pager_(pager) {}
    io::ChunkView chunk(std::uint32_t index) const override { return pager_.chunk(index); }

  private:
    const pager::Pager& pager_;
};

class TerrainStage {
  public:
    // Reads level 0; nothing is shown before it is there.
    static Result<std::unique_ptr<TerrainStage>> create(const io::Store& store, jobs::JobSystem& jobs,
                                                        const StageOptions& options);

    // Draws what is there once and waits for the GPU, leaving no trace in the figures. Drivers compile
    // programs and lay out buffers at the first draw (0.2 s of an NVIDIA driver's): before the first frame
    // that counts.
    void rehearse(const StageMoment& moment);
    // Draws one frame into target().
    StageReport show(const StageMoment& moment);
    Result<void> resize(const glm::ivec2& size_px) { return frame_.resize(size_px); }
    // From the next frame on; where it fails, nothing changes.
    Result<void> set_shadows(select::CasterSet shadows);
    // Makes what reads the quadtree's level matrix back, once. With FrameOptions::surfaces.
    Result<void> allow_level_matrix() { return frame_.allow_level_matrix(); }
    // Of the quadtree, some frames ago; null where none has arrived.
    const render::LevelMatrix* level_matrix() { return frame_.quadtree().level_matrix(); }
    // Of the quadtree's cells alone, from the next frame on: what they cost while tiles stay as they are.
    void set_cell_pixel_error(double pixels) { cell_pixel_error_ = pixels; }
    // Null without it: for benches, which switch it on.
    render::QuadtreePassClock* pass_clock() { return frame_.quadtree().pass_clock(); }
    void time_passes();
    // From the next frame on.
    void set_horizon(select::HorizonMode horizon) { options_.horizon = horizon; }

    const gl::Framebuffer& target() const { return frame_.target(); }
    // What it is drawn by: its ground, and more for tests.
    const render::Frame& frame() const { return frame_; }
    // Nothing outside the terrain, before the first frame, and where the chunk has left memory since the last
    // one.
    std::optional<GroundBelow> ground_below(const glm::dvec2& east_north_m);
    // What the last frame's selection made of the ground, seen as `moment` says; after a frame. What the
    // scene points to stays until the next one.
    void survey(const StageMoment& moment, HorizonScene& scene);

    const pager::Pager& pager() const { return pager_; }
    // Null where no texture is scheduled. Of the last frame that scheduled its tiles.
    const select::TileScheduleResult* schedule() const { return schedule_ ? &schedule_->result() : nullptr; }
    // What the GPU saw of the ground last, null before it has arrived, and what reading it back came to.
    const select::GroundReadback* seen_ground() const {
        return schedule_ ? frame_.ground_reader().newest() : nullptr;
    }
    render::GroundReaderCounters readback_counters() const {
        return schedule_ ? frame_.ground_reader().counters() : render::GroundReaderCounters{};
    }
    const select::SelectionResult& selection() const { return selection_.result(); }
    select::CasterSet shadows() const { return options_.shadows; }
    select::HorizonMode horizon() const { return options_.horizon; }
    std::uint64_t shadow_map_bytes() const { return frame_.shadow_map_bytes(); }
    std::uint64_t gpu_cache_bytes() const { return frame_.gpu_cache_bytes(); }
    std::uint64_t gpu_cache_capacity_bytes() const { return frame_.gpu_cache_capacity_bytes(); }
    std::uint64_t gpu_imagery_bytes() const { return frame_.gpu_imagery_bytes(); }
    std::uint64_t gpu_imagery_capacity_bytes() const { return frame_.gpu_imagery_capacity_bytes(); }
    std::uint64_t gpu_heights_bytes() const { return frame_.gpu_heights_bytes(); }
    std::uint64_t gpu_heights_capacity_bytes() const { return frame_.gpu_heights_capacity_bytes(); }
    bool has_disc() const { return heights_wants_.has_value(); }
    // Whether made ground is shown.
    bool draws_detail() const { return detail_ && frame_.made_tiles(); }
    bool has_imagery() const { return imagery_wants_.has_value(); }
    std::optional<gl::TimerQuery::Measured> take_gpu_time() { return frame_.take_gpu_time(); }

  private:
    TerrainStage(const io::Store& store, jobs::JobSystem& jobs, const StageOptions& options,
                 pager::Pager pager, render::Frame frame, std::unique_ptr<select::Criterion> criterion);

    // One turn of the loop above, but for the drawing; `camera` comes back lifted.
    void step(const StageMoment& moment, platform::Camera& camera, StageReport& report);
    void step_until_settled(const StageMoment& moment, platform::Camera& camera, StageReport& report);
    // Whether anything asks for the tiles of the texture over the ground, of the heights, of either.
    bool schedules_texture(const StageMoment& moment) const;
    bool schedules_heights(const StageMoment& moment) const;
    bool schedules(const StageMoment& moment) const;
    // Whether the mesh leaves ground to what is made of it.
    bool mesh_has_detail(const StageMoment& moment) const;
    double beside_finest_m(double exaggeration) const;
    // How near the eye ground may be made, or may be soon; and how near chunks may lie beside such ground: cells take the
    // place of none that meets a coarser one.
    select::NodeReach made_reach(const select::View& view) const;
    double beside_made_m(const select::View& view) const;
    bool sees_other_ground();
    bool stopped() const;
    bool detail_is_settled(const StageMoment& moment) const;
    bool is_settled(const StageMoment& moment, int& quiet_steps) const;
    void upload(StageReport& report);
    // Of made tiles, and of errors that begin to count.
    pager::Seconds detail_fade() const;
    void make_detail(const StageMoment& moment, StageReport& report);
    void select_lifted(const StageMoment& moment, platform::Camera& camera, StageReport& report);
    void select(const StageMoment& moment, const platform::Camera& camera, const pager::SelectionLease& lease,
                StageReport& report);
    void run_selection(const StageMoment& moment, const select::View& view, const select::Sight* sight,
                       const pager::SelectionLease& lease, StageReport& report);
    select::View view_of(const StageMoment& moment, const platform::Camera& camera);
    void request_wanted(const StageMoment& moment, StageReport& report);
    // Of the last frame's surface, over the eye; nothing of the mesh.
    std::optional<double> sampled_height_m(const glm::dvec2& east_north_m);
    // Puts a schedule's tiles on the wanted list and keeps those that are there.
    struct Wanted {
        std::size_t tiles = 0, missing = 0;
    };
    Wanted want(const TileWants& wants);
    Box sampled_bounds(double exaggeration) const;
    render::DiscSight disc_sight(const StageMoment& moment, const platform::Camera& camera) const;
    select::CellRule cell_rule(const select::View& view) const;
    double lift_m(const StageMoment& moment, const platform::Camera& camera,
                  const pager::SelectionLease& lease);
    double lift_over_made_m(const platform::Camera& camera, const render::DiscSight& sight);
    void draw(const StageMoment& moment, const platform::Camera& camera, StageReport& report);

    const io::Store& store_;
    jobs::JobSystem& jobs_;
    StageOptions options_;
    std::unique_ptr<select::Criterion> criterion_;
    pager::Pager pager_;
    PagedGround ground_;
    select::Selection selection_;
    std::optional<select::GroundSchedule> schedule_;
    select::GroundReadback scheduled_by_;  // where frames wait: by which the last schedule was made
    std::optional<TileWants> imagery_wants_;
    std::optional<select::GroundSchedule> heights_schedule_;
    std::optional<TileWants> heights_wants_;
    // Of the last selection: of which ground may be made under the mesh; so many at a time that their tiles leave most of
    // the slots to what is seen.
    std::vector<select::NearNode> near_;
    std::size_t most_near_ = 0;
    render::Surface surface_ = render::Surface::mesh;  // of the last frame
    bool detail_ = true;                               // likewise
    double cell_pixel_error_;                          // of the quadtree
    double finest_error_m_;                            // of the finest chunks
    render::Frame frame_;
    render::ShadowCascades cascades_;  // of the last selection
    std::vector<pager::NodeIndex> wanted_;
    HorizonSurvey survey_;
    double eye_height_m_ = 0.0;        // of the last frame
    double eye_above_ground_m_ = 2.0;  // over the ground that the last selection had there
    std::uint64_t stalls_before_ = 0;  // of the ground's readback, until the last frame's end
    std::uint32_t step_ = 0;
};

}  // namespace ridgeline::stage
