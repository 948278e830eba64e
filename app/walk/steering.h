// What the keys of a walk do, but for moving (platform/camera_controller.h): a pure function from input to
// changes of a small state and to requests, so that it is tested without a window.
#pragma once

#include <optional>
#include <span>

#include "ridgeline/platform/context.h"
#include "ridgeline/platform/input.h"
#include "ridgeline/render/frame.h"

namespace ridgeline::app {

enum class Panel { hidden, shown };

// What lasts from frame to frame.
struct WalkSettings {
    double exaggeration = 1.0;
    render::Fill fill = render::Fill::solid;
    Panel hud = Panel::shown;
    Panel help = Panel::hidden;
    Panel go_to = Panel::hidden;
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

// For the help panel.
struct KeyHelp {
    const char* keys;
    const char* what;
};
std::span<const KeyHelp> key_help();

}  // namespace ridgeline::app
