// How the map colours the quadtree's levels: fine ones glow, coarse ones lie in the cold.
#pragma once

#include <imgui.h>

#include <array>
#include <cstddef>
#include <span>

#include "ridgeline/app/hud/level_scene.h"

namespace ridgeline::app {

struct LevelLook {
    ImU32 fill = 0;
    ImU32 line = 0;
};
LevelLook look_of(const LevelCell& cell);

// A line of the legend: cells that are drawn of a level.
struct LevelEntry {
    std::array<char, 32> name;
    float quad_m;
    std::uint32_t count;
    LevelLook look;
};
constexpr std::size_t kMostLevelEntries = LevelScene::kLevels;
// Of the levels that are drawn, the finest first. entries: memory for them.
std::span<const LevelEntry> legend_of(const LevelScene& scene,
                                      std::array<LevelEntry, kMostLevelEntries>& entries);

}  // namespace ridgeline::app
