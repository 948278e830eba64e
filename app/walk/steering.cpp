#include "ridgeline/app/walk/steering.h"

#include <algorithm>
#include <array>

namespace ridgeline::app {
namespace {

using platform::Input;
using platform::Key;
using platform::MouseMode;

void toggle(Panel& panel) { panel = panel == Panel::shown ? Panel::hidden : Panel::shown; }

// Escape undoes one thing after the other; with nothing to undo, it ends the walk.
bool escape(WalkSettings& settings) {
    if (settings.go_to == Panel::shown)
        settings.go_to = Panel::hidden;
    else if (settings.help == Panel::shown)
        settings.help = Panel::hidden;
    else if (settings.measured == Panel::shown)
        settings.measured = Panel::hidden;
    else if (settings.mouse == MouseMode::captured)
        settings.mouse = MouseMode::free;
    else
        return true;
    return false;
}

void exaggerate(const Input& input, WalkSettings& settings) {
    double& exaggeration = settings.exaggeration;
    if (input.pressed(Key::page_up)) exaggeration *= kExaggerationStep;
    if (input.pressed(Key::page_down)) exaggeration /= kExaggerationStep;
    if (input.pressed(Key::end)) exaggeration = 1.0;
    exaggeration = std::clamp(exaggeration, kLeastExaggeration, kMostExaggeration);
}

select::CasterSet next_shadows(select::CasterSet shadows) {
    using select::CasterSet;
    if (shadows == CasterSet::none) return CasterSet::pvs;
    return shadows == CasterSet::pvs ? CasterSet::all : CasterSet::none;
}

select::HorizonMode next_horizon(select::HorizonMode horizon) {
    using select::HorizonMode;
    if (horizon == HorizonMode::off) return HorizonMode::boxes;
    return horizon == HorizonMode::boxes ? HorizonMode::ridges : HorizonMode::off;
}

MapRange next_range(MapRange range) {
    return range == MapRange::whole ? MapRange::fitting : static_cast<MapRange>(static_cast<int>(range) + 1);
}

// The horizon's panels stand among the figures: to ask for them shows both.
void toggle_horizon_view(WalkSettings& settings) {
    if (settings.hud == Panel::hidden) settings.horizon_view = Panel::hidden;
    toggle(settings.horizon_view);
    if (settings.horizon_view == Panel::shown) settings.hud = Panel::shown;
}

// The levels have no panel of their own: to ask for them brings the map.
void toggle_levels(WalkSettings& settings) {
    const bool shown = settings.hud == Panel::shown && settings.horizon_view == Panel::shown;
    const bool levels = shown && settings.map_theme == MapTheme::levels;
    settings.map_theme = levels ? MapTheme::fates : MapTheme::levels;
    settings.hud = settings.horizon_view = Panel::shown;
}

render::Surface next_surface(render::Surface surface) {
    if (surface == render::Surface::mesh) return render::Surface::disc;
    return surface == render::Surface::disc ? render::Surface::quadtree : render::Surface::mesh;
}

}  // namespace

WalkRequests apply_keys(const Input& input, WalkSettings& settings) {
    WalkRequests requests;
    requests.quit = input.close_requested || (input.pressed(Key::escape) && escape(settings));
    // While a place is typed, letters are text.
    if (settings.go_to == Panel::shown) return requests;
    if (input.pressed(Key::f1)) toggle(settings.help);
    if (input.pressed(Key::f2)) toggle(settings.hud);
    if (input.pressed(Key::f3))
        settings.fill = settings.fill == render::Fill::solid ? render::Fill::wireframe : render::Fill::solid;
    if (input.pressed(Key::f4)) settings.shadows = next_shadows(settings.shadows);
    if (input.pressed(Key::f5)) settings.horizon = next_horizon(settings.horizon);
    if (input.pressed(Key::f6)) settings.surface = next_surface(settings.surface);
    if (input.pressed(Key::f7)) settings.detail = !settings.detail;
    if (input.pressed(Key::i))
        settings.cover = settings.cover == render::Cover::tint ? render::Cover::imagery : render::Cover::tint;
    if (input.pressed(Key::h)) toggle_horizon_view(settings);
    if (input.pressed(Key::l)) toggle_levels(settings);
    if (input.pressed(Key::z)) settings.map_range = next_range(settings.map_range);
    if (input.pressed(Key::g)) {
        settings.go_to = Panel::shown;
        settings.mouse = MouseMode::free;
    }
    if (input.pressed(Key::m))
        settings.mouse = settings.mouse == MouseMode::free ? MouseMode::captured : MouseMode::free;
    exaggerate(input, settings);
    requests.pause = input.pressed(Key::space);
    requests.walk_or_fly = input.pressed(Key::f);
    requests.record = input.pressed(Key::r);
    requests.replay = input.pressed(Key::p);
    requests.screenshot = input.pressed(Key::f12);
    requests.home = input.pressed(Key::home);
    return requests;
}

render::Daylight moved_sun(const Input& input, const WalkSettings& settings, const render::Daylight& sun,
                           std::chrono::duration<double> dt) {
    // While a place is typed, the arrows move the cursor.
    if (settings.go_to == Panel::shown) return sun;
    const auto held = [&](Key more, Key less) {
        return (input.down(more) ? 1.0 : 0.0) - (input.down(less) ? 1.0 : 0.0);
    };
    const double time_s = dt.count() * (input.down(Key::shift) ? 0.1 : 1.0);
    const Angle azimuth = sun.sun_azimuth + kSunTurnPerSecond * (time_s * held(Key::right, Key::left));
    const Angle elevation = sun.sun_elevation + kSunRisePerSecond * (time_s * held(Key::up, Key::down));
    return {azimuth, std::clamp(elevation, kLowestSun, kHighestSun)};
}

std::span<const KeyHelp> key_help() {
    static constexpr std::array<KeyHelp, 29> kHelp = {{
        {"W A S D", "move"},
        {"Q / E", "down / up"},
        {"Shift", "five times as fast"},
        {"Wheel", "speed"},
        {"Mouse, held", "look around"},
        {"M", "look without holding"},
        {"Click", "a point's place and height; again: a line and its profile"},
        {"Right click", "clear what was measured"},
        {"F", "walk on the ground / fly"},
        {"G", "go to a place"},
        {"Home", "back to the overview"},
        {"Page Up / Down", "exaggerate heights; End: as they are"},
        {"Left / Right", "turn the sun; Shift: slowly"},
        {"Up / Down", "raise / sink the sun"},
        {"Space", "pause / follow the path"},
        {"R", "record a path; again: save it"},
        {"P", "play the recording"},
        {"F2", "figures on / off"},
        {"F3", "triangles"},
        {"F4", "shadows: off, of what is seen, of all"},
        {"F5", "horizon: off, boxes, ridges"},
        {"F6", "surface: mesh, disc, quadtree"},
        {"F7", "ground made below the source, with --detail"},
        {"I", "imagery, where the terrain has it / tint"},
        {"H", "what the horizon hides: strip and map"},
        {"L", "the quadtree's levels on the map"},
        {"Z", "the map's range"},
        {"F12", "save a picture"},
        {"Esc", "close, let go, leave"},
    }};
    return kHelp;
}

}  // namespace ridgeline::app
