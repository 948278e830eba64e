#include "ridgeline/app/commands/walk_options.h"

#include <array>
#include <cstdio>
#include <limits>

#include "ridgeline/io/detail_info.h"

namespace ridgeline::app {
namespace {

constexpr std::int64_t kMostFrames = std::numeric_limits<std::int32_t>::max();

void add_course_options(Syntax syntax, WalkOptions& options) {
    add_value(syntax, "--path", options.path, "ground|orbit|FILE",
              "What the camera follows; none: fly freely (headless: orbit)", parse_path_choice);
    add_path(syntax, "--record", options.record, "FILE", "Write the camera's path to FILE");
    const Option frames =
        add_value(syntax, "--frames", options.frames, "N", "End after N frames", [](const std::string& text) {
            return parse_integer(text, {1, kMostFrames});
        });
    const Option seconds = add_value(syntax, "--seconds", options.seconds, "S",
                                     "End after S seconds of wall time", parse_positive);
    frames.excludes(seconds);
    add_value(syntax, "--fps-limit", options.fps_limit, "F", "Draw no more frames a second than this",
              parse_positive);
}

void add_view_options(Syntax syntax, WalkOptions& options) {
    const auto headless = [&options] { options.drawing = Drawing::headless; };
    syntax.flag("--headless", headless, "Draw off-screen; needs no display");
    add_value(syntax, "--size", options.size_px, "WxH", "Pixels", parse_size).shown_default("1024x768");
    add_value(syntax, "--fov", options.horizontal_fov, "DEGREES", "Horizontal field of view, 1 to 170",
              [](const std::string& text) -> Result<Angle> {
                  const auto degrees = parse_number(text, {1.0, 170.0});
                  if (!degrees) return degrees.error();
                  return Angle::from_degrees(*degrees);
              })
        .shown_default("75");
    add_value(syntax, "--exaggeration", options.exaggeration, "FACTOR", "Heights are drawn times this",
              [](const std::string& text) {
                  return parse_number(text, {0.01, 100.0});
              })
        .shown_default("1");
    add_value(syntax, "--sun", options.sun, "AZIMUTH,ELEVATION|TIME",
              "Where the sun stands, in degrees, or when, in UTC: 2026-06-21T09:00Z", parse_sun);
    add_value(syntax, "--background", options.background, "RRGGBB", "A plain colour instead of sky and haze",
              parse_colour);
}

Result<int> parse_detail(const std::string& text) {
    if (text == "off") return 0;
    const auto levels = parse_integer(text, {1, io::DetailInfo::kMostOctaves});
    if (!levels)
        return Error{"'" + text + "' is not known: use off, or 1 to " +
                     std::to_string(io::DetailInfo::kMostOctaves)};
    return static_cast<int>(*levels);
}

std::string detail_text(int levels) { return levels == 0 ? "off" : std::to_string(levels); }

void add_terrain_options(Syntax syntax, WalkOptions& options) {
    add_choice(syntax, "--surface", options.surface, {"mesh", "disc", "quadtree"},
               "How tiles become triangles");
    add_choice(syntax, "--criterion", options.criterion, {"screen_error", "distance", "roughness", "density"},
               "What decides how finely terrain is drawn");
    add_choice(syntax, "--lod", options.lod, {"gpu", "cpu"}, "Who chooses the quadtree's levels");
    add_choice(syntax, "--shadows", options.shadows, {"off", "pvs", "all"},
               "Shadows of mountains: of those whose shadows can be seen, or of all");
    add_choice(syntax, "--imagery", options.imagery, {"on", "off"},
               "The store's imagery, or a tint by height and slope as where it has none");
    add_value(syntax, "--pixel-error", options.pixel_error, "PX",
              "The error that the drawn terrain may show, in pixels",
              [](const std::string& text) {
                  return parse_number(text, {0.05, 1000.0});
              })
        .shown_default("1");
    add_choice(syntax, "--horizon", options.horizon, {"ridges", "boxes", "off"},
               "Leave out what mountains hide");
}

void add_detail_options(Syntax syntax, WalkOptions& options) {
    add_value(syntax, "--detail", options.detail_levels, "off|LEVELS",
              "Ground made below the source, at up to so many times twice its samples", parse_detail)
        .shown_default("off");
    add_value(syntax, "--detail-roughness", options.detail_roughness, "FACTOR",
              "How high the bumps of made ground are, against what the source foretells; 0 to 4",
              [](const std::string& text) {
                  return parse_number(text, {0.0, 4.0});
              })
        .shown_default("1");
}

void add_cache_options(Syntax syntax, WalkOptions& options) {
    add_caches(syntax, options.caches);
    syntax.flag("--wait-for-tiles", options.wait_for_tiles,
                "Draw each frame only once all it wants is there");
    add_value(
        syntax, "--fault", options.faults, "SPEC",
        "Make reads fail, for tests: delay=50ms,error=0.1,short-read=0.05,corrupt=0.01,seed=1,until=100",
        pager::parse_fault);
}

void add_output_options(Syntax syntax, WalkOptions& options) {
    add_values(syntax, "--shot", options.shots, "FRAME:FILE.png",
               "Save a frame as a picture; may be repeated", parse_shot)
        .one_value_each();
    syntax.flag("--hud", options.hud, "Show figures over the picture, in screenshots too");
    const auto hud_map = [&options] { options.hud = options.hud_map = true; };
    syntax.flag("--hud-map", hud_map,
                "With the figures, what the horizon hides: a strip of it, and a map of the nodes");
    const auto hud_levels = [&options] { options.hud = options.hud_map = options.hud_levels = true; };
    syntax.flag("--hud-levels", hud_levels, "The same, with the quadtree's levels on the map");
    add_path(syntax, "--telemetry", options.telemetry, "DIR",
             "Write frames.csv, summary.json and trace.json to DIR");
    add_path(syntax, "--soak", options.soak, "FILE.csv",
             "Watch memory, handles and CPU time a frame, second by second, and fail where one rises");
}

std::string size_text(glm::ivec2 size) { return std::to_string(size.x) + "x" + std::to_string(size.y); }

std::string path_text(const PathChoice& path) {
    if (path.kind == PathChoice::Kind::file) return path.file.string();
    return path.kind == PathChoice::Kind::ground ? "ground" : "orbit";
}

std::string colour_text(const Colour& colour) {
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "%02X%02X%02X", unsigned{colour.red}, unsigned{colour.green},
                  unsigned{colour.blue});
    return text.data();
}

std::string short_number(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.10g", value);
    return text.data();
}

std::string sun_text(const SunChoice& sun) {
    if (const auto* direction = std::get_if<SunDirection>(&sun))
        return short_number(direction->azimuth.degrees()) + "," +
               short_number(direction->elevation.degrees());
    const auto time = std::get<std::chrono::sys_seconds>(sun);
    const auto day = std::chrono::floor<std::chrono::days>(time);
    const std::chrono::year_month_day date(day);
    const std::chrono::hh_mm_ss clock(time - day);
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%04d-%02u-%02uT%02ld:%02ld:%02ldZ",
                  static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                  static_cast<unsigned>(date.day()), static_cast<long>(clock.hours().count()),
                  static_cast<long>(clock.minutes().count()), static_cast<long>(clock.seconds().count()));
    return text.data();
}

