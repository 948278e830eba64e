#include "ridgeline/app/hud/horizon_strip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "ridgeline/app/hud/fate_look.h"
#include "ridgeline/app/hud/hud_style.h"
#include "ridgeline/select/horizon_profile.h"

namespace ridgeline::app {
namespace {

constexpr float kDegrees = 180.0f / std::numbers::pi_v<float>;
// As the map's: the share of the way left after a second is e to the minus this.
constexpr float kFollow_per_s = 5.0f;
constexpr float kLeastSpan = 12.0f;  // degrees of elevation
constexpr float kTicks_px = 16.0f;   // under the picture of the horizon, for azimuths

constexpr ImU32 kSkyHigh = IM_COL32(34, 48, 66, 235);
constexpr ImU32 kSkyLow = IM_COL32(78, 100, 120, 235);
constexpr ImU32 kGroundHigh = IM_COL32(34, 52, 112, 245);
constexpr ImU32 kGroundLow = IM_COL32(10, 16, 40, 245);
constexpr ImU32 kRidge = IM_COL32(255, 206, 110, 255);

bool is_horizon(float slope) { return slope > select::kNotLookedAt; }
float elevation(float slope) { return std::atan(slope) * kDegrees; }

// Draws one scene into a rectangle of the screen.
class StripPainter {
  public:
    StripPainter(ImDrawList& list, const HorizonScene& scene, const ElevationRange& range,
                 const ImVec2& corner, const ImVec2& size)
        : list_(list),
          scene_(scene),
          range_(range),
          from_(corner),
          to_(corner.x + size.x, corner.y + size.y - kTicks_px),
          reach_(static_cast<float>(scene.profile_reach.degrees())) {}

    void paint() const {
        list_.PushClipRect(from_, ImVec2(to_.x, to_.y + kTicks_px), true);
        list_.AddRectFilledMultiColor(from_, to_, kSkyHigh, kSkyHigh, kSkyLow, kSkyLow);
        list_.PushClipRect(from_, to_, true);
        paint_ground();
        paint_nodes();
        paint_ridge();
        paint_elevations();
        paint_picture();
        list_.PopClipRect();
        paint_azimuths();
        list_.PopClipRect();
        list_.AddRect(from_, to_, IM_COL32(232, 236, 240, 60));
    }

  private:
    // Degrees right of the heading, and above the level.
    float x(float azimuth) const {
        return from_.x + (azimuth + reach_) / (2.0f * reach_) * (to_.x - from_.x);
    }
    float y(float degrees) const {
        return to_.y - (degrees - range_.least) / (range_.most - range_.least) * (to_.y - from_.y);
    }
    float step_x(std::size_t step) const {
        return from_.x + (to_.x - from_.x) * static_cast<float>(step) / HorizonScene::kProfileSteps;
    }

