#include "ridgeline/app/hud/node_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "ridgeline/app/hud/fate_look.h"
#include "ridgeline/app/hud/hud_style.h"
#include "ridgeline/app/hud/level_look.h"
#include "ridgeline/app/hud/map_ground.h"

namespace ridgeline::app {
namespace {

// The share of the drawn nodes that a fitting map shows at least.
constexpr double kFittingShare = 0.8;
// Of the map's half side, how far ahead of the eye its middle lies: there is more to be seen ahead.
constexpr float kAhead = 0.45f;
// Sides of the finest nodes that a near and a far map show.
constexpr float kNearSides = 8.0f;
constexpr float kFarSides = 40.0f;
// How fast the map follows: the share of the way left after a second is e to the minus this.
constexpr float kFollow_per_s = 5.0f;
// Squares below this size on the screen have no outline, or there would be nothing else.
constexpr float kLeastOutlined_px = 3.5f;
constexpr float kWedge_px = 2000.0f;  // farther than any map

glm::vec2 direction(double azimuth_radians) {
    return {static_cast<float>(std::sin(azimuth_radians)), static_cast<float>(std::cos(azimuth_radians))};
}

MapView ahead_of_eye(const HorizonScene& scene, float half_m) {
    // Looking down, what is seen lies about the eye.
    const auto level = static_cast<float>(std::cos(scene.pitch.radians()));
    return {direction(scene.heading.radians()) * (kAhead * half_m * level), half_m};
}

MapView whole(const HorizonScene& scene) {
    const glm::vec2 extent = scene.most_m - scene.least_m;
    return {0.5f * (scene.least_m + scene.most_m), 0.53f * std::max(extent.x, extent.y)};
}

// Within it lie most of the drawn nodes.
float reach_m(const HorizonScene& scene, std::vector<float>& distances_m) {
    distances_m.clear();
    for (const SceneNode& node : scene.nodes)
        if (node.report.drawn != 0)
            distances_m.push_back(glm::length(node.corner_m + glm::vec2(0.5f, -0.5f) * node.side_m) +
                                  0.5f * node.side_m.x);
    if (distances_m.empty()) return kFarSides * scene.finest_side_m;
    const auto place =
        static_cast<std::ptrdiff_t>(kFittingShare * static_cast<double>(distances_m.size() - 1));
    std::nth_element(distances_m.begin(), distances_m.begin() + place, distances_m.end());
    return distances_m[static_cast<std::size_t>(place)];
}

// 1, 2 or 5 times a power of ten, not above `most`.
float round_length(float most) {
    const float power = std::pow(10.0f, std::floor(std::log10(most)));
    return most >= 5.0f * power ? 5.0f * power : most >= 2.0f * power ? 2.0f * power : power;
}

void format_length(std::array<char, 24>& text, float length_m) {
    if (length_m >= 1000.0f)
        std::snprintf(text.data(), text.size(), "%g km", static_cast<double>(length_m) / 1000.0);
    else
        std::snprintf(text.data(), text.size(), "%g m", static_cast<double>(length_m));
}

// Draws one scene into a square of the screen.
class MapPainter {
  public:
    MapPainter(ImDrawList& list, const MapContent& content, const MapView& view, const ImVec2& corner,
               float side_px)
        : list_(list),
          scene_(content.scene),
          levels_(content.levels),
          view_(view),
          corner_(corner),
          side_px_(side_px),
          px_per_m_(side_px / (2.0f * view.half_m)) {}

    void paint() const {
        const ImVec2 end(corner_.x + side_px_, corner_.y + side_px_);
        list_.AddRectFilled(corner_, end, IM_COL32(9, 12, 17, 235));
        list_.PushClipRect(corner_, end, true);
        clip_to_terrain();
        for (const SceneNode& node : scene_.nodes) paint_ground(node);
        levels_ ? paint_levels() : paint_fates();
        list_.PopClipRect();
        paint_rings();
        paint_wedge();
        paint_eye();
        paint_rim();
        paint_north();
        paint_scale_bar();
        list_.PopClipRect();
        list_.AddRect(corner_, end, IM_COL32(232, 236, 240, 60));
    }

