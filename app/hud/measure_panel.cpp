#include "ridgeline/app/hud/measure_panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ridgeline/app/hud/hud_style.h"

namespace ridgeline::app {
namespace {

constexpr float kWidth_px = 430.0f, kGraphHeight_px = 118.0f;
// Of the graph: for the heights on the left, the distances below.
constexpr float kLeftMargin_px = 46.0f, kBottomMargin_px = 17.0f;
constexpr float kLabelColumn_px = 76.0f;
constexpr ImU32 kOutline = IM_COL32(10, 14, 20, 190);
constexpr ImU32 kPoint = IM_COL32(255, 255, 255, 255);
constexpr ImU32 kGroundTop = IM_COL32(255, 196, 92, 120);
constexpr ImU32 kGroundBottom = IM_COL32(255, 196, 92, 14);
constexpr ImU32 kGridLine = IM_COL32(232, 236, 240, 34);
constexpr const char* kNames[2] = {"A", "B"};

struct Text {
    std::array<char, 96> letters{};
    operator const char*() const { return letters.data(); }
};

std::array<char, 24> length_text(double length_m) {
    std::array<char, 24> text{};
    if (length_m < 1000.0)
        std::snprintf(text.data(), text.size(), "%.1f m", length_m);
    else
        std::snprintf(text.data(), text.size(), "%.*f km", length_m < 1e5 ? 3 : 1, length_m / 1000.0);
    return text;
}

ImVec2 on_screen(const glm::dvec2& picture_place) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    return {static_cast<float>(picture_place.x) * size.x, static_cast<float>(picture_place.y) * size.y};
}

void draw_dashed(ImDrawList& list, const ImVec2& from, const ImVec2& to, ImU32 color) {
    constexpr float kDash_px = 5.0f;
    const glm::vec2 start(from.x, from.y), way = glm::vec2(to.x, to.y) - start;
    const float length = glm::length(way);
    // Beyond a few screens nobody counts dashes.
    if (length > 20000.0f) return;
    for (float at = 0.0f; at < length; at += 2.0f * kDash_px) {
        const glm::vec2 a = start + way * (at / length);
        const glm::vec2 b = start + way * (std::min(at + kDash_px, length) / length);
        list.AddLine(ImVec2(a.x, a.y), ImVec2(b.x, b.y), color, 1.0f);
    }
}

void draw_point(ImDrawList& list, const ImVec2& at, const char* label) {
    list.AddCircleFilled(at, 8.5f, kOutline, 24);
    list.AddCircle(at, 7.0f, kAccent, 24, 2.0f);
    list.AddCircleFilled(at, 2.5f, kPoint, 12);
    const ImVec2 size = ImGui::CalcTextSize(label);
    const ImVec2 corner(at.x + 13.0f, at.y - size.y - 7.0f);
    list.AddRectFilled(ImVec2(corner.x - 5.0f, corner.y - 3.0f),
                       ImVec2(corner.x + size.x + 5.0f, corner.y + size.y + 3.0f), kPaper, 4.0f);
    list.AddText(corner, kInk, label);
}

void text_row(const char* label, const char* text) {
    ImGui::TextColored(kLabelColor, "%s", label);
    ImGui::SameLine(kLabelColumn_px);
    ImGui::TextUnformatted(text);
}

// The graph's frame: from shares of the line and heights to the screen.
struct Graph {
    ImVec2 from, to;  // upper left, lower right
    double lowest_m = 0.0, highest_m = 1.0;

