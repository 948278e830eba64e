// How the horizon's panels colour what became of the ground: what is drawn stands in the light, what is
// hidden in the shadow.
//
// The hues are those of Okabe and Ito ("Color universal design", 2008), which people with any kind of colour
// vision tell apart; lightness alone tells seen from hidden.
#pragma once

#include <imgui.h>

#include <array>
#include <cstdint>

#include "ridgeline/app/walk/stage.h"

namespace ridgeline::app {

// Over the ground.
struct FateLook {
    ImU32 fill = 0;
    ImU32 line = 0;
};

// Of a node as a whole: its outline, and its swatch in the legend.
FateLook look_of(const select::NodeReport& report);
// Of one of its quarters.
ImU32 fill_of(const select::NodeReport& report, int quarter);

// A line of the legend.
struct LegendEntry {
    const char* name;
    std::uint32_t count;
    FateLook look;
    ImU32 second_fill;  // of the swatch's lower half
};
constexpr std::size_t kLegendEntries = 7;
std::array<LegendEntry, kLegendEntries> legend_of(const HorizonScene& scene);

}  // namespace ridgeline::app
