#include "ridgeline/stage/terrain_stage.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include "ridgeline/gl/capabilities.h"
#include "ridgeline/pager/ram_ring.h"
#include "ridgeline/select/drawn_surface.h"
#include "ridgeline/select/finest_nodes.h"
#include "ridgeline/shaders/lib/disc.h"
#include "ridgeline/shaders/shared/quadtree_blocks.h"
#include "ridgeline/stage/eye_lift.h"
#include "ridgeline/telemetry/clock.h"

namespace ridgeline::stage {
namespace {

using telemetry::milliseconds;
using telemetry::now_ns;

// More than the levels of a terrain: each step can reveal another level.
constexpr int kMostQuietSteps = 32;
// The second look at the ground finds what the first one did; more would help nobody.
constexpr int kMostLooks = 4;
constexpr std::chrono::microseconds kWaitingPause{200};
constexpr int kNoBudget = 1 << 20;
// Of which its own tile takes one, and those beside it that others do not want.
constexpr std::size_t kSlotsPerNearNode = 8;
// Over which it turns into itself, octave after octave.
constexpr pager::Seconds kMadeFade{0.25};

// As many tiles as could ever be in memory: what is cut from the list could not have come.
std::size_t wanted_capacity(const StageOptions& options) {
    return std::max<std::size_t>(select::SelectionOptions{}.wanted_capacity,
                                 options.pager.ram_bytes / pager::RamRing::kPageBytes);
}

double finest_error_m(const io::Store& store) {
    double most_m = 0.0;
    const auto finest =
        store.records().subspan(static_cast<std::size_t>(store.grid().first(store.grid().finest())));
    for (const io::NodeRecord& record : finest)
        most_m = std::max(most_m, static_cast<double>(record.error_m));
    return most_m;
}

// What is stretched is as wrong as that much coarser samples: the quadtree's cells count their errors as they are drawn.
select::View heights_view(const select::View& view, render::Surface surface) {
    select::View heights = view;
    const double stretch = surface == render::Surface::disc ? 1.0 : std::max(view.exaggeration, 1.0);
    heights.pixel_error_px = heights_pixel_error_px(view.projection_px, view.pixel_error_px / stretch);
    return heights;
}

}  // namespace

double heights_pixel_error_px(double projection_px, double pixel_error_px) {
    const double for_normals = static_cast<double>(shaders::kNormalPixels) * pixel_error_px;
    const double for_rings = 2.0 * projection_px / static_cast<double>(shaders::kDiscMorphEnd);
    return std::min(for_normals, for_rings);
}

double made_pixel_error_px(double projection_px, double pixel_error_px) {
    const double for_rings = 2.0 * projection_px / static_cast<double>(shaders::kDiscMorphEnd);
    return std::min(static_cast<double>(shaders::kMadePixels) * pixel_error_px, for_rings);
}

select::Camera selection_camera(const platform::Camera& camera) {
    select::Camera seen_by;
    seen_by.eye_m = camera.pose.eye_m;
    seen_by.right = platform::right(camera.pose);
    seen_by.up = platform::up(camera.pose);
    seen_by.forward = platform::forward(camera.pose);
    seen_by.horizontal_field = camera.lens.horizontal_fov;
    seen_by.width_px = camera.lens.size_px.x;
    seen_by.height_px = camera.lens.size_px.y;
    seen_by.near_m = camera.lens.near_m;
    return seen_by;
}

Result<std::unique_ptr<TerrainStage>> TerrainStage::create(const io::Store& store, jobs::JobSystem& jobs,
                                                           const StageOptions& options) {
    auto criterion = select::make_criterion(options.criterion, options.criterion_options);
    if (!criterion) return criterion.error();
    auto pager_options = options.pager;
    if (options.wait == TileWait::settle) pager_options.fade = pager::Seconds(0.0);
    const auto heights = options.frame.surfaces == render::Surfaces::all ? pager::HeightsTiles::paged
                                                                         : pager::HeightsTiles::none;
    auto pager = pager::Pager::create(pager::tile_source(store, heights), jobs, pager_options);
    if (!pager) return pager.error();
    auto frame = render::Frame::create(store, options.frame);
    if (!frame) return frame.error();
    RIDGELINE_TRY(pager->load_level0());
    std::unique_ptr<TerrainStage> stage(new TerrainStage(store, jobs, options, std::move(pager).value(),
                                                         std::move(frame).value(),
                                                         std::move(criterion).value()));
    RIDGELINE_TRY(stage->set_shadows(options.shadows));
    // Opening the store checked every record, and the pager looked for the largest payload.
    store.forget_records();
    // Both see the same ground.
    const auto& schedule = stage->schedule_ ? stage->schedule_ : stage->heights_schedule_;
    if (schedule) RIDGELINE_TRY(stage->frame_.allow_readback(schedule->lattice()));
    return stage;
}

TerrainStage::TerrainStage(const io::Store& store, jobs::JobSystem& jobs, const StageOptions& options,
                           pager::Pager pager, render::Frame frame,
                           std::unique_ptr<select::Criterion> criterion)
    : store_(store),
      jobs_(jobs),
      options_(options),
      criterion_(std::move(criterion)),
      pager_(std::move(pager)),
      ground_(pager_),
      selection_(store.info(), store.records(), *criterion_,
                 {.wanted_capacity = wanted_capacity(options), .jobs = &jobs}),
      cell_pixel_error_(options.pixel_error),
      finest_error_m_(finest_error_m(store)),
      frame_(std::move(frame)) {
    const auto slots = static_cast<std::size_t>(frame_.imagery_slots());
    const auto height_slots = static_cast<std::size_t>(frame_.height_slots());
    wanted_.reserve(wanted_capacity(options) + slots + height_slots +
                    pager_.tiles().root_count(pager::TileKind::heights));
    if (options.frame.surfaces == render::Surfaces::all) {
        heights_wants_.emplace(pager_.tiles(), pager::TileKind::heights, height_slots);
        most_near_ = height_slots / kSlotsPerNearNode;
        heights_schedule_.emplace(store.info(), store.records(),
                                  select::ScheduledTexture{select::heights_tree(store.info(), store.records(),
                                                                                options.frame.detail_octaves),
                                                           TileWants::schedule_capacity(height_slots)});
    }
    if (store.info().imagery) {
        imagery_wants_.emplace(pager_.tiles(), pager::TileKind::imagery, slots);
        options_.scheduled = {select::imagery_tree(*store.info().imagery, store.imagery_records()),
                              TileWants::schedule_capacity(slots)};
    }
    if (options_.scheduled)
        schedule_.emplace(store.info(), store.records(), *std::exchange(options_.scheduled, std::nullopt));
}

Result<void> TerrainStage::set_shadows(select::CasterSet shadows) {
    if (shadows != select::CasterSet::none) RIDGELINE_TRY(frame_.allow_shadows());
    options_.shadows = shadows;
    return {};
}

void TerrainStage::time_passes() { frame_.quadtree().time_passes(gl::query_capabilities().software); }

void TerrainStage::rehearse(const StageMoment& moment) {
    StageReport report;
    platform::Camera camera = moment.camera;
    step(moment, camera, report);
    draw(moment, camera, report);
    frame_.finish();
    while (frame_.take_gpu_time()) {
    }
}

StageReport TerrainStage::show(const StageMoment& moment) {
    StageReport report;
    platform::Camera camera;
    int looks = 0;
    do {
        step_until_settled(moment, camera, report);
        draw(moment, camera, report);
    } while (options_.wait == TileWait::settle && ++looks < kMostLooks && schedules(moment) &&
             sees_other_ground());
    eye_height_m_ = camera.pose.eye_m.z;
    return report;
}

void TerrainStage::step_until_settled(const StageMoment& moment, platform::Camera& camera,
                                      StageReport& report) {
    camera = moment.camera;
    step(moment, camera, report);
    int quiet_steps = 0;
    while (options_.wait == TileWait::settle && !is_settled(moment, quiet_steps) && !stopped()) {
        frame_.end_frame();
        std::this_thread::sleep_for(kWaitingPause);
        camera = moment.camera;
        step(moment, camera, report);
    }
}

// A store's imagery is the texture of its stage, and can be switched off.
bool TerrainStage::schedules_texture(const StageMoment& moment) const {
    return schedule_ && (!imagery_wants_ || moment.cover == render::Cover::imagery);
}

bool TerrainStage::schedules_heights(const StageMoment& moment) const {
    return heights_schedule_ && (render::samples_heights(moment.surface) || mesh_has_detail(moment));
}

bool TerrainStage::mesh_has_detail(const StageMoment& moment) const {
    return moment.surface == render::Surface::mesh && moment.detail && frame_.made_tiles();
}

// What is made of the source, and what chunks miss of it.
double TerrainStage::beside_finest_m(double exaggeration) const {
    return exaggeration * (frame_.made_displacement_m() + finest_error_m_);
}

select::NodeReach TerrainStage::made_reach(const select::View& view) const {
    const io::TerrainInfo& info = store_.info();
    const double spacing_m = std::max(info.spacing_x_m, info.spacing_y_m);
    const double made_m =
        spacing_m * view.projection_px / made_pixel_error_px(view.projection_px, options_.pixel_error);
    // Tiles are wanted by depth, which is less than the distance at the picture's corners.
    const double least_m = made_m / std::max(view.picture.cos_half_angle, 0.25) + view.extension.margin_m;
    // Chunks change hands where that moves ground by a pixel error at most, however crude or stretched they are, within
    // reason.
    return {.least_m = least_m,
            .most_m = 4.0 * least_m,
            .by_error = view.exaggeration * view.projection_px / view.pixel_error_px};
}

double TerrainStage::beside_made_m(const select::View& view) const {
    const io::TerrainInfo& info = store_.info();
    const glm::dvec2 side_m =
        static_cast<double>(store_.grid().quads()) * glm::dvec2(info.spacing_x_m, info.spacing_y_m);
    return made_reach(view).least_m + glm::length(side_m);
}

bool TerrainStage::schedules(const StageMoment& moment) const {
    return schedules_texture(moment) || schedules_heights(moment);
}

// Waits for the ground of the frame that was just drawn. Which ground is seen does not depend on a texture's
// tiles.
bool TerrainStage::sees_other_ground() {
    render::GroundReader& reader = frame_.ground_reader();
    while (reader.in_flight() > 0 && !stopped()) {
        std::this_thread::sleep_for(kWaitingPause);
        reader.poll();
    }
    const select::GroundReadback* seen = reader.newest();
    return seen && !stopped() && !seen->shows_the_same(scheduled_by_);
}

bool TerrainStage::stopped() const { return options_.stop && options_.stop->load(std::memory_order_relaxed); }

bool TerrainStage::detail_is_settled(const StageMoment& moment) const {
    return !frame_.made_tiles() || !schedules_heights(moment) || !moment.detail ||
           frame_.made_tiles()->settled(heights_schedule_->result().tiles);
}

// Neither tiles nor what selection assumes of missing ones may still change. With all tiles there,
// assumptions come to rest in a few steps; tiles that never come could keep them changing.
bool TerrainStage::is_settled(const StageMoment& moment, int& quiet_steps) const {
    if (!pager_.settled() || !detail_is_settled(moment)) {
        quiet_steps = 0;
        return false;
    }
    return !selection_.result().unsettled || ++quiet_steps > kMostQuietSteps;
}

void TerrainStage::step(const StageMoment& moment, platform::Camera& camera, StageReport& report) {
    ++step_;
    report = {.bytes_uploaded = report.bytes_uploaded,
              .imagery_bytes_uploaded = report.imagery_bytes_uploaded,
              .heights_bytes_uploaded = report.heights_bytes_uploaded,
              .readback_age = {},
              .selection = {},
              .surface = {},
              .shadow = {}};
    frame_.begin_frame(step_);
    if (schedule_ || heights_schedule_) frame_.ground_reader().poll();
    pager_.begin_frame(static_cast<std::uint32_t>(moment.number), moment.now);
    upload(report);
    make_detail(moment, report);
    select_lifted(moment, camera, report);
    request_wanted(moment, report);
}

void TerrainStage::upload(StageReport& report) {
    const telemetry::TraceScope trace(options_.trace, "upload");
    const std::int64_t start_ns = now_ns();
    // Before the first frame, and while a frame waits for tiles, there is no hurry but the disk's.
    const bool at_leisure = step_ == 1 || options_.wait == TileWait::settle;
    const auto counters = at_leisure ? frame_.upload_all(pager_) : frame_.upload(pager_);
    report.bytes_uploaded += counters.bytes;
    report.imagery_bytes_uploaded += counters.imagery_bytes;
    report.heights_bytes_uploaded += counters.heights_bytes;
    report.upload_ms = milliseconds(now_ns() - start_ns);
}

pager::Seconds TerrainStage::detail_fade() const {
    return options_.wait == TileWait::settle ? pager::Seconds(0.0) : std::min(kMadeFade, options_.pager.fade);
}

// What the last selection asked for: this one may not change while it runs.
void TerrainStage::make_detail(const StageMoment& moment, StageReport& report) {
    if (!frame_.made_tiles()) return;
    if (!moment.detail || !schedules_heights(moment)) return frame_.forget_detail();
    const std::int64_t start_ns = now_ns();
    frame_.make_detail(heights_schedule_->result().tiles,
                       {.now = moment.now,
                        .fade = detail_fade(),
                        .budget = options_.wait == TileWait::settle ? kNoBudget : kMadeTilesPerFrame},
                       pager_);
    report.make_ms = milliseconds(now_ns() - start_ns);
}

void TerrainStage::select_lifted(const StageMoment& moment, platform::Camera& camera, StageReport& report) {
    if (const auto ground = ground_below(glm::dvec2(camera.pose.eye_m)))
        eye_above_ground_m_ = std::max(camera.pose.eye_m.z - ground->mesh_m, kClearance_m);
    const auto lease = pager_.lend_to_selection();
    select(moment, camera, lease, report);
    for (int i = 0; i < kMostLifts; ++i) {
        const double lifted_m = lift_m(moment, camera, lease);
        if (lifted_m == 0.0) return;
        camera.pose.eye_m.z += lifted_m;
        report.eye_lift_m += lifted_m;
        select(moment, camera, lease, report);
    }
}

double TerrainStage::lift_m(const StageMoment& moment, const platform::Camera& camera,
                            const pager::SelectionLease& lease) {
    const bool mesh = moment.surface == render::Surface::mesh;
    const double over_mesh_m = mesh ? eye_lift_m(selection_, lease.snapshot(), ground_) : 0.0;
    if (mesh && !mesh_has_detail(moment)) return over_mesh_m;
    const render::DiscSight sight = disc_sight(moment, camera);
    if (mesh) return std::max(over_mesh_m, lift_over_made_m(camera, sight));
    if (moment.surface == render::Surface::disc)
        return sampled_eye_lift_m(frame_.look_at_disc(sight, pager_));
    return sampled_eye_lift_m(frame_.look_at_quadtree(camera.pose.eye_m, sight, pager_));
}

double TerrainStage::lift_over_made_m(const platform::Camera& camera, const render::DiscSight& sight) {
    const auto look = frame_.look_at_made(camera.pose.eye_m, sight, selection_.result().draws, pager_);
    return look ? sampled_eye_lift_m(*look) : 0.0;
}

void TerrainStage::select(const StageMoment& moment, const platform::Camera& camera,
                          const pager::SelectionLease& lease, StageReport& report) {
    const bool schedules_tiles = schedules(moment);
    const select::GroundReadback* late = schedules_tiles ? frame_.ground_reader().newest() : nullptr;
    const select::Sight sight = select::sight_of(selection_camera(camera));
    const select::View view = view_of(moment, camera);
    if (heights_schedule_)
        heights_schedule_->choose_made(
            moment.detail ? std::optional(made_pixel_error_px(view.projection_px, options_.pixel_error))
                          : std::nullopt);
    run_selection(moment, view, schedules_tiles ? &sight : nullptr, lease, report);
    near_.clear();
    if (mesh_has_detail(moment))
        select::find_finest_within(store_.info(), store_.records(), view, made_reach(view), most_near_,
                                   near_);
    if (schedules_heights(moment))
        heights_wants_->gather(heights_schedule_->result().tiles, near_, store_.records());
    if (imagery_wants_ && schedules_texture(moment)) imagery_wants_->gather(schedule_->result().tiles);
    if (!late) return;
    report.readback_age = moment.number - late->frame;
    if (options_.wait == TileWait::settle) scheduled_by_ = *late;
}

// sight: null where nothing is scheduled.
void TerrainStage::run_selection(const StageMoment& moment, const select::View& view,
                                 const select::Sight* sight, const pager::SelectionLease& lease,
                                 StageReport& report) {
    const std::int64_t start_ns = now_ns();
    std::int64_t job_ns = 0, schedule_ns = 0;
    jobs::Counter counter;
    const auto job = [this, &moment, &view, sight, &lease, &job_ns, &schedule_ns] {
        const telemetry::TraceScope trace(options_.trace, "selection");
        const std::int64_t job_start_ns = now_ns();
        const select::SelectionResult& selected = selection_.run(view, lease.snapshot(), &ground_);
        const std::int64_t selected_ns = now_ns();
        const select::GroundReadback* late = sight ? frame_.ground_reader().newest() : nullptr;
        if (schedules_texture(moment)) schedule_->run(view, *sight, selected, late);
        if (schedules_heights(moment))
            heights_schedule_->run(heights_view(view, moment.surface), *sight, selected, late);
        job_ns = now_ns() - job_start_ns;
        schedule_ns = now_ns() - selected_ns;
    };
    jobs_.submit(job, &counter, jobs::Priority::urgent);
    jobs_.wait(counter, jobs::Help::urgent_only);
    report.selection_ms += milliseconds(job_ns);
    report.schedule_ms += milliseconds(schedule_ns);
    report.selection_wait_ms += milliseconds(now_ns() - start_ns);
}

select::View TerrainStage::view_of(const StageMoment& moment, const platform::Camera& camera) {
    select::Camera moving = selection_camera(camera);
    moving.speed_m_per_s = moment.speed_m_per_s;
    moving.turn_per_second = moment.turn_per_second;
    select::View view = select::make_view(
        moving, {.pixel_error_px = options_.pixel_error,
                 .exaggeration = moment.exaggeration,
                 .eye_above_ground_m = eye_above_ground_m_,
                 .horizon = options_.horizon,
                 .beside_finest_m = mesh_has_detail(moment) ? beside_finest_m(moment.exaggeration) : 0.0});
    // By what make_view() has found.
    if (mesh_has_detail(moment)) view.finest_within_m = beside_made_m(view);
    if (options_.shadows == select::CasterSet::none) return view;
    const io::TerrainInfo& info = store_.info();
    cascades_ = render::shadow_cascades(
        {.camera = camera,
         .daylight = moment.daylight,
         .terrain_m = select::drawn_bounds(info, store_.records(), moment.exaggeration),
         .spacing_m = std::max(info.spacing_x_m, info.spacing_y_m),
         .map_px = options_.frame.shadow_map_px});
    view.sun = render::sun_view(cascades_, options_.shadows);
    return view;
}

std::optional<GroundBelow> TerrainStage::ground_below(const glm::dvec2& east_north_m) {
    if (step_ == 0) return {};
    const glm::dvec2 place = store_.info().lattice(east_north_m.x, east_north_m.y);
    const auto lease = pager_.lend_to_selection();
    select::DrawEntry entry;
    if (!selection_.entry_at(place.x, place.y, lease.snapshot(), entry)) return {};
    const io::ChunkView chunk = pager_.chunk(entry.index);
    if (!chunk) return {};
    const auto triangle = select::locate(chunk, entry, selection_.grid(), place.x, place.y);
    if (!triangle) return {};
    const select::EyeFrame& eye = selection_.result().eye;
    const double quantum_m = static_cast<double>(eye.quantum_m);
    const std::optional<double> sampled_m = sampled_height_m(east_north_m);
    const double drawn_m =
        eye_height_m_ + (sampled_m ? *sampled_m : select::drawn_height_m(chunk, eye, entry, *triangle));
    return GroundBelow{
        .mesh_m = store_.info().height_offset_m + quantum_m * select::mesh_quanta(chunk, *triangle),
        .drawn_m = drawn_m,
        .level = entry.node.level};
}

std::optional<double> TerrainStage::sampled_height_m(const glm::dvec2& east_north_m) {
    const glm::dvec2 place = frame_.sampled_info().lattice(east_north_m.x, east_north_m.y);
    if (surface_ == render::Surface::disc) return frame_.disc_look(pager_).height_m(place);
    if (surface_ == render::Surface::quadtree) return frame_.quadtree_look(pager_).height_m(place);
    const glm::dvec2 source_place = store_.info().lattice(east_north_m.x, east_north_m.y);
    if (detail_ && frame_.made_tiles() && frame_.made_region().concerns_place(source_place))
        return frame_.quadtree_look(pager_).height_m(place);
    return {};
}

void TerrainStage::survey(const StageMoment& moment, HorizonScene& scene) {
    platform::Camera camera = moment.camera;
    camera.pose.eye_m.z = eye_height_m_;
    survey_.fill({store_, selection_, ground_}, {camera, moment.exaggeration, options_.horizon}, scene);
}

TerrainStage::Wanted TerrainStage::want(const TileWants& wants) {
    for (const pager::NodeIndex& tile : wants.tiles())
        if (pager_.state(tile) == pager::TileState::resident) pager_.touch({&tile, 1});
    wanted_.insert(wanted_.end(), wants.chosen().begin(), wants.chosen().end());
    return {wants.chosen().size(), wants.missing(pager_)};
}

// The disc draws heights alone; chunks are what is stood upon, and what casts shadows.
// What is seen comes before what may come into view, and of what is seen heights before imagery: the ground's
// shape must be right, its colours may be blurred for a while.
void TerrainStage::request_wanted(const StageMoment& moment, StageReport& report) {
    const select::SelectionResult& result = selection_.result();
    pager_.touch(result.used);
    pager_.hold_back(result.held_back);
    wanted_.clear();
    const Wanted heights = schedules_heights(moment) ? want(*heights_wants_) : Wanted{};
    const auto ahead = std::ranges::find_if_not(result.wanted, &select::WantedTile::visible);
    for (auto tile = result.wanted.begin(); tile != ahead; ++tile) wanted_.push_back(tile->index);
    const Wanted imagery = imagery_wants_ && schedules_texture(moment) ? want(*imagery_wants_) : Wanted{};
    for (auto tile = ahead; tile != result.wanted.end(); ++tile) wanted_.push_back(tile->index);
    if (schedules_heights(moment))
        wanted_.insert(wanted_.end(), heights_wants_->beside().begin(), heights_wants_->beside().end());
    pager_.request(wanted_);
    report.heights_wanted = heights.tiles;
    report.heights_missing = heights.missing;
    report.imagery_wanted = imagery.tiles;
    report.imagery_missing = imagery.missing;
}

// Of what surfaces that sample heights may draw.
Box TerrainStage::sampled_bounds(double exaggeration) const {
    Box bounds = select::drawn_bounds(store_.info(), store_.records(), exaggeration);
    const double beside_m = frame_.made_displacement_m() * exaggeration;
    bounds.min.z -= beside_m;
    bounds.max.z += beside_m;
    return bounds;
}

render::DiscSight TerrainStage::disc_sight(const StageMoment& moment, const platform::Camera& camera) const {
    const select::View view =
        select::make_view(selection_camera(camera), {.exaggeration = moment.exaggeration});
    render::DiscSight sight{
        .eye = select::eye_frame(view.eye_m, moment.exaggeration, frame_.sampled_info()),
        .visible = view.visible,
        .terrain_m = sampled_bounds(moment.exaggeration),
        .eye_above_ground_m = eye_above_ground_m_,
        .projection_px = view.projection_px / options_.pixel_error,
        .rule = {},
        .tiles = heights_wants_ ? heights_wants_->tiles() : std::span<const pager::NodeIndex>(),
        .near = near_};
    if (moment.surface == render::Surface::disc) return sight;
    sight.rule = cell_rule(view);
    sight.now = moment.now;
    sight.fade = detail_fade();
    return sight;
}

select::CellRule TerrainStage::cell_rule(const select::View& view) const {
    select::View cells = view;
    cells.pixel_error_px = cell_pixel_error_;
    return criterion_->cell_rule(cells, store_.grid().quads() / shaders::kQuadtreeSide);
}

void TerrainStage::draw(const StageMoment& moment, const platform::Camera& camera, StageReport& report) {
    const telemetry::TraceScope trace(options_.trace, "draw");
    const std::int64_t start_ns = now_ns();
    const select::Sight sight = select::sight_of(selection_camera(camera));
    surface_ = moment.surface;
    detail_ = moment.detail;
    std::optional<render::DiscSight> disc;
    const bool mesh_detail = mesh_has_detail(moment);
    if (render::samples_heights(surface_) || mesh_detail) disc = disc_sight(moment, camera);
    frame_.draw(
        {.view = {camera, selection_.result().eye, moment.exaggeration, moment.daylight, moment.background},
         .disc = disc && !mesh_detail ? &*disc : nullptr,
         .made = mesh_detail ? &*disc : nullptr,
         .selection = &selection_.result(),
         .pager = &pager_,
         .shadows = options_.shadows == select::CasterSet::none ? nullptr : &cascades_,
         .sight = schedules(moment) ? &sight : nullptr,
         .number = moment.number,
         .fill = moment.fill,
         .cover = moment.cover,
         .reads_levels = moment.reads_levels && moment.surface == render::Surface::quadtree});
    frame_.end_frame();
    report.draw_ms = milliseconds(now_ns() - start_ns);
    report.surface = frame_.surface_counters();
    report.shadow = frame_.shadow_counters();
    report.selection = selection_.result().counters;
    if (!schedules(moment)) return;
    report.tiles_scheduled = (schedules_texture(moment) ? schedule_->result().tiles.size() : 0) +
                             (schedules_heights(moment) ? heights_schedule_->result().tiles.size() : 0);
    report.readback_stalls = frame_.ground_reader().counters().stalls - stalls_before_;
    stalls_before_ = frame_.ground_reader().counters().stalls;
}

}  // namespace ridgeline::stage
