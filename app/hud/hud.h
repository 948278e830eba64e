// The figures over the picture: rates, curves, caches, where one is, what the keys do, and where to go.
//
// Knows numbers and panels only; the walk fills a HudView each frame. Render thread, within ImguiLayer's
// frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "ridgeline/app/hud/horizon_strip.h"
#include "ridgeline/app/hud/measure_panel.h"
#include "ridgeline/app/hud/node_map.h"
#include "ridgeline/app/walk/course.h"
#include "ridgeline/app/walk/stage.h"
#include "ridgeline/app/walk/steering.h"

namespace ridgeline::app {

// The newest values of something measured once a frame.
class Curve {
  public:
    static constexpr std::size_t kLength = 240;

    void add(float value);
    // In order of time, oldest first, for plotting.
    float at(std::size_t index) const { return values_[(next_ + index) % kLength]; }
    float newest() const { return values_[(next_ + kLength - 1) % kLength]; }
    float largest() const;
    float mean() const;

  private:
    std::array<float, kLength> values_{};
    std::size_t next_ = 0;
    std::size_t count_ = 0;
};

// One frame's figures.
struct HudFigures {
    double frame_ms = 0.0;
    double render_cpu_ms = 0.0;
    double selection_ms = 0.0;
    double gpu_ms = 0.0;
    std::uint64_t triangles = 0;
    std::uint32_t draws = 0;
    std::uint32_t nodes = 0;
    std::uint32_t tiles_wanted = 0;
    std::uint32_t tiles_missing = 0;
    std::uint64_t bytes_read = 0;
    std::uint64_t bytes_uploaded = 0;
    std::uint64_t ram_bytes = 0, ram_capacity_bytes = 0;
    std::uint64_t gpu_bytes = 0, gpu_capacity_bytes = 0;
    // Nothing wanted: the mesh is drawn; no imagery, or none shown. Bytes: on the GPU.
    std::size_t heights_wanted = 0, heights_missing = 0;
    std::uint64_t heights_bytes = 0;
    std::size_t imagery_wanted = 0, imagery_missing = 0;
    std::uint64_t imagery_bytes = 0;
    double eye_lift_m = 0.0;
    std::uint32_t casters = 0;
    std::uint64_t shadow_triangles = 0;
    std::uint64_t shadow_map_bytes = 0;
};

// CPU time of threads, in percent of one core.
struct HudCpu {
    double render = 0.0;
    double workers = 0.0;
    double process = 0.0;
};

struct HudView {
    const char* dataset = "";
    HudCpu cpu;
    platform::Pose pose;
    std::optional<glm::dvec2> degrees;  // longitude, latitude
    std::optional<double> above_ground_m;
    Course::State course = Course::State::steered;
    platform::MotionMode mode = platform::MotionMode::fly;
    double speed_m_per_s = 0.0;
    double exaggeration = 1.0;
    render::Daylight daylight;
    select::CasterSet shadows = select::CasterSet::none;
    bool recording = false;
    const char* message = "";  // what the last key did; empty: nothing
    // Null: the horizon's panels are off.
    const HorizonScene* horizon = nullptr;
    // On the map in place of what the horizon hides; null: not.
    const LevelScene* levels = nullptr;
    // Null: nothing is measured.
    const MeasureScene* measured = nullptr;
};

class Hud {
  public:
    void add(const HudFigures& figures);

    // Builds the panels that are shown. Returns where to go when a place was entered.
    std::optional<glm::dvec2> build(const HudView& view, WalkSettings& settings);

  private:
    void build_figures(const HudView& view);
    void build_sun(const HudView& view) const;
    void build_position(const HudView& view);
    void build_compass(const HudView& view);
    void build_horizon(const MapContent& content);
    void build_measured(const HudView& view);
    static void build_help();
    std::optional<glm::dvec2> build_go_to(const HudView& view, WalkSettings& settings);

    HudFigures newest_;
    // What the position's panel has taken at most, and takes usually, so that the strip beside it stands
    // still.
    glm::vec2 position_px_{420.0f, 64.0f};
    NodeMap map_;
    HorizonStrip strip_;
    // Of the horizon's panels: what is measured stands beside the map and over the strip.
    glm::vec2 beside_horizon_px_{0.0f};
    MeasurePanel measure_;
    Curve frame_ms_;
    Curve render_ms_;
    Curve triangles_;
    Curve missing_;
    Curve read_bytes_;
    std::array<double, 2> go_to_{};
    bool go_to_opened_ = false;
};

}  // namespace ridgeline::app