  private:
    ImVec2 at(const glm::vec2& place_m) const {
        return {corner_.x + 0.5f * side_px_ + (place_m.x - view_.centre_m.x) * px_per_m_,
                corner_.y + 0.5f * side_px_ - (place_m.y - view_.centre_m.y) * px_per_m_};
    }
    bool on_map(const ImVec2& north_west, const ImVec2& south_east) const {
        return south_east.x > corner_.x && north_west.x < corner_.x + side_px_ && south_east.y > corner_.y &&
               north_west.y < corner_.y + side_px_;
    }
    struct Square {
        ImVec2 north_west, south_east;
    };
    Square square(const SceneNode& node) const {
        return {at(node.corner_m), at(node.corner_m + glm::vec2(1.0f, -1.0f) * node.side_m)};
    }
    Square quarter(const SceneNode& node, int q) const {
        const glm::vec2 half = 0.5f * node.side_m;
        const glm::vec2 corner =
            node.corner_m + glm::vec2((q & 1) != 0 ? half.x : 0.0f, (q & 2) != 0 ? -half.y : 0.0f);
        return {at(corner), at(corner + glm::vec2(1.0f, -1.0f) * half)};
    }
    // Nodes reach past the raster's edge; there is no ground.
    void clip_to_terrain() const {
        list_.PushClipRect(at({scene_.least_m.x, scene_.most_m.y}), at({scene_.most_m.x, scene_.least_m.y}),
                           true);
    }
    // 1 about the eye, less far away: the near nodes are what one looks for.
    float nearness(const SceneNode& node) const {
        const float away_m = glm::length(node.corner_m + glm::vec2(0.5f, -0.5f) * node.side_m);
        return 0.45f + 0.55f / (1.0f + std::pow(away_m / (1.2f * view_.half_m), 2.0f));
    }

    void paint_ground(const SceneNode& node) const {
        const Square s = square(node);
        if (!on_map(s.north_west, s.south_east)) return;
        // What is seen small looks flat.
        const float steepened = std::clamp(view_.half_m / 7000.0f, 1.2f, 4.0f);
        const GroundTint tint{scene_.lowest_m, scene_.highest_m, steepened};
        draw_ground(list_, node.ground, node.side_m, s.north_west, s.south_east, tint);
    }
    void paint_fates() const {
        for (const SceneNode& node : scene_.nodes) paint_fills(node);
        for (const SceneNode& node : scene_.nodes) paint_outline(node);
    }
    void paint_levels() const {
        for (const LevelCell& cell : levels_->cells) {
            const Square s{at(cell.corner_m), at(cell.corner_m + glm::vec2(1.0f, -1.0f) * cell.side_m)};
            if (!on_map(s.north_west, s.south_east)) continue;
            const LevelLook look = look_of(cell);
            list_.AddRectFilled(s.north_west, s.south_east, look.fill);
            paint_rim(s, look.line, 1.0f);
        }
    }
    void paint_fills(const SceneNode& node) const {
        for (int q = 0; q < 4; ++q) {
            if ((node.report.quarters >> q & 1u) == 0) continue;
            const Square s = quarter(node, q);
            if (on_map(s.north_west, s.south_east))
                list_.AddRectFilled(s.north_west, s.south_east, fill_of(node.report, q));
        }
    }
    void paint_outline(const SceneNode& node) const {
        const unsigned quarters = node.report.quarters;
        if (quarters == 0b1111) return paint_outline(square(node), node);
        for (int q = 0; q < 4; ++q)
            if ((quarters >> q & 1u) != 0) paint_outline(quarter(node, q), node);
    }
    void paint_outline(const Square& s, const SceneNode& node) const {
        if (on_map(s.north_west, s.south_east)) paint_rim(s, look_of(node.report).line, nearness(node));
    }
    void paint_rim(const Square& s, ImU32 line, float strength) const {
        const float side_px = s.south_east.x - s.north_west.x;
        if (side_px < kLeastOutlined_px) return;
        list_.AddRect(ImVec2(s.north_west.x + 0.5f, s.north_west.y + 0.5f),
                      ImVec2(s.south_east.x - 0.5f, s.south_east.y - 0.5f),
                      faded(line, std::clamp(side_px / 14.0f, 0.25f, 1.0f) * strength));
    }

