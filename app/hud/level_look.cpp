#include "ridgeline/app/hud/level_look.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ridgeline/app/hud/hud_style.h"

namespace ridgeline::app {
namespace {

// Lightness falls from level to level, so that they are told apart without hue too.
constexpr std::array<ImU32, 13> kInks = {
    IM_COL32(255, 244, 158, 255), IM_COL32(255, 206, 84, 255), IM_COL32(250, 158, 60, 255),
    IM_COL32(236, 108, 72, 255),  IM_COL32(206, 66, 104, 255), IM_COL32(160, 46, 138, 255),
    IM_COL32(112, 48, 158, 255),  IM_COL32(72, 58, 160, 255),  IM_COL32(46, 66, 142, 255),
    IM_COL32(34, 66, 112, 255),   IM_COL32(24, 52, 84, 255),   IM_COL32(18, 40, 60, 255),
    IM_COL32(12, 28, 40, 255)};
constexpr float kFill = 0.46f, kLine = 0.85f;
// Of cells that are not drawn.
constexpr float kFaintFill = 0.16f, kFaintLine = 0.22f;

ImU32 ink_of(int level) {
    return kInks[std::min(static_cast<std::size_t>(std::max(level, 0)), kInks.size() - 1)];
}

}  // namespace

LevelLook look_of(const LevelCell& cell) {
    const ImU32 ink = ink_of(cell.level);
    return {faded(ink, cell.in_view ? kFill : kFaintFill), faded(ink, cell.in_view ? kLine : kFaintLine)};
}

std::span<const LevelEntry> legend_of(const LevelScene& scene,
                                      std::array<LevelEntry, kMostLevelEntries>& entries) {
    std::size_t count = 0;
    for (std::size_t level = 0; level < scene.drawn.size() && count < entries.size(); ++level) {
        if (scene.drawn[level] == 0) continue;
        LevelEntry& entry = entries[count++];
        const double quad_m = std::ldexp(static_cast<double>(scene.finest_quad_m), static_cast<int>(level));
        std::snprintf(entry.name.data(), entry.name.size(), "quads of %.4g m", quad_m);
        entry.quad_m = static_cast<float>(quad_m);
        entry.count = scene.drawn[level];
        entry.look = look_of({.level = static_cast<int>(level), .in_view = true});
    }
    return std::span<const LevelEntry>(entries).first(count);
}

}  // namespace ridgeline::app