    // Neighbours with a horizon make one strip of quads.
    void paint_ground() const {
        for (std::size_t i = 0; i < scene_.profile.size(); ++i) {
            const float left = step_x(i), right = step_x(i + 1), slope = scene_.profile[i];
            if (slope == select::kNotLookedAt) {
                list_.AddRectFilled(ImVec2(left, from_.y), ImVec2(right, to_.y), IM_COL32(14, 19, 26, 190));
            } else if (is_horizon(slope)) {
                const float top = y(elevation(slope));
                list_.AddRectFilledMultiColor(ImVec2(left, top), ImVec2(right, to_.y), kGroundHigh,
                                              kGroundHigh, kGroundLow, kGroundLow);
            }
        }
    }
    void paint_ridge() const {
        for (std::size_t i = 0; i + 1 < scene_.profile.size(); ++i) {
            const float a = scene_.profile[i], b = scene_.profile[i + 1];
            if (!is_horizon(a) || !is_horizon(b)) continue;
            list_.AddLine(ImVec2(0.5f * (step_x(i) + step_x(i + 1)), y(elevation(a))),
                          ImVec2(0.5f * (step_x(i + 1) + step_x(i + 2)), y(elevation(b))), kRidge, 1.5f);
        }
    }
    // The tops of the nodes' boxes: those that are hidden lie under the horizon.
    void paint_nodes() const {
        for (const SceneNode& node : scene_.nodes) {
            if (node.report.in_view == 0) continue;
            paint_top(node);
        }
    }
    void paint_top(const SceneNode& node) const {
        const auto heading = static_cast<float>(scene_.heading.radians());
        float least = 1e9f, most = -1e9f;
        const glm::vec2 centre = node.corner_m + glm::vec2(0.5f, -0.5f) * node.side_m;
        const float middle = std::atan2(centre.x, centre.y) - heading;
        for (int corner = 0; corner < 4; ++corner) {
            const glm::vec2 at = node.corner_m + glm::vec2((corner & 1) != 0 ? node.side_m.x : 0.0f,
                                                           (corner & 2) != 0 ? -node.side_m.y : 0.0f);
            const float away =
                std::remainder(std::atan2(at.x, at.y) - heading - middle, 2.0f * std::numbers::pi_v<float>);
            least = std::min(least, away);
            most = std::max(most, away);
        }
        if (most - least > 1.0f) return;  // about the eye: no top to speak of
        const float azimuth = std::remainder(middle, 2.0f * std::numbers::pi_v<float>);
        const float top = y(std::atan(node.top_m / glm::length(centre)) * kDegrees);
        list_.AddLine(ImVec2(x((azimuth + least) * kDegrees), top),
                      ImVec2(x((azimuth + most) * kDegrees), top), faded(look_of(node.report).line, 0.7f),
                      1.0f);
    }
    void paint_elevations() const {
        const float step = range_.most - range_.least > 40.0f   ? 20.0f
                           : range_.most - range_.least > 18.0f ? 10.0f
                                                                : 5.0f;
        for (float degrees = std::ceil(range_.least / step) * step; degrees < range_.most; degrees += step) {
            const bool level = degrees == 0.0f;
            list_.AddLine(ImVec2(from_.x, y(degrees)), ImVec2(to_.x, y(degrees)),
                          level ? IM_COL32(255, 255, 255, 150) : IM_COL32(255, 255, 255, 34));
            std::array<char, 16> text{};
            std::snprintf(text.data(), text.size(), level ? "0\xc2\xb0" : "%+.0f\xc2\xb0",
                          static_cast<double>(degrees));
            list_.AddText(ImVec2(from_.x + 4.0f, y(degrees) - 14.0f), level ? kInk : kFaintInk, text.data());
        }
    }
    // The picture's left and right borders, and what is beyond them in the dark.
    void paint_picture() const {
        constexpr int kParts = 16;
        ImVec2 before;
        for (const float side : {-1.0f, 1.0f})
            for (int i = 0; i <= kParts; ++i) {
                const ImVec2 here = border(side, 2.0f * static_cast<float>(i) / kParts - 1.0f);
                if (i > 0) list_.AddLine(before, here, IM_COL32(255, 255, 255, 170), 1.5f);
                before = here;
            }
    }
    // across, up: -1 to 1 over the picture.
    ImVec2 border(float across, float up) const {
        const auto pitch = static_cast<float>(scene_.pitch.radians());
        const float right = across * scene_.half_tangents.x, above = up * scene_.half_tangents.y;
        const float ahead = std::cos(pitch) - above * std::sin(pitch);
        const float rise = std::sin(pitch) + above * std::cos(pitch);
        return {x(std::atan2(right, ahead) * kDegrees),
                y(std::atan2(rise, std::hypot(right, ahead)) * kDegrees)};
    }
    void paint_azimuths() const {
        static constexpr const char* kWinds[8] = {"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
        const auto heading = static_cast<float>(scene_.heading.degrees());
        for (int mark = 0; mark < 360; mark += 15) {
            const float away = std::remainder(static_cast<float>(mark) - heading, 360.0f);
            if (std::abs(away) > reach_) continue;
            const bool wind = mark % 45 == 0;
            list_.AddLine(ImVec2(x(away), to_.y), ImVec2(x(away), to_.y + (wind ? 5.0f : 3.0f)),
                          wind ? kInk : kFaintInk);
            std::array<char, 16> text{};
            std::snprintf(text.data(), text.size(), "%d\xc2\xb0", mark);
            const char* name = wind ? kWinds[mark / 45] : text.data();
            list_.AddText(ImVec2(x(away) - 0.5f * ImGui::CalcTextSize(name).x, to_.y + 4.0f),
                          mark == 0 ? kAccent
                          : wind    ? kInk
                                    : kFaintInk,
                          name);
        }
        const float middle = x(0.0f);
        list_.AddTriangleFilled(ImVec2(middle - 5.0f, from_.y), ImVec2(middle + 5.0f, from_.y),
                                ImVec2(middle, from_.y + 7.0f), kAccent);
    }

    ImDrawList& list_;
    const HorizonScene& scene_;
    ElevationRange range_;
    ImVec2 from_, to_;
    float reach_;  // degrees
};

}  // namespace

ElevationRange elevation_range(const HorizonScene& scene) {
    float least = 0.0f, most = 0.0f;
    for (const float slope : scene.profile) {
        if (!is_horizon(slope)) continue;
        least = std::min(least, elevation(slope));
        most = std::max(most, elevation(slope));
    }
    const float spare = std::max(0.18f * (most - least), 0.5f * (kLeastSpan - (most - least)));
    return {least - spare, most + spare};
}

void HorizonStrip::build(const HorizonScene& scene, const glm::vec2& right_bottom, const glm::vec2& size_px,
                         float dt_s) {
    const ElevationRange target = elevation_range(scene);
    const float share = placed_ ? 1.0f - std::exp(-kFollow_per_s * dt_s) : 1.0f;
    placed_ = true;
    range_ = {range_.least + share * (target.least - range_.least),
              range_.most + share * (target.most - range_.most)};
    ImGui::SetNextWindowPos(ImVec2(right_bottom.x, right_bottom.y), ImGuiCond_Always, ImVec2(1.0f, 1.0f));
    ImGui::SetNextWindowSize(ImVec2(size_px.x, size_px.y));
    ImGui::Begin("horizon", nullptr, kFiguresFlags & ~ImGuiWindowFlags_AlwaysAutoResize);
    const ImVec2 padding = ImGui::GetStyle().WindowPadding;
    StripPainter(*ImGui::GetWindowDrawList(), scene, range_, ImGui::GetCursorScreenPos(),
                 ImVec2(size_px.x - 2.0f * padding.x, size_px.y - 2.0f * padding.y))
        .paint();
    ImGui::End();
}

}  // namespace ridgeline::app