    void paint_rings() const {
        const float step_m = round_length(0.6f * view_.half_m);
        for (int ring = 1; ring <= 4; ++ring)
            list_.AddCircle(at({0.0f, 0.0f}), static_cast<float>(ring) * step_m * px_per_m_,
                            IM_COL32(255, 255, 255, 34), 96);
    }
    // What the picture shows of the level, fading with distance.
    void paint_wedge() const {
        const double half_angle = std::atan(static_cast<double>(scene_.half_tangents.x));
        const ImVec2 eye = at({0.0f, 0.0f});
        paint_light(eye, half_angle);
        for (const double side : {-1.0, 1.0}) {
            const glm::vec2 edge = direction(scene_.heading.radians() + side * half_angle);
            constexpr int kParts = 24;
            const float reach_px = std::min(1.6f * side_px_, kWedge_px);
            for (int i = 0; i < kParts; ++i) {
                const float from = reach_px * static_cast<float>(i) / kParts;
                const float to = reach_px * static_cast<float>(i + 1) / kParts;
                const float share = 1.0f - static_cast<float>(i) / kParts;
                list_.AddLine(ImVec2(eye.x + edge.x * from, eye.y - edge.y * from),
                              ImVec2(eye.x + edge.x * to, eye.y - edge.y * to),
                              faded(IM_COL32(255, 255, 255, 220), share * share), 1.5f);
            }
        }
    }
    void paint_light(const ImVec2& eye, double half_angle) const {
        constexpr int kParts = 8;
        const float reach_px = 1.1f * side_px_;
        const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
        list_.PrimReserve(3 * kParts, kParts + 2);
        const unsigned first = list_._VtxCurrentIdx;
        list_.PrimWriteVtx(eye, white, IM_COL32(255, 246, 214, 74));
        for (int i = 0; i <= kParts; ++i) {
            const glm::vec2 edge =
                direction(scene_.heading.radians() + half_angle * (2.0 * i / kParts - 1.0)) * reach_px;
            list_.PrimWriteVtx(ImVec2(eye.x + edge.x, eye.y - edge.y), white, IM_COL32(255, 246, 214, 0));
        }
        for (unsigned i = 0; i < kParts; ++i)
            for (const unsigned vertex : {0u, i + 1, i + 2})
                list_.PrimWriteIdx(static_cast<ImDrawIdx>(first + vertex));
    }
    // An arrow that looks where the eye looks.
    void paint_eye() const {
        const ImVec2 eye = at({0.0f, 0.0f});
        const glm::vec2 ahead = direction(scene_.heading.radians());
        const auto corner = [&](float along, float across) {
            return ImVec2(eye.x + ahead.x * along + ahead.y * across,
                          eye.y - ahead.y * along + ahead.x * across);
        };
        const ImVec2 tip = corner(9.0f, 0.0f), left = corner(-6.0f, -5.5f), back = corner(-3.0f, 0.0f),
                     right = corner(-6.0f, 5.5f);
        for (const auto& [a, b] :
             {std::pair(tip, left), std::pair(left, back), std::pair(back, right), std::pair(right, tip)})
            list_.AddLine(a, b, IM_COL32(8, 10, 14, 230), 3.5f);
        list_.AddTriangleFilled(tip, back, left, IM_COL32(255, 255, 255, 255));
        list_.AddTriangleFilled(tip, right, back, IM_COL32(255, 255, 255, 255));
    }
    // The map's border fades into its panel.
    void paint_rim() const {
        const float rim = 0.07f * side_px_;
        const ImU32 dark = IM_COL32(9, 12, 17, 190), clear = IM_COL32(9, 12, 17, 0);
        const ImVec2 a = corner_, b(corner_.x + side_px_, corner_.y + side_px_);
        list_.AddRectFilledMultiColor(a, ImVec2(b.x, a.y + rim), dark, dark, clear, clear);
        list_.AddRectFilledMultiColor(ImVec2(a.x, b.y - rim), b, clear, clear, dark, dark);
        list_.AddRectFilledMultiColor(a, ImVec2(a.x + rim, b.y), dark, clear, clear, dark);
        list_.AddRectFilledMultiColor(ImVec2(b.x - rim, a.y), b, clear, dark, dark, clear);
    }
    void paint_north() const {
        const ImVec2 top(corner_.x + side_px_ - 14.0f, corner_.y + 8.0f);
        list_.AddCircleFilled(ImVec2(top.x, top.y + 12.0f), 15.0f, IM_COL32(9, 12, 17, 120), 24);
        list_.AddTriangleFilled(top, ImVec2(top.x + 4.5f, top.y + 11.0f), ImVec2(top.x - 4.5f, top.y + 11.0f),
                                kAccent);
        list_.AddText(ImVec2(top.x - 0.5f * ImGui::CalcTextSize("N").x, top.y + 12.0f), kInk, "N");
    }
    void paint_scale_bar() const {
        const float length_m = round_length(0.32f * side_px_ / px_per_m_);
        const float length_px = length_m * px_per_m_;
        const ImVec2 start(corner_.x + 8.0f, corner_.y + side_px_ - 9.0f);
        const auto stroke = [&](const ImVec2& from, const ImVec2& to) {
            list_.AddLine(from, to, IM_COL32(8, 10, 14, 200), 3.5f);
            list_.AddLine(from, to, kInk, 1.5f);
        };
        stroke(start, ImVec2(start.x + length_px, start.y));
        stroke(ImVec2(start.x, start.y - 4.0f), start);
        stroke(ImVec2(start.x + length_px, start.y - 4.0f), ImVec2(start.x + length_px, start.y));
        std::array<char, 24> text{};
        format_length(text, length_m);
        const ImVec2 place(start.x + 4.0f, start.y - 17.0f);
        list_.AddText(ImVec2(place.x + 1.0f, place.y + 1.0f), IM_COL32(8, 10, 14, 220), text.data());
        list_.AddText(place, kInk, text.data());
    }

