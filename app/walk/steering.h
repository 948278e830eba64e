// What the keys of a walk do, but for moving (platform/camera_controller.h): pure functions from input to
// changes of a small state and to requests, so that they are tested without a window.
#pragma once

#include <chrono>
#include <optional>
#include <span>

#include "ridgeline/app/hud/node_map.h"
#include "ridgeline/platform/context.h"
#include "ridgeline/platform/input.h"
#include "ridgeline/render/frame.h"

namespace ridgeline::app {

enum class Panel { hidden, shown };

// What lasts from frame to frame.
struct WalkSettings {
    double exaggeration = 1.0;
    render::Fill fill = render::Fill::solid;
    select::CasterSet shadows = select::CasterSet::none;
    select::HorizonMode horizon = select::HorizonMode::ridges;
    Panel hud = Panel::shown;
    Panel horizon_view = Panel::hidden;  // with the figures
    render::Cover cover = render::Cover::imagery;
    render::Surface surface = render::Surface::mesh;
    bool detail = true;  // made ground, where the walk has any
    MapRange map_range = MapRange::fitting;
    MapTheme map_theme = MapTheme::fates;
    Panel help = Panel::hidden;
    Panel go_to = Panel::hidden;
    Panel measured = Panel::hidden;  // a point or a line on the ground
    platform::MouseMode mouse = platform::MouseMode::free;
};

// What is asked for once.
struct WalkRequests {
    bool quit = false;
    bool pause = false;
    bool walk_or_fly = false;
    bool record = false;
    bool replay = false;
    bool screenshot = false;
    bool home = false;
};

constexpr double kLeastExaggeration = 0.1;
constexpr double kMostExaggeration = 20.0;
constexpr double kExaggerationStep = 1.1;

WalkRequests apply_keys(const platform::Input& input, WalkSettings& settings);

// The sun's speed under the arrow keys, a second, and where it stops: a little under the horizon it is night.
constexpr Angle kSunTurnPerSecond = Angle::from_degrees(40.0);
constexpr Angle kSunRisePerSecond = Angle::from_degrees(15.0);
constexpr Angle kLowestSun = Angle::from_degrees(-12.0);
constexpr Angle kHighestSun = Angle::from_degrees(90.0);

// Where the sun stands after `dt` with the arrow keys held as they are; Shift makes it slow.
render::Daylight moved_sun(const platform::Input& input, const WalkSettings& settings,
                           const render::Daylight& sun, std::chrono::duration<double> dt);

// For the help panel.
struct KeyHelp {
    const char* keys;
    const char* what;
};
std::span<const KeyHelp> key_help();

}  // namespace ridgeline::app
