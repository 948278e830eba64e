// What the HUD's panels have in common: margins, inks, flags. For files that draw with ImGui.
#pragma once

#include <imgui.h>

namespace ridgeline::app {

constexpr float kMargin_px = 12.0f;
constexpr float kPanelWidth_px = 268.0f;

constexpr ImU32 kInk = IM_COL32(232, 236, 240, 255);
constexpr ImU32 kFaintInk = IM_COL32(232, 236, 240, 120);
constexpr ImU32 kAccent = IM_COL32(255, 196, 92, 255);
constexpr ImU32 kPaper = IM_COL32(14, 19, 26, 168);
inline const ImVec4 kLabelColor = ImVec4(0.62f, 0.68f, 0.74f, 1.0f);

constexpr ImGuiWindowFlags kPanelFlags =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
    ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize;
constexpr ImGuiWindowFlags kFiguresFlags = kPanelFlags | ImGuiWindowFlags_NoInputs;

// A colour with its opacity times a share from 0 to 1.
inline ImU32 faded(ImU32 color, float share) {
    const auto alpha = static_cast<float>(color >> IM_COL32_A_SHIFT);
    const auto left = static_cast<ImU32>(alpha * (share < 0.0f ? 0.0f : share > 1.0f ? 1.0f : share));
    return (color & ~IM_COL32_A_MASK) | (left << IM_COL32_A_SHIFT);
}

}  // namespace ridgeline::app