    ImDrawList& list_;
    const HorizonScene& scene_;
    const LevelScene* levels_;
    MapView view_;
    ImVec2 corner_;
    float side_px_;
    float px_per_m_;
};

const char* mode_text(const HorizonScene& scene) {
    if (scene.mode == select::HorizonMode::off) return "horizon off";
    if (!scene.in_use) return "horizon: nothing hides";
    return scene.mode == select::HorizonMode::ridges ? "horizon: ridges" : "horizon: boxes";
}

void build_title(const MapContent& content) {
    ImGui::TextUnformatted(content.levels ? "quadtree: levels" : mode_text(content.scene));
    const char* text = name_of(content.range);
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(text).x);
    ImGui::TextColored(kLabelColor, "%s", text);
}

struct LegendLine {
    const char* name;
    std::uint32_t count;
    ImU32 fill, second_fill, line;
};

// On a ground like the map's.
void paint_swatch(const ImVec2& from, const ImVec2& to, const LegendLine& entry) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(from, to, IM_COL32(122, 120, 104, 255));
    list.AddRectFilled(from, to, entry.fill);
    if (entry.second_fill != entry.fill)
        list.AddTriangleFilled(ImVec2(to.x, from.y), to, ImVec2(from.x, to.y), entry.second_fill);
    list.AddRect(from, to, entry.line);
}

void build_legend_line(const LegendLine& entry) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float size = ImGui::GetTextLineHeight() - 2.0f;
    paint_swatch(ImVec2(corner.x, corner.y + 1.0f), ImVec2(corner.x + size, corner.y + 1.0f + size), entry);
    ImGui::SetCursorScreenPos(ImVec2(corner.x + size + 8.0f, corner.y));
    ImGui::TextColored(entry.count > 0 ? ImVec4(0.91f, 0.93f, 0.94f, 1.0f) : kLabelColor, "%s", entry.name);
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "%u", entry.count);
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(text.data()).x);
    ImGui::TextUnformatted(text.data());
}

LegendLine line_of(const LevelEntry& entry) {
    return {entry.name.data(), entry.count, entry.look.fill, entry.look.fill, entry.look.line};
}

// Levels in one line, from fine to coarse, between their quads' sides: where there is no room for a line each.
void build_level_strip(std::span<const LevelEntry> entries) {
    if (entries.empty()) return;
    std::array<char, 24> finest{}, coarsest{};
    format_length(finest, entries.front().quad_m);
    format_length(coarsest, entries.back().quad_m);
    ImGui::TextUnformatted(finest.data());
    ImGui::SameLine();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float coarsest_px = ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(coarsest.data()).x;
    const float room_px = coarsest_px - ImGui::GetCursorPosX() - ImGui::GetStyle().ItemSpacing.x;
    const float width_px = room_px / static_cast<float>(entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const ImVec2 from(corner.x + width_px * static_cast<float>(i), corner.y + 1.0f);
        paint_swatch(from, ImVec2(from.x + width_px - 1.0f, from.y + ImGui::GetTextLineHeight() - 2.0f),
                     line_of(entries[i]));
    }
    ImGui::SameLine(coarsest_px);
    ImGui::TextUnformatted(coarsest.data());
}

