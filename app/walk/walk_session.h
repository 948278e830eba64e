// The loop of a walk and what it holds. Render thread.
//
// One frame: events, keys, camera ─► stage (selection, drawing) ─► pictures, HUD ─► present ─► telemetry.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "ridgeline/app/commands/walk_options.h"
#include "ridgeline/app/hud/hud.h"
#include "ridgeline/app/hud/imgui_layer.h"
#include "ridgeline/app/progress.h"
#include "ridgeline/app/walk/course.h"
#include "ridgeline/app/walk/measuring.h"
#include "ridgeline/app/walk/picture_writer.h"
#include "ridgeline/app/walk/place_names.h"
#include "ridgeline/app/walk/soak_watch.h"
#include "ridgeline/app/walk/stage.h"
#include "ridgeline/app/walk/steering.h"
#include "ridgeline/app/walk/walk_telemetry.h"

namespace ridgeline::app {

class WalkSession {
  public:
    // The context must be current and outlive the session, as must store and telemetry.
    static Result<std::unique_ptr<WalkSession>> create(const WalkOptions& options, const io::Store& store,
                                                       std::optional<platform::ResolvedPath> path,
                                                       platform::Context& context, WalkTelemetry& telemetry);
    ~WalkSession();

    // Draws the first view once, which no figure counts; before run(), and before the telemetry starts.
    void rehearse();
    // Until the walk ends. Fails where a file could not be written, and when stopped from outside.
    Result<void> run(const std::atomic<bool>& stop);

    // The frame after which a walk with these options ends by itself, if one is known.
    static std::optional<std::int64_t> frame_limit(const WalkOptions& options,
                                                   const platform::ResolvedPath* path);

  private:
    using Clock = std::chrono::steady_clock;

    WalkSession(const WalkOptions& options, const io::Store& store,
                std::optional<platform::ResolvedPath> path, platform::Context& context,
                WalkTelemetry& telemetry);
    Result<void> check_detail() const;
    Result<void> open_stage();
    StageOptions stage_options() const;

    bool headless() const { return options_.drawing == Drawing::headless; }
    bool ended(const std::atomic<bool>& stop) const;
    Result<void> frame();
    Result<void> save_whole_walk() const;
    Result<void> write_telemetry();
    Result<void> judge_soak() const;
    void say_what_was_walked() const;
    Result<void> check_complete(const std::atomic<bool>& stop) const;
    Result<void> listen();
    void steer(Seconds dt);
    Result<void> obey(const WalkRequests& requests);
    void switch_shadows();
    void switch_horizon();
    void switch_detail();
    void switch_map();
    void switch_cover(render::Cover before);
    void toggle_recording();
    void replay();
    void go_to(const glm::dvec2& east_north_m);
    platform::GroundFunction ground_function();
    VerticalScale vertical_scale() const;
    StageMoment moment() const;
    void measure();
    void take_pictures(Panel hud);
    void take_thumbnail();
    void warn_of_cells(const render::SurfaceCounters& surface);
    void build_hud(Seconds dt);
    HudView hud_view();
    bool shows_map() const;
    const LevelScene* survey_levels();
    void pace();
    void say(std::string text);

    const WalkOptions options_;
    const io::Store& store_;
    platform::Context& context_;
    WalkTelemetry& telemetry_;
    std::unique_ptr<jobs::JobSystem> jobs_;
    std::unique_ptr<TerrainStage> stage_;
    std::unique_ptr<ImguiLayer> imgui_;
    PlaceNames places_;
    Hud hud_;
    HorizonScene horizon_;
    LevelScene levels_;
    ClickWatch clicks_;
    Measuring measuring_;
    PictureWriter pictures_;
    Progress progress_;

    std::string dataset_;
    platform::Lens lens_;
    platform::Camera drawn_camera_;  // of the last frame
    render::Daylight daylight_;
    std::optional<render::PlainBackground> background_;
    std::optional<std::int64_t> frame_limit_;
    bool follows_path_ = false;     // headless: one pose a frame
    std::size_t round_frames_ = 0;  // ... so many
    Course course_;
    platform::Input input_;
    WalkSettings settings_;
    std::int64_t frame_ = 0;
    Seconds time_{0.0};
    Clock::time_point start_{};
    Clock::time_point last_frame_start_{};
    bool quit_ = false;

    std::optional<SoakWatch> soak_;
    CourseRecording whole_walk_;  // for --record
    std::optional<CourseRecording> recording_;
    std::optional<platform::CameraPath> last_recording_;
    Seconds recording_start_{0.0};
    bool screenshot_wanted_ = false;
    bool warned_of_cells_ = false;
    std::int64_t next_thumbnail_ = 0;
    std::string message_;
    Seconds message_until_{0.0};
};

}  // namespace ridgeline::app