std::string fault_text(const pager::FaultSpec& faults) {
    const double delay_ms = std::chrono::duration<double, std::milli>(faults.delay).count();
    std::string text = "delay=" + short_number(delay_ms) + "ms,error=" + short_number(faults.error) +
                       ",short-read=" + short_number(faults.short_read) +
                       ",corrupt=" + short_number(faults.corrupt) + ",seed=" + std::to_string(faults.seed);
    if (faults.until_frame != pager::FaultSpec{}.until_frame)
        text += ",until=" + std::to_string(faults.until_frame);
    return text;
}

}  // namespace

void add_walk_options(Syntax syntax, WalkOptions& options) {
    add_store(syntax, options.directory);
    add_course_options(syntax, options);
    add_view_options(syntax, options);
    add_terrain_options(syntax, options);
    add_detail_options(syntax, options);
    add_cache_options(syntax, options);
    add_output_options(syntax, options);
}

std::vector<std::pair<std::string, telemetry::OptionValue>> described(const WalkOptions& options) {
    std::vector<std::pair<std::string, telemetry::OptionValue>> list = {
        {"size", size_text(options.size_px)},
        {"fov", std::stod(short_number(options.horizontal_fov.degrees()))},
        {"headless", options.drawing == Drawing::headless},
        {"surface", options.surface},
        {"criterion", options.criterion},
        {"pixel-error", options.pixel_error},
        {"horizon", options.horizon},
        {"lod", options.lod},
        {"detail", detail_text(options.detail_levels)},
        {"detail-roughness", options.detail_roughness},
        {"shadows", options.shadows},
        {"imagery", options.imagery},
        {"exaggeration", options.exaggeration},
        {"ram-cache", static_cast<std::int64_t>(options.caches.ram_bytes)},
        {"gpu-cache", static_cast<std::int64_t>(options.caches.gpu_bytes)},
        {"wait-for-tiles", options.wait_for_tiles},
        {"hud", options.hud},
        {"hud-map", options.hud_map},
        {"hud-levels", options.hud_levels}};
    if (options.path || options.drawing == Drawing::headless)
        list.emplace_back("path", path_text(options.path.value_or(PathChoice{})));
    if (options.frames) list.emplace_back("frames", *options.frames);
    if (options.seconds) list.emplace_back("seconds", *options.seconds);
    if (options.fps_limit) list.emplace_back("fps-limit", *options.fps_limit);
    if (options.sun) list.emplace_back("sun", sun_text(*options.sun));
    if (options.background) list.emplace_back("background", colour_text(*options.background));
    if (options.faults.any()) list.emplace_back("fault", fault_text(options.faults));
    return list;
}

}  // namespace ridgeline::app