// Below the map; as much of it as there is room for.
class Legend {
  public:
    Legend(const MapContent& content, float room_px) : content_(content) {
        if (content.levels) levels_ = legend_of(*content.levels, entries_);
        const std::size_t all = content.levels ? levels_.size() : kLegendEntries;
        const auto fitting = static_cast<std::size_t>(std::max(room_px, 0.0f) / line_px());
        lines_ = all <= fitting ? all : content.levels && fitting > 0 ? 1 : 0;
        is_strip_ = content.levels && lines_ < all;
    }
    float height_px() const { return static_cast<float>(lines_) * line_px(); }
    void build() const {
        if (lines_ == 0) return;
        if (is_strip_) return build_level_strip(levels_);
        for (const LevelEntry& entry : levels_) build_legend_line(line_of(entry));
        if (content_.levels) return;
        for (const LegendEntry& entry : legend_of(content_.scene))
            build_legend_line({entry.name, entry.count, entry.look.fill, entry.second_fill, entry.look.line});
    }

  private:
    static float line_px() { return ImGui::GetTextLineHeightWithSpacing(); }

    const MapContent& content_;
    std::array<LevelEntry, kMostLevelEntries> entries_;
    std::span<const LevelEntry> levels_;
    std::size_t lines_ = 0;
    bool is_strip_ = false;
};

}  // namespace

const char* name_of(MapRange range) {
    static constexpr std::array<const char*, 4> kNames = {"in range", "near", "far", "whole"};
    return kNames[static_cast<std::size_t>(range)];
}

MapView map_view(const HorizonScene& scene, MapRange range, std::vector<float>& distances_m) {
    const MapView all = whole(scene);
    if (range == MapRange::whole) return all;
    float half_m = 0.5f * scene.finest_side_m * (range == MapRange::near ? kNearSides : kFarSides);
    if (range == MapRange::fitting)
        half_m = std::max(reach_m(scene, distances_m) / (1.0f + kAhead), 2.0f * scene.finest_side_m);
    return ahead_of_eye(scene, std::min(half_m, all.half_m));
}

void NodeMap::follow(const HorizonScene& scene, MapRange range, float dt_s) {
    const MapView target = map_view(scene, range, distances_m_);
    const float share = placed_ ? 1.0f - std::exp(-kFollow_per_s * dt_s) : 1.0f;
    placed_ = true;
    // By factors: each doubling takes as long.
    view_.half_m =
        std::exp(glm::mix(std::log(std::max(view_.half_m, 1e-3f)), std::log(target.half_m), share));
    view_.centre_m = glm::mix(view_.centre_m, target.centre_m, share);
}

void NodeMap::build(const MapContent& content, const MapPlace& place, float dt_s) {
    follow(content.scene, content.range, dt_s);
    // Its size is known, unlike that of other panels, which ImGui finds in their first frame.
    const ImVec2 padding = ImGui::GetStyle().WindowPadding;
    const float line_px = ImGui::GetTextLineHeightWithSpacing();
    const float height_px = place.side_px + line_px + 2.0f * padding.y;
    const Legend legend(content, place.most_height_px - height_px);
    ImGui::SetNextWindowPos(ImVec2(place.right_top_px.x, place.right_top_px.y), ImGuiCond_Always,
                            ImVec2(1.0f, 0.0f));
    ImGui::SetNextWindowSize(ImVec2(place.side_px + 2.0f * padding.x, height_px + legend.height_px()));
    ImGui::Begin("map", nullptr, kFiguresFlags & ~ImGuiWindowFlags_AlwaysAutoResize);
    build_title(content);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    MapPainter(*ImGui::GetWindowDrawList(), content, view_, corner, place.side_px).paint();
    ImGui::Dummy(ImVec2(place.side_px, place.side_px));
    legend.build();
    ImGui::End();
}

}  // namespace ridgeline::app
