// What `ridgeline walk` can be told, as values with the defaults that users rely on, and its command line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ridgeline/app/command.h"
#include "ridgeline/app/options.h"
#include "ridgeline/base/units.h"
#include "ridgeline/pager/fault.h"
#include "ridgeline/telemetry/run_summary.h"

namespace ridgeline::app {

enum class Drawing { window, headless };

struct WalkOptions {
    std::filesystem::path directory;

    // None: orbit when headless, free flight in a window.
    std::optional<PathChoice> path;
    std::filesystem::path record;  // empty: nothing is recorded
    // At most one of the two; neither: to the end of the path, or until the window closes.
    std::optional<std::int64_t> frames;
    std::optional<double> seconds;  // wall time
    std::optional<double> fps_limit;

    Drawing drawing = Drawing::window;
    glm::ivec2 size_px{1024, 768};
    Angle horizontal_fov = Angle::from_degrees(75.0);
    std::string surface = "mesh";
    std::string criterion = "screen_error";
    double pixel_error = 1.0;
    std::string horizon = "ridges";
    std::string lod = "gpu";
    int detail_levels = 0;  // 0: off
    double detail_roughness = 1.0;
    std::string shadows = "off";  // off, pvs, all
    std::string imagery = "on";   // on, off
    double exaggeration = 1.0;
    std::optional<SunChoice> sun;      // none: the renderer's own
    std::optional<Colour> background;  // none: the sky

    CacheSizes caches;
    bool wait_for_tiles = false;
    pager::FaultSpec faults;

    std::vector<Shot> shots;
    bool hud = false;
    bool hud_map = false;             // the horizon's panels; with the HUD
    bool hud_levels = false;          // the quadtree's levels on its map
    std::filesystem::path telemetry;  // a directory; empty: none is written
    std::filesystem::path soak;       // a file; empty: nobody watches
    bool quiet = false;               // headless: no progress, no last line
};

// Declares the options on the subcommand; they are in `options` once the command line is parsed and checked.
void add_walk_options(Syntax syntax, WalkOptions& options);

// The "options" of summary.json: every option that decides what is drawn, by its command-line name.
std::vector<std::pair<std::string, telemetry::OptionValue>> described(const WalkOptions& options);

}  // namespace ridgeline::app