    float x(double share) const { return from.x + static_cast<float>(share) * (to.x - from.x); }
    float y(double height_m) const {
        const double share = (height_m - lowest_m) / (highest_m - lowest_m);
        return to.y - static_cast<float>(share) * (to.y - from.y);
    }
};

Graph graph_at(const ImVec2& corner, float width_px, const LineFigures& line) {
    Graph graph{ImVec2(corner.x + kLeftMargin_px, corner.y + 4.0f),
                ImVec2(corner.x + width_px - 4.0f, corner.y + kGraphHeight_px - kBottomMargin_px)};
    // Level ground is a line in the middle, not noise over the whole height.
    const double range_m = std::max(line.highest_m - line.lowest_m, 1.0);
    const double middle_m = 0.5 * (line.highest_m + line.lowest_m);
    graph.lowest_m = middle_m - 0.56 * range_m;
    graph.highest_m = middle_m + 0.56 * range_m;
    return graph;
}

void draw_grid(ImDrawList& list, const Graph& graph, const LineFigures& line) {
    Text text;
    const double up_m = round_step(graph.highest_m - graph.lowest_m, 5);
    for (double at_m = std::ceil(graph.lowest_m / up_m) * up_m; at_m < graph.highest_m; at_m += up_m) {
        list.AddLine(ImVec2(graph.from.x, graph.y(at_m)), ImVec2(graph.to.x, graph.y(at_m)), kGridLine);
        std::snprintf(text.letters.data(), text.letters.size(), "%.0f", at_m);
        const ImVec2 size = ImGui::CalcTextSize(text);
        list.AddText(ImVec2(graph.from.x - size.x - 5.0f, graph.y(at_m) - 0.5f * size.y), kFaintInk, text);
    }
    const bool in_km = line.level_m >= 1000.0;
    const double along_m = round_step(std::max(line.level_m, 1.0), 5);
    for (double at_m = 0.0; at_m <= line.level_m; at_m += along_m) {
        const float x = graph.x(at_m / std::max(line.level_m, 1e-9));
        list.AddLine(ImVec2(x, graph.from.y), ImVec2(x, graph.to.y), kGridLine);
        std::snprintf(text.letters.data(), text.letters.size(), in_km ? "%g km" : "%g m",
                      in_km ? at_m / 1000.0 : at_m);
        const float width = ImGui::CalcTextSize(text).x;
        if (x + 0.5f * width > graph.to.x + 4.0f) continue;
        list.AddText(ImVec2(x - (at_m > 0.0 ? 0.5f * width : 0.0f), graph.to.y + 2.0f), kFaintInk, text);
    }
}

// The ground as a body of light, its surface as a line. Gaps where there are no heights.
void draw_ground(ImDrawList& list, const Graph& graph, std::span<const float> profile) {
    const double last = static_cast<double>(profile.size() - 1);
    for (float x = graph.from.x; x < graph.to.x; x += 1.0f) {
        const double at = last * static_cast<double>((x - graph.from.x) / (graph.to.x - graph.from.x));
        const auto before = static_cast<std::size_t>(at);
        const float height = std::lerp(profile[before], profile[std::min(before + 1, profile.size() - 1)],
                                       static_cast<float>(at - std::floor(at)));
        if (std::isnan(height)) continue;
        list.AddRectFilledMultiColor(ImVec2(x, graph.y(static_cast<double>(height))),
                                     ImVec2(x + 1.0f, graph.to.y), kGroundTop, kGroundTop, kGroundBottom,
                                     kGroundBottom);
    }
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        if (std::isnan(profile[i]) || std::isnan(profile[i + 1])) continue;
        list.AddLine(
            ImVec2(graph.x(static_cast<double>(i) / last), graph.y(static_cast<double>(profile[i]))),
            ImVec2(graph.x(static_cast<double>(i + 1) / last), graph.y(static_cast<double>(profile[i + 1]))),
            kAccent, 1.5f);
    }
}

}  // namespace

double round_step(double range, int most) {
    const double least = range / most;
    const double power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double step : {1.0, 2.0, 5.0})
        if (step * power >= least) return step * power;
    return 10.0 * power;
}

void MeasurePanel::build(const MeasureScene& scene, const glm::vec2& right_bottom_px) {
    if (!scene.points_m[0]) return;
    draw_on_ground(scene);
    ImGui::SetNextWindowPos(ImVec2(right_bottom_px.x, right_bottom_px.y), ImGuiCond_Always,
                            ImVec2(1.0f, 1.0f));
    ImGui::SetNextWindowSize(ImVec2(kWidth_px, 0.0f));
    ImGui::Begin("measured", nullptr, kPanelFlags);
    build_points(scene);
    if (scene.points_m[1] && scene.profile.size() > 1) {
        const LineFigures line = line_figures(*scene.points_m[0], *scene.points_m[1], scene.profile);
        ImGui::Separator();
        build_line(line);
        build_graph(scene, line);
    } else {
        pointed_at_.reset();
        ImGui::TextColored(kLabelColor, "click again to measure from here; right click or Esc clears");
    }
    ImGui::End();
}

glm::dvec3 MeasurePanel::point_at(const MeasureScene& scene, std::size_t sample) {
    const double share = static_cast<double>(sample) / static_cast<double>(scene.profile.size() - 1);
    const glm::dvec2 place = glm::mix(glm::dvec2(*scene.points_m[0]), glm::dvec2(*scene.points_m[1]), share);
    return {place, static_cast<double>(scene.profile[sample])};
}

void MeasurePanel::draw_on_ground(const MeasureScene& scene) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    if (scene.points_m[1] && scene.profile.size() > 1) draw_drape(scene);
    for (std::size_t i = 0; i < scene.points_m.size(); ++i) {
        if (!scene.points_m[i]) continue;
        const auto place = picture_place(scene.camera, scene.scale, *scene.points_m[i]);
        if (!place) continue;
        Text label;
        std::snprintf(label.letters.data(), label.letters.size(), "%s  %.1f m", kNames[i],
                      scene.points_m[i]->z);
        draw_point(list, on_screen(*place), label);
    }
}

