#include "ridgeline/app/walk/walk_session.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>

#include "ridgeline/app/stop_signal.h"
#include "ridgeline/app/walk/level_survey.h"
#include "ridgeline/app/walk/sun.h"
#include "ridgeline/base/log.h"
#include "ridgeline/base/whole_file.h"
#include "ridgeline/detail/finer_ground.h"
#include "ridgeline/gl/framebuffer.h"
#include "ridgeline/gl/screenshot.h"
#include "ridgeline/telemetry/clock.h"

namespace ridgeline::app {
namespace {

// A stall (a dragged window, a debugger) must not throw the camera across the land.
constexpr Seconds kLongestStep{0.1};
// Thumbnails: so many over a walk of known length; else at doubling distances.
constexpr std::int64_t kThumbnails = 8;
constexpr std::int64_t kFirstThumbnailGap = 15;
constexpr int kThumbnailWidth_px = 256;
constexpr Seconds kMessageTime{3.0};
// How far above the ground one arrives at a place that was typed in.
constexpr double kArrival_m = 400.0;

render::Daylight chosen_daylight(const std::optional<SunChoice>& choice, const io::TerrainInfo& info,
                                 const PlaceNames& places) {
    if (!choice) return {};
    if (const auto* direction = std::get_if<SunDirection>(&*choice))
        return {direction->azimuth, direction->elevation};
    const glm::dvec2 centre = 0.5 * (glm::dvec2(info.min_east_m(), info.min_north_m()) +
                                     glm::dvec2(info.max_east_m(), info.max_north_m()));
    // Without a place on the globe, as over Greenwich's meridian at the equator.
    return daylight_at(std::get<std::chrono::sys_seconds>(*choice),
                       places.degrees(centre).value_or(glm::dvec2(0.0)));
}

std::optional<render::PlainBackground> chosen_background(const std::optional<Colour>& colour) {
    if (!colour) return std::nullopt;
    return render::PlainBackground{colour->red, colour->green, colour->blue};
}

select::HorizonMode chosen_horizon(const std::string& name) {
    if (name == "off") return select::HorizonMode::off;
    return name == "boxes" ? select::HorizonMode::boxes : select::HorizonMode::ridges;
}

select::CasterSet chosen_shadows(const std::string& name) {
    if (name == "pvs") return select::CasterSet::pvs;
    return name == "all" ? select::CasterSet::all : select::CasterSet::none;
}

render::Surface chosen_surface(const std::string& name) {
    if (name == "disc") return render::Surface::disc;
    return name == "quadtree" ? render::Surface::quadtree : render::Surface::mesh;
}

const char* surface_message(render::Surface surface) {
    if (surface == render::Surface::disc) return "surface: disc";
    return surface == render::Surface::quadtree ? "surface: quadtree" : "surface: mesh";
}

// For so many seconds there is memory from the start; more take more.
constexpr double kLongSoak_s = 24.0 * 3600.0;

SoakClock soak_clock() {
    return {telemetry::milliseconds(telemetry::now_ns()) * 1e-3,
            telemetry::milliseconds(telemetry::process_cpu_ns()) * 1e-3};
}

// The first name, in the directory one stands in, that no file has: earlier walks' are kept.
std::string free_name(const char* stem, const char* ending) {
    for (int number = 0;; ++number) {
        std::array<char, 64> name{};
        std::snprintf(name.data(), name.size(), "%s-%03d%s", stem, number, ending);
        std::error_code unknown;
        if (!std::filesystem::exists(name.data(), unknown)) return name.data();
    }
}

}  // namespace

std::optional<std::int64_t> WalkSession::frame_limit(const WalkOptions& options,
                                                     const platform::ResolvedPath* path) {
    if (options.frames) return options.frames;
    if (options.seconds || options.drawing == Drawing::window || !path) return std::nullopt;
    return static_cast<std::int64_t>(path->frame_count());
}

Result<std::unique_ptr<WalkSession>> WalkSession::create(const WalkOptions& options, const io::Store& store,
                                                         std::optional<platform::ResolvedPath> path,
                                                         platform::Context& context,
                                                         WalkTelemetry& telemetry) {
    std::unique_ptr<WalkSession> session(
        new WalkSession(options, store, std::move(path), context, telemetry));
    RIDGELINE_TRY(session->open_stage());
    return session;
}

WalkSession::WalkSession(const WalkOptions& options, const io::Store& store,
                         std::optional<platform::ResolvedPath> path, platform::Context& context,
                         WalkTelemetry& telemetry)
    : options_(options),
      store_(store),
      context_(context),
      telemetry_(telemetry),
      places_(store.info()),
      measuring_(store, places_),
      progress_("walking " + options.directory.string(), "frames",
                Progress::style(options.quiet || options.drawing == Drawing::window)),
      dataset_(store.directory().stem().string()),
      lens_{.horizontal_fov = options.horizontal_fov, .size_px = options.size_px},
      daylight_(chosen_daylight(options.sun, store.info(), places_)),
      background_(chosen_background(options.background)),
      frame_limit_(frame_limit(options, path ? &*path : nullptr)),
      follows_path_(path && options.drawing == Drawing::headless),
      round_frames_(follows_path_ ? path->frame_count() : 0),
      course_(std::move(path), overview(store.info(), options.exaggeration)) {
    settings_.exaggeration = options.exaggeration;
    settings_.shadows = chosen_shadows(options.shadows);
    settings_.horizon = chosen_horizon(options.horizon);
    settings_.surface = chosen_surface(options.surface);
    settings_.cover = options.imagery == "off" ? render::Cover::tint : render::Cover::imagery;
    settings_.hud = options.hud || !headless() ? Panel::shown : Panel::hidden;
    settings_.horizon_view = options.hud_map ? Panel::shown : Panel::hidden;
    settings_.map_theme = options.hud_levels ? MapTheme::levels : MapTheme::fates;
    jobs_ = std::make_unique<jobs::JobSystem>(
        jobs::JobSystemOptions{.on_worker_start = [&telemetry](int) { telemetry.worker_started(); },
                               .on_worker_stop = [&telemetry](int) { telemetry.worker_stopped(); }});
}

WalkSession::~WalkSession() = default;

StageOptions WalkSession::stage_options() const {
    StageOptions stage;
    // Without keys the surface stays what it is, and the mesh alone needs no memory for heights.
    const bool all = !headless() || render::samples_heights(settings_.surface) || options_.detail_levels > 0;
    stage.frame = {.size_px = options_.size_px,
                   .surfaces = all ? render::Surfaces::all : render::Surfaces::mesh_only,
                   .quadtree = {.lod = options_.lod == "cpu" ? render::LodBy::cpu : render::LodBy::gpu},
                   .detail_octaves = all ? options_.detail_levels : 0,
                   .detail_roughness = options_.detail_roughness,
                   .gpu_cache_bytes = options_.caches.gpu_bytes};
    stage.pager.ram_bytes = options_.caches.ram_bytes;
    stage.pager.fault = options_.faults;
    stage.criterion = options_.criterion;
    stage.pixel_error = options_.pixel_error;
    stage.shadows = settings_.shadows;
    stage.horizon = settings_.horizon;
    stage.wait = options_.wait_for_tiles ? TileWait::settle : TileWait::never;
    stage.stop = &watch_stop_signals();
    if (options_.telemetry.empty()) return stage;
    stage.pager.recorder = &telemetry_.recorder();
    stage.trace = telemetry_.recorder().trace();
    return stage;
}

Result<void> WalkSession::check_detail() const {
    const int levels = options_.detail_levels;
    const int most = detail::most_octaves(store_.info());
    if (levels > 0 && !store_.info().detail)
        return Error{options_.directory.string() +
                     ": says nothing of ground finer than its source, for --detail: build it again"};
    if (levels > most)
        return Error{options_.directory.string() + ": is so large that it can have --detail " +
                     std::to_string(most) + " at most"};
    return {};
}

Result<void> WalkSession::open_stage() {
    RIDGELINE_TRY(check_detail());
    auto stage = TerrainStage::create(store_, *jobs_, stage_options());
    if (!stage) return stage.error();
    stage_ = std::move(stage).value();
    if (headless() && !options_.hud) return {};
    auto imgui = ImguiLayer::create(context_);
    if (!imgui) return imgui.error();
    imgui_ = std::move(imgui).value();
    if (!options_.hud_levels) return {};
    if (settings_.surface != render::Surface::quadtree)
        log_line(LogLevel::warn,
                 "--hud-levels: the levels are the quadtree's, which --surface quadtree draws");
    return stage_->has_disc() ? stage_->allow_level_matrix() : Result<void>();
}

bool WalkSession::ended(const std::atomic<bool>& stop) const {
    if (quit_ || stop.load(std::memory_order_relaxed)) return true;
    if (frame_limit_ && frame_ >= *frame_limit_) return true;
    return options_.seconds &&
           std::chrono::duration<double>(Clock::now() - start_).count() >= *options_.seconds;
}

void WalkSession::rehearse() {
    if (follows_path_) course_.show_frame(0);
    stage_->rehearse(moment());
}

Result<void> WalkSession::run(const std::atomic<bool>& stop) {
    start_ = last_frame_start_ = Clock::now();
    if (!options_.soak.empty())
        soak_.emplace(
            soak_clock(),
            static_cast<std::size_t>(std::min<double>(options_.seconds.value_or(kLongSoak_s), kLongSoak_s)) +
                1,
            round_frames_);
    Result<void> walked;
    while (walked && !ended(stop)) walked = frame();
    // Whatever failed, the rest of what was asked for is written; the first failure is told.
    const Result<void> outcomes[] = {walked,       pictures_.finish(),  save_whole_walk(), write_telemetry(),
                                     judge_soak(), check_complete(stop)};
    for (const Result<void>& outcome : outcomes) RIDGELINE_TRY(outcome);
    if (headless() && !options_.quiet) say_what_was_walked();
    return {};
}

void WalkSession::say_what_was_walked() const {
    const double ms = std::chrono::duration<double, std::milli>(last_frame_start_ - start_).count();
    const auto intervals = static_cast<double>(std::max<std::int64_t>(frame_ - 1, 1));
    std::printf("%s: %lld frames", options_.directory.string().c_str(), static_cast<long long>(frame_));
    if (frame_ > 1) std::printf(", %.1f ms each", ms / intervals);
    if (!options_.telemetry.empty()) std::printf(", figures in %s", options_.telemetry.string().c_str());
    std::printf("\n");
}

Result<void> WalkSession::save_whole_walk() const {
    if (options_.record.empty()) return {};
    return platform::save_path(whole_walk_.path(), options_.record);
}

Result<void> WalkSession::write_telemetry() {
    if (options_.telemetry.empty()) return {};
    return telemetry_.write(options_.telemetry, stage_->pager());
}

Result<void> WalkSession::judge_soak() const {
    if (!soak_) return {};
    RIDGELINE_TRY(write_whole_file(options_.soak, soak_->csv()));
    const auto table = soak_->table();
    if (!table) return table.error();
    if (!options_.quiet) std::fputs(table->c_str(), stdout);
    return soak_->verdict();
}

// A window is closed as one likes; a headless run that was cut short is not what was asked for, nor is a walk
// that ended before a frame whose picture was.
Result<void> WalkSession::check_complete(const std::atomic<bool>& stop) const {
    if (headless() && stop.load(std::memory_order_relaxed)) return Error{"walk: stopped by a signal"};
    for (const Shot& shot : options_.shots)
        if (shot.frame >= frame_)
            return Error{"--shot of frame " + std::to_string(shot.frame) + ": the walk ended after frame " +
                         std::to_string(frame_ - 1)};
    return {};
}

Result<void> WalkSession::frame() {
    const telemetry::TraceScope trace(options_.telemetry.empty() ? nullptr : telemetry_.recorder().trace(),
                                      "frame");
    const Clock::time_point now = Clock::now();
    const Seconds dt =
        headless() ? kHeadlessFrameTime : std::min<Seconds>(now - last_frame_start_, kLongestStep);
    last_frame_start_ = now;
    RIDGELINE_TRY(listen());
    steer(dt);
    if (!options_.record.empty()) whole_walk_.add(time_, course_.pose());
    if (recording_) recording_->add(time_ - recording_start_, course_.pose());

    measure();
    const StageReport report = stage_->show(moment());
    drawn_camera_ = moment().camera;
    drawn_camera_.pose.eye_m.z += report.eye_lift_m;
    warn_of_cells(report.surface);
    take_pictures(Panel::hidden);
    build_hud(dt);
    take_pictures(Panel::shown);
    if (!headless()) {
        gl::blit_to_window(stage_->target(), context_.size_px());
        context_.present();
    }
    pace();
    const telemetry::FrameRecord& record =
        telemetry_.add_frame(time_.count(), course_.pose().eye_m, report, *stage_);
    if (soak_) soak_->add(soak_clock(), record);
    hud_.add(telemetry_.figures(*stage_));
    take_thumbnail();
    ++frame_;
    if (frame_limit_) progress_.report(frame_, *frame_limit_);
    time_ = headless() ? kHeadlessFrameTime * static_cast<double>(frame_) : time_ + dt;
    return {};
}

// Once a walk: they may come and go with every step.
void WalkSession::warn_of_cells(const render::SurfaceCounters& surface) {
    if (surface.left_out == 0 || warned_of_cells_) return;
    warned_of_cells_ = true;
    log_line(LogLevel::warn,
             "the quadtree has no room for " + std::to_string(surface.left_out) +
                 " of the cells in view, and the ground has holes there: a larger --pixel-error "
                 "needs fewer");
}

// --- what the user does

Result<void> WalkSession::listen() {
    platform::begin_frame(input_);
    if (headless()) return {};
    context_.poll(input_);
    if (const auto size = input_.resized_to_px; size && size->x > 0 && size->y > 0) {
        RIDGELINE_TRY(stage_->resize(*size));
        lens_.size_px = *size;
    }
    const platform::MouseMode mouse = settings_.mouse;
    const render::Surface surface = settings_.surface;
    const render::Cover cover = settings_.cover;
    const MapTheme theme = settings_.map_theme;
    const bool detail = settings_.detail;
    Result<void> done = obey(apply_keys(input_, settings_));
    if (settings_.shadows != stage_->shadows()) switch_shadows();
    if (settings_.horizon != stage_->horizon()) switch_horizon();
    if (settings_.surface != surface) say(surface_message(settings_.surface));
    if (settings_.map_theme != theme) switch_map();
    if (settings_.detail != detail) switch_detail();
    if (settings_.cover != cover) switch_cover(cover);
    if (settings_.mouse != mouse) context_.set_mouse_mode(settings_.mouse);
    return done;
}

void WalkSession::steer(Seconds dt) {
    daylight_ = moved_sun(input_, settings_, daylight_, dt);
    if (follows_path_) return course_.show_frame(frame_);
    platform::Input meant_for_us = input_;
    if (imgui_ && imgui_->wants_mouse()) meant_for_us.buttons_down.reset();
    if (settings_.go_to == Panel::shown) meant_for_us = {};
    course_.advance(platform::controls_from(meant_for_us, {}), ground_function(), dt);
}

Result<void> WalkSession::obey(const WalkRequests& requests) {
    quit_ = requests.quit;
    if (requests.pause) course_.toggle_pause();
    if (requests.walk_or_fly) course_.toggle_walking();
    if (requests.home) course_.go_to(overview(store_.info(), settings_.exaggeration));
    if (requests.replay) replay();
    screenshot_wanted_ = requests.screenshot;
    if (requests.record) toggle_recording();
    return {};
}

// Keeps what there was where the GPU has no room for the maps.
void WalkSession::switch_shadows() {
    const auto switched = stage_->set_shadows(settings_.shadows);
    if (!switched) say(switched.error().message);
    settings_.shadows = stage_->shadows();
}

// Keeps what there was where there is nothing to switch.
void WalkSession::switch_cover(render::Cover before) {
    if (!stage_->has_imagery()) {
        settings_.cover = before;
        return say("this store has no imagery");
    }
    say(settings_.cover == render::Cover::imagery ? "imagery: on" : "imagery: off");
}

// Memory for the levels is taken when they are first looked at.
void WalkSession::switch_map() {
    if (settings_.map_theme == MapTheme::fates) return;
    if (const auto allowed = stage_->allow_level_matrix(); !allowed) {
        settings_.map_theme = MapTheme::fates;
        return say(allowed.error().message);
    }
    if (settings_.surface != render::Surface::quadtree) say("levels are the quadtree's: F6 draws it");
}

// Memory for it is divided at the start.
void WalkSession::switch_detail() {
    if (options_.detail_levels == 0) return say("made ground: start with --detail LEVELS");
    say(settings_.detail ? "made ground: on" : "made ground: off");
}

void WalkSession::switch_horizon() {
    stage_->set_horizon(settings_.horizon);
    say(settings_.horizon == select::HorizonMode::off     ? "horizon: off"
        : settings_.horizon == select::HorizonMode::boxes ? "horizon: boxes"
                                                          : "horizon: ridges");
}

void WalkSession::toggle_recording() {
    if (!recording_) {
        recording_.emplace();
        recording_start_ = time_;
        return say("recording; R saves it");
    }
    const std::string file = free_name("ridgeline-path", ".json");
    last_recording_ = recording_->path();
    recording_.reset();
    const auto saved = platform::save_path(*last_recording_, file);
    say(saved ? "saved " + file + "; P plays it" : saved.error().message);
}

void WalkSession::replay() {
    if (!last_recording_) return say("nothing recorded yet: R records");
    // Recorded heights are absolute: no ground is needed.
    const auto no_ground = [](const glm::dvec2&) -> std::optional<double> { return std::nullopt; };
    auto path = platform::resolve(*last_recording_, no_ground);
    if (!path) return say(path.error().message);
    course_.follow(std::move(path).value());
}

void WalkSession::go_to(const glm::dvec2& east_north_m) {
    const auto ground = stage_->ground_below(east_north_m);
    if (!ground) return say("that place lies outside the terrain");
    platform::Pose pose = course_.pose();
    const double over_ground_m = course_.mode() == platform::MotionMode::walk ? 2.0 : kArrival_m;
    pose.eye_m = glm::dvec3(east_north_m, std::max(ground->mesh_m, ground->drawn_m) + over_ground_m);
    course_.go_to(pose);
}

platform::GroundFunction WalkSession::ground_function() {
    return [this](const glm::dvec2& east_north_m) -> std::optional<double> {
        const auto ground = stage_->ground_below(east_north_m);
        if (!ground) return std::nullopt;
        return stage_->draws_detail() ? ground->drawn_m : ground->mesh_m;
    };
}

// --- what is shown

StageMoment WalkSession::moment() const {
    return {.number = static_cast<std::uint64_t>(frame_),
            .camera = {course_.pose(), lens_},
            .exaggeration = settings_.exaggeration,
            .speed_m_per_s = course_.speed_m_per_s(),
            .turn_per_second = course_.turn_per_second(),
            .now = time_,
            .daylight = daylight_,
            .background = background_,
            .fill = settings_.fill,
            .cover = settings_.cover,
            .surface = settings_.surface,
            .detail = settings_.detail,
            .reads_levels = imgui_ && shows_map() && settings_.map_theme == MapTheme::levels};
}

// Pictures are taken with or without the HUD, as --hud says.
void WalkSession::take_pictures(Panel hud) {
    if ((hud == Panel::shown) != options_.hud) return;
    for (const Shot& shot : options_.shots)
        if (shot.frame == frame_) pictures_.save(shot.file, gl::read_image(stage_->target()));
    if (!std::exchange(screenshot_wanted_, false)) return;
    const std::string file = free_name("ridgeline", ".png");
    pictures_.save(file, gl::read_image(stage_->target()));
    say("saving " + file);
}

void WalkSession::take_thumbnail() {
    if (options_.telemetry.empty() || frame_ != next_thumbnail_) return;
    if (frame_limit_)
        next_thumbnail_ += std::max<std::int64_t>(1, (*frame_limit_ - 1) / (kThumbnails - 1));
    else
        next_thumbnail_ = std::max(kFirstThumbnailGap, 2 * frame_);
    const int factor = std::max(1, lens_.size_px.x / kThumbnailWidth_px);
    pictures_.save(options_.telemetry / "thumbs" / (std::to_string(frame_) + ".png"),
                   gl::shrink(gl::read_image(stage_->target()), factor));
    telemetry_.leave_out();
}

void WalkSession::build_hud(Seconds dt) {
    if (!imgui_) return;
    imgui_->begin_frame(lens_.size_px, dt);
    if (const auto place = hud_.build(hud_view(), settings_)) go_to(*place);
    imgui_->draw(stage_->target());
}

// Where the mouse looks around it cannot point, and panels take their own clicks.
void WalkSession::measure() {
    const auto clicked = clicks_.update(input_);
    const bool ours = imgui_ && !imgui_->wants_mouse();
    if (clicked && clicked->button == platform::MouseButton::right) settings_.measured = Panel::hidden;
    if (settings_.measured == Panel::hidden) measuring_.clear();
    if (clicked && clicked->button == platform::MouseButton::left && ours && frame_ > 0)
        measuring_.add(ray_through(drawn_camera_, vertical_scale(), clicked->at_px / imgui_->size()));
    if (const char* complaint = measuring_.listen()) say(complaint);
    settings_.measured = measuring_.empty() ? Panel::hidden : Panel::shown;
}

VerticalScale WalkSession::vertical_scale() const {
    return {store_.info().height_offset_m, settings_.exaggeration};
}

HudView WalkSession::hud_view() {
    const platform::Pose& pose = course_.pose();
    const auto ground = stage_->ground_below(glm::dvec2(pose.eye_m));
    const bool with_horizon = shows_map();
    if (with_horizon) stage_->survey(moment(), horizon_);
    return {.dataset = dataset_.c_str(),
            .cpu = telemetry_.cpu(),
            .pose = pose,
            .degrees = places_.degrees(glm::dvec2(pose.eye_m)),
            .above_ground_m = ground ? std::optional(pose.eye_m.z - ground->mesh_m) : std::nullopt,
            .course = course_.state(),
            .mode = course_.mode(),
            .speed_m_per_s = course_.speed_m_per_s(),
            .exaggeration = settings_.exaggeration,
            .daylight = daylight_,
            .shadows = settings_.shadows,
            .recording = recording_.has_value(),
            .message = time_ < message_until_ ? message_.c_str() : "",
            .horizon = with_horizon ? &horizon_ : nullptr,
            .levels = with_horizon ? survey_levels() : nullptr,
            .measured = measuring_.scene(drawn_camera_, vertical_scale())};
}

bool WalkSession::shows_map() const {
    return settings_.hud == Panel::shown && settings_.horizon_view == Panel::shown;
}

// Null where the map shows something else, and before any have arrived.
const LevelScene* WalkSession::survey_levels() {
    if (!moment().reads_levels || settings_.surface != render::Surface::quadtree) return nullptr;
    const render::LevelMatrix* matrix = stage_->level_matrix();
    if (!matrix) return nullptr;
    app::survey_levels(*matrix, stage_->frame().sampled_info(), drawn_camera_.pose.eye_m, levels_);
    return &levels_;
}

void WalkSession::say(std::string text) {
    log_line(LogLevel::info, text);
    message_ = std::move(text);
    message_until_ = time_ + kMessageTime;
}

// Sleeps off what is left of the frame's time under --fps-limit.
void WalkSession::pace() {
    if (!options_.fps_limit) return;
    const auto frame_time =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / *options_.fps_limit));
    std::this_thread::sleep_until(last_frame_start_ + frame_time);
}

}  // namespace ridgeline::app
