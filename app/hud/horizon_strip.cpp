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
// How fast the scale follows: the share of the way left after a second is e to the minus this.
constexpr float kFollow_per_s = 8.0f;
constexpr float kLeastSpan = 10.0f;  // degrees of elevation
constexpr float kWideTitle_px = 460.0f;
constexpr float kTicks_px = 16.0f;  // under the picture of the horizon, for azimuths

constexpr ImU32 kSkyHigh = IM_COL32(58, 84, 116, 235);
constexpr ImU32 kSkyLow = IM_COL32(132, 158, 178, 235);
constexpr ImU32 kGroundHigh = IM_COL32(30, 50, 116, 255);
constexpr ImU32 kGroundLow = IM_COL32(9, 14, 36, 255);
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
        paint_hidden();
        paint_ridge();
        paint_picture();
        paint_elevations();
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
    // What is hidden as a whole, as dots: the ground in the middle of each node, under the horizon.
    void paint_hidden() const {
        for (const SceneNode& node : scene_.nodes) {
            if (node.report.in_view == 0 || node.report.drawn != 0) continue;
            const glm::vec2 middle = node.corner_m + glm::vec2(0.5f, -0.5f) * node.side_m;
            const float away_m = glm::length(middle);
            const float azimuth = std::remainder(
                std::atan2(middle.x, middle.y) * kDegrees - static_cast<float>(scene_.heading.degrees()),
                360.0f);
            const float size_px = std::clamp(8.0f * node.side_m.x / away_m, 1.0f, 2.6f);
            list_.AddCircleFilled(ImVec2(x(azimuth), y(elevation(middle_m(node.ground) / away_m))), size_px,
                                  look_of(node.report).line, 8);
        }
    }
    static float middle_m(const SceneGround& ground) {
        const glm::ivec2 cell = ground.from + ground.cells / 2;
        const auto at = static_cast<std::size_t>(cell.y * ground.stride + cell.x);
        return ground.base_m +
               ground.step_m * static_cast<float>(at < ground.codes.size() ? ground.codes[at] : 0);
    }
    void paint_elevations() const {
        const float step = range_.most - range_.least > 40.0f   ? 20.0f
                           : range_.most - range_.least > 18.0f ? 10.0f
                                                                : 5.0f;
        for (float degrees = std::ceil(range_.least / step) * step; degrees < range_.most; degrees += step) {
            const bool level = degrees == 0.0f;
            list_.AddLine(ImVec2(from_.x, y(degrees)), ImVec2(to_.x, y(degrees)),
                          level ? IM_COL32(255, 255, 255, 150) : IM_COL32(255, 255, 255, 34));
            if (y(degrees) - 14.0f < from_.y) continue;
            std::array<char, 16> text{};
            std::snprintf(text.data(), text.size(), level ? "0\xc2\xb0" : "%+.0f\xc2\xb0",
                          static_cast<double>(degrees));
            list_.AddText(ImVec2(from_.x + 4.0f, y(degrees) - 14.0f), level ? kInk : kFaintInk, text.data());
        }
    }
    // The picture's left and right borders; what is beyond them lies in the dark.
    void paint_picture() const {
        constexpr int kParts = 16;
        for (const float side : {-1.0f, 1.0f}) {
            std::array<ImVec2, kParts + 3> points;
            for (std::size_t i = 0; i <= kParts; ++i)
                points[i] = border(side, 2.0f * static_cast<float>(i) / kParts - 1.0f);
            const float end = side < 0.0f ? from_.x : to_.x;
            points[kParts + 1] = ImVec2(end, points[kParts].y);
            points[kParts + 2] = ImVec2(end, points[0].y);
            list_.AddConvexPolyFilled(points.data(), kParts + 3, IM_COL32(9, 12, 17, 120));
            list_.AddPolyline(points.data(), kParts + 1, IM_COL32(255, 255, 255, 190), ImDrawFlags_None,
                              1.5f);
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

void build_title(const HorizonScene& scene) {
    using select::NodeFate;
    const auto count = [&](NodeFate fate) { return scene.counts[static_cast<std::size_t>(fate)]; };
    const std::uint32_t missing = count(NodeFate::hidden_missing), hidden = count(NodeFate::hidden) + missing;
    const std::uint32_t seen = count(NodeFate::drawn) + count(NodeFate::drawn_in_part) +
                               count(NodeFate::stands_in) + count(NodeFate::missing);
    std::array<char, 96> text{};
    const bool wide = ImGui::GetContentRegionAvail().x >= kWideTitle_px;
    if (!scene.in_use)
        std::snprintf(text.data(), text.size(), "hides nothing: all %u nodes in view are drawn", seen);
    else
        std::snprintf(
            text.data(), text.size(),
            wide ? "hides %u of %u nodes in view, %u of them not in memory" : "hides %u of %u nodes", hidden,
            hidden + seen, missing);
    ImGui::TextUnformatted("horizon");
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(text.data()).x);
    ImGui::TextColored(kLabelColor, "%s", text.data());
}

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
    build_title(scene);
    StripPainter(*ImGui::GetWindowDrawList(), scene, range_, ImGui::GetCursorScreenPos(),
                 ImGui::GetContentRegionAvail())
        .paint();
    ImGui::End();
}

}  // namespace ridgeline::app