// The line as it runs over the ground, and dashed as the crow flies.
void MeasurePanel::draw_drape(const MeasureScene& scene) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const auto place_of = [&](const glm::dvec3& point) {
        return picture_place(scene.camera, scene.scale, point);
    };
    for (const bool outline : {true, false})
        for (std::size_t i = 0; i + 1 < scene.profile.size(); ++i) {
            if (std::isnan(scene.profile[i]) || std::isnan(scene.profile[i + 1])) continue;
            const auto from = place_of(point_at(scene, i)), to = place_of(point_at(scene, i + 1));
            if (from && to)
                list.AddLine(on_screen(*from), on_screen(*to), outline ? kOutline : kAccent,
                             outline ? 4.5f : 2.0f);
        }
    const auto first = place_of(*scene.points_m[0]), second = place_of(*scene.points_m[1]);
    if (first && second) draw_dashed(list, on_screen(*first), on_screen(*second), faded(kInk, 0.6f));
    if (!pointed_at_ || *pointed_at_ >= scene.profile.size()) return;
    if (const auto at = place_of(point_at(scene, *pointed_at_))) {
        list.AddCircleFilled(on_screen(*at), 6.0f, kOutline, 20);
        list.AddCircleFilled(on_screen(*at), 4.0f, kPoint, 16);
    }
}

void MeasurePanel::build_points(const MeasureScene& scene) const {
    for (std::size_t i = 0; i < scene.points_m.size(); ++i) {
        if (!scene.points_m[i]) continue;
        const glm::dvec3& point = *scene.points_m[i];
        ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kAccent), "%s", kNames[i]);
        ImGui::SameLine(24.0f);
        ImGui::Text("%.1f E  %.1f N  %.1f m", point.x, point.y, point.z);
        if (!scene.degrees[i]) continue;
        const glm::dvec2& degrees = *scene.degrees[i];
        ImGui::SameLine();
        ImGui::TextColored(kLabelColor, " %.5f%s %.5f%s", std::abs(degrees.y), degrees.y >= 0.0 ? "N" : "S",
                           std::abs(degrees.x), degrees.x >= 0.0 ? "E" : "W");
    }
}

void MeasurePanel::build_line(const LineFigures& line) const {
    Text text;
    const auto level = length_text(line.level_m), straight = length_text(line.straight_m);
    std::snprintf(text.letters.data(), text.letters.size(), "%s on the map, %s straight", level.data(),
                  straight.data());
    text_row("distance", text);
    std::snprintf(text.letters.data(), text.letters.size(), "%.1f\xc2\xb0 from grid north",
                  line.bearing.degrees());
    text_row("bearing", text);
    const double slope =
        line.level_m > 0.0 ? std::atan2(line.rise_m, line.level_m) * 180.0 / 3.14159265358979 : 0.0;
    std::snprintf(text.letters.data(), text.letters.size(), "%+.1f m (%+.1f\xc2\xb0), up %.0f m, down %.0f m",
                  line.rise_m, slope, line.ascent_m, line.descent_m);
    text_row("heights", text);
}

void MeasurePanel::build_graph(const MeasureScene& scene, const LineFigures& line) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width_px = ImGui::GetContentRegionAvail().x;
    ImGui::InvisibleButton("profile", ImVec2(width_px, kGraphHeight_px));
    const bool hovered = ImGui::IsItemHovered();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const Graph graph = graph_at(corner, width_px, line);
    draw_grid(list, graph, line);
    draw_ground(list, graph, scene.profile);
    draw_dashed(list, ImVec2(graph.x(0.0), graph.y(scene.points_m[0]->z)),
                ImVec2(graph.x(1.0), graph.y(scene.points_m[1]->z)), faded(kInk, 0.7f));
    pointed_at_.reset();
    if (!hovered) return;
    const float share =
        std::clamp((ImGui::GetIO().MousePos.x - graph.from.x) / (graph.to.x - graph.from.x), 0.0f, 1.0f);
    const auto sample =
        static_cast<std::size_t>(std::lround(share * static_cast<float>(scene.profile.size() - 1)));
    if (std::isnan(scene.profile[sample])) return;
    pointed_at_ = sample;
    const double at = static_cast<double>(sample) / static_cast<double>(scene.profile.size() - 1);
    const auto height_m = static_cast<double>(scene.profile[sample]);
    list.AddLine(ImVec2(graph.x(at), graph.from.y), ImVec2(graph.x(at), graph.to.y), faded(kInk, 0.5f));
    list.AddCircleFilled(ImVec2(graph.x(at), graph.y(height_m)), 3.5f, kPoint, 12);
    Text text;
    const auto along = length_text(at * line.level_m);
    std::snprintf(text.letters.data(), text.letters.size(), "%s  %.1f m", along.data(), height_m);
    const float text_px = ImGui::CalcTextSize(text).x;
    const float left = std::clamp(graph.x(at) + 6.0f, graph.from.x, graph.to.x - text_px);
    list.AddText(ImVec2(left, graph.from.y), kInk, text);
}

}  // namespace ridgeline::app
