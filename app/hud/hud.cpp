#include "ridgeline/app/hud/hud.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "ridgeline/app/hud/hud_style.h"
#include "ridgeline/base/units.h"

namespace ridgeline::app {
namespace {

constexpr float kCurveHeight_px = 34.0f;
constexpr float kLeastMap_px = 160.0f, kMostMap_px = 420.0f;
constexpr float kLeastStrip_px = 420.0f, kMostStrip_px = 1000.0f;
constexpr float kLeastStripHeight_px = 112.0f, kMostStripHeight_px = 190.0f;
// Behind curves and bars.
const ImVec4 kGroove = ImVec4(1.0f, 1.0f, 1.0f, 0.06f);
const ImVec4 kFrameCurve = ImVec4(1.00f, 0.77f, 0.36f, 1.0f);
const ImVec4 kCpuCurve = ImVec4(0.49f, 0.78f, 0.96f, 1.0f);
const ImVec4 kTriangleCurve = ImVec4(0.60f, 0.86f, 0.55f, 1.0f);
const ImVec4 kPagingCurve = ImVec4(0.93f, 0.58f, 0.55f, 1.0f);

float mebibytes(std::uint64_t bytes) { return static_cast<float>(static_cast<double>(bytes) / 0x1p20); }

struct CurveLook {
    const char* label;
    ImVec4 color;
    float least_top = 0.0f;  // the scale reaches at least this
};

// A curve with its label on the left and `text` on the right, over it.
void plot(const Curve& curve, const CurveLook& look, const char* text) {
    ImGui::TextColored(kLabelColor, "%s", look.label);
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(text).x);
    ImGui::TextUnformatted(text);
    const auto value = [](void* data, int index) {
        return static_cast<const Curve*>(data)->at(static_cast<std::size_t>(index));
    };
    ImGui::PushStyleColor(ImGuiCol_PlotLines, look.color);
    ImGui::PushStyleColor(ImGuiCol_FrameBg, kGroove);
    ImGui::PushID(look.label);
    ImGui::PlotLines("", value, const_cast<Curve*>(&curve), static_cast<int>(Curve::kLength), 0, nullptr,
                     0.0f, std::max(curve.largest() * 1.15f, look.least_top),
                     ImVec2(ImGui::GetContentRegionAvail().x, kCurveHeight_px));
    ImGui::PopID();
    ImGui::PopStyleColor(2);
}

void cache_bar(const char* label, std::uint64_t used, std::uint64_t capacity) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.0f of %.0f MiB", static_cast<double>(mebibytes(used)),
                  static_cast<double>(mebibytes(capacity)));
    ImGui::TextColored(kLabelColor, "%s", label);
    ImGui::SameLine(86.0f);
    const float share =
        capacity > 0 ? static_cast<float>(static_cast<double>(used) / static_cast<double>(capacity)) : 0.0f;
    ImGui::PushStyleColor(ImGuiCol_PlotHistogram, ImVec4(0.30f, 0.47f, 0.58f, 0.9f));
    ImGui::PushStyleColor(ImGuiCol_FrameBg, kGroove);
    ImGui::ProgressBar(share, ImVec2(-1.0f, ImGui::GetTextLineHeight() + 2.0f), text.data());
    ImGui::PopStyleColor(2);
}

void row(const char* label, const char* format, double value) {
    ImGui::TextColored(kLabelColor, "%s", label);
    ImGui::SameLine(86.0f);
    ImGui::Text(format, value);
}

// Tiles of a texture over the ground; nothing where none are wanted.
void tiles_row(const char* label, std::size_t wanted, std::size_t missing, std::uint64_t gpu_bytes) {
    if (wanted == 0) return;
    ImGui::TextColored(kLabelColor, "%s", label);
    ImGui::SameLine(86.0f);
    ImGui::Text("%zu of %zu missing, %.0f MiB", missing, wanted, static_cast<double>(mebibytes(gpu_bytes)));
}

// Degrees and decimal minutes are for ships; hikers' maps and phones speak decimal degrees.
void text_degrees(const glm::dvec2& longitude_latitude) {
    ImGui::SameLine();
    ImGui::TextColored(kLabelColor, "  %.5f%s %.5f%s", std::abs(longitude_latitude.y),
                       longitude_latitude.y >= 0.0 ? "N" : "S", std::abs(longitude_latitude.x),
                       longitude_latitude.x >= 0.0 ? "E" : "W");
}

// In [0, 360).
double whole_turn(Angle angle) {
    const double degrees = std::fmod(angle.degrees(), 360.0);
    return degrees < 0.0 ? degrees + 360.0 : degrees;
}

const char* course_text(const HudView& view) {
    if (view.course == Course::State::following) return "following a path";
    if (view.course == Course::State::paused) return "paused";
    return view.mode == platform::MotionMode::walk ? "walking" : "flying";
}

// Marks every 15 degrees, letters at the eight winds.
void draw_compass_mark(ImDrawList& list, const ImVec2& top, int degrees) {
    static constexpr const char* kWinds[8] = {"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
    const bool wind = degrees % 45 == 0;
    list.AddLine(top, ImVec2(top.x, top.y + (wind ? 9.0f : 5.0f)), wind ? kInk : kFaintInk, 1.0f);
    if (!wind) return;
    const char* name = kWinds[degrees / 45 % 8];
    const float width = ImGui::CalcTextSize(name).x;
    list.AddText(ImVec2(top.x - 0.5f * width, top.y + 10.0f), degrees == 0 ? kAccent : kInk, name);
}

}  // namespace

void Curve::add(float value) {
    values_[next_] = value;
    next_ = (next_ + 1) % kLength;
    count_ = std::min(count_ + 1, kLength);
}

float Curve::largest() const { return *std::ranges::max_element(values_); }

float Curve::mean() const {
    float sum = 0.0f;
    for (const float value : values_) sum += value;
    return count_ > 0 ? sum / static_cast<float>(count_) : 0.0f;
}

void Hud::add(const HudFigures& figures) {
    newest_ = figures;
    frame_ms_.add(static_cast<float>(figures.frame_ms));
    render_ms_.add(static_cast<float>(figures.render_cpu_ms));
    triangles_.add(static_cast<float>(static_cast<double>(figures.triangles) * 1e-6));
    missing_.add(static_cast<float>(figures.tiles_missing));
    read_bytes_.add(mebibytes(figures.bytes_read));
}

std::optional<glm::dvec2> Hud::build(const HudView& view, WalkSettings& settings) {
    if (settings.hud == Panel::shown) {
        build_figures(view);
        build_position(view);
        build_compass(view);
        if (view.horizon) build_horizon({*view.horizon, view.levels, settings.map_range});
    }
    if (view.measured) build_measured(view);
    if (settings.help == Panel::shown) build_help();
    go_to_opened_ = settings.go_to == Panel::shown && go_to_opened_;
    return settings.go_to == Panel::shown ? build_go_to(view, settings) : std::nullopt;
}

void Hud::build_figures(const HudView& view) {
    ImGui::SetNextWindowPos(ImVec2(kMargin_px, kMargin_px));
    ImGui::SetNextWindowSize(ImVec2(kPanelWidth_px, 0.0f));
    ImGui::Begin("figures", nullptr, kFiguresFlags);
    ImGui::TextUnformatted(view.dataset);
    ImGui::Separator();
    std::array<char, 80> text{};
    const float mean_ms = std::max(frame_ms_.mean(), 1e-3f);
    std::snprintf(text.data(), text.size(), "%.1f ms  %.0f/s", newest_.frame_ms,
                  static_cast<double>(1000.0f / mean_ms));
    plot(frame_ms_, {"frame", kFrameCurve, 8.0f}, text.data());
    std::snprintf(text.data(), text.size(), "%.2f ms, selection %.2f", newest_.render_cpu_ms,
                  newest_.selection_ms);
    plot(render_ms_, {"render CPU", kCpuCurve, 4.0f}, text.data());
    std::snprintf(text.data(), text.size(), "%.2f M in %u draws", static_cast<double>(triangles_.newest()),
                  newest_.draws);
    plot(triangles_, {"triangles", kTriangleCurve, 0.1f}, text.data());
    std::snprintf(text.data(), text.size(), "%u of %u", newest_.tiles_missing, newest_.tiles_wanted);
    plot(missing_, {"missing tiles", kPagingCurve, 8.0f}, text.data());
    std::snprintf(text.data(), text.size(), "%.2f MiB", static_cast<double>(read_bytes_.newest()));
    plot(read_bytes_, {"read", kPagingCurve, 0.25f}, text.data());
    cache_bar("RAM ring", newest_.ram_bytes, newest_.ram_capacity_bytes);
    cache_bar("GPU slots", newest_.gpu_bytes, newest_.gpu_capacity_bytes);
    tiles_row("heights", newest_.heights_wanted, newest_.heights_missing, newest_.heights_bytes);
    tiles_row("imagery", newest_.imagery_wanted, newest_.imagery_missing, newest_.imagery_bytes);
    ImGui::TextColored(kLabelColor, "CPU");
    ImGui::SameLine(86.0f);
    ImGui::Text("%.0f %%, render %.0f, jobs %.0f", view.cpu.process, view.cpu.render, view.cpu.workers);
    row("GPU", "%.1f ms", newest_.gpu_ms);
    build_sun(view);
    if (newest_.eye_lift_m > 0.0) row("eye lifted", "%.1f m", newest_.eye_lift_m);
    ImGui::End();
}

// Where the sun stands and, with shadows, what they cost.
void Hud::build_sun(const HudView& view) const {
    ImGui::TextColored(kLabelColor, "sun");
    ImGui::SameLine(86.0f);
    ImGui::Text("%.0f\xc2\xb0  %+.1f\xc2\xb0", whole_turn(view.daylight.sun_azimuth),
                view.daylight.sun_elevation.degrees());
    if (view.shadows == select::CasterSet::none) return;
    ImGui::TextColored(kLabelColor, "shadows");
    ImGui::SameLine(86.0f);
    // No wider than the panel.
    ImGui::Text("%s %u, %.2f M, %.0f MiB", view.shadows == select::CasterSet::pvs ? "pvs" : "all",
                newest_.casters, static_cast<double>(newest_.shadow_triangles) * 1e-6,
                static_cast<double>(mebibytes(newest_.shadow_map_bytes)));
}

void Hud::build_position(const HudView& view) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(kMargin_px, size.y - kMargin_px), ImGuiCond_Always, ImVec2(0.0f, 1.0f));
    ImGui::Begin("position", nullptr, kFiguresFlags);
    ImGui::Text("%.1f E  %.1f N  %.1f m", view.pose.eye_m.x, view.pose.eye_m.y, view.pose.eye_m.z);
    if (view.degrees) text_degrees(*view.degrees);
    ImGui::TextColored(kLabelColor, "%s", course_text(view));
    ImGui::SameLine();
    ImGui::Text("%.0f m/s", view.speed_m_per_s);
    if (view.above_ground_m) {
        ImGui::SameLine();
        ImGui::Text(" %.1f m over ground", *view.above_ground_m);
    }
    if (view.exaggeration != 1.0) {
        ImGui::SameLine();
        ImGui::TextColored(kFrameCurve, " heights x %.2f", view.exaggeration);
    }
    if (view.recording) {
        ImGui::SameLine();
        ImGui::TextColored(kPagingCurve, " recording");
    }
    if (view.message[0] != '\0') ImGui::TextColored(kFrameCurve, "%s", view.message);
    position_px_ = glm::max(position_px_, {ImGui::GetWindowWidth(), ImGui::GetWindowHeight()});
    ImGui::End();
}

void Hud::build_compass(const HudView& view) {
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    const float width =
        std::min(360.0f, ImGui::GetIO().DisplaySize.x - 2.0f * (kPanelWidth_px + 2.0f * kMargin_px));
    if (width < 120.0f) return;
    constexpr double kSpan = 120.0;  // degrees across
    const ImVec2 top(0.5f * ImGui::GetIO().DisplaySize.x, kMargin_px);
    list.AddRectFilled(ImVec2(top.x - 0.5f * width, top.y), ImVec2(top.x + 0.5f * width, top.y + 42.0f),
                       kPaper, 6.0f);
    const double heading = whole_turn(view.pose.heading);
    for (int mark = 0; mark < 360; mark += 15) {
        const double away = std::remainder(mark - heading, 360.0);
        if (std::abs(away) > 0.46 * kSpan) continue;
        draw_compass_mark(list, ImVec2(top.x + static_cast<float>(away / kSpan) * width, top.y + 4.0f), mark);
    }
    list.AddTriangleFilled(ImVec2(top.x - 4.0f, top.y - 1.0f), ImVec2(top.x + 4.0f, top.y - 1.0f),
                           ImVec2(top.x, top.y + 5.0f), kAccent);
    std::array<char, 48> text{};
    std::snprintf(text.data(), text.size(), "%.0f\xc2\xb0  %+.0f\xc2\xb0", heading,
                  view.pose.pitch.degrees());
    list.AddText(ImVec2(top.x - 0.5f * ImGui::CalcTextSize(text.data()).x, top.y + 27.0f), kInk, text.data());
}

// The map stands in the right upper corner, the strip in the right lower one: beside the position's panel, or
// where that leaves too little, over it and beside the figures.
void Hud::build_horizon(const MapContent& content) {
    const ImGuiIO& io = ImGui::GetIO();
    const ImVec2 size = io.DisplaySize;
    const float right = size.x - kMargin_px;
    const float beside_position_px = right - position_px_.x - 2.0f * kMargin_px;
    const bool beside = beside_position_px >= kLeastStrip_px;
    const float room_px = beside ? beside_position_px : right - kPanelWidth_px - 2.0f * kMargin_px;
    const float bottom = size.y - kMargin_px - (beside ? 0.0f : position_px_.y + kMargin_px);
    const float height_px = std::clamp(0.18f * size.y, kLeastStripHeight_px, kMostStripHeight_px);
    strip_.build(content.scene, {right, bottom}, {std::min(room_px, kMostStrip_px), height_px}, io.DeltaTime);
    const float map_px = std::floor(std::clamp(0.36f * std::min(size.x, size.y), kLeastMap_px, kMostMap_px));
    const float above_strip_px = bottom - height_px - 2.0f * kMargin_px;
    map_.build(content, {{right, kMargin_px}, map_px, above_strip_px}, io.DeltaTime);
    beside_horizon_px_ = {right - map_px - 3.0f * kMargin_px, bottom - height_px - kMargin_px};
}

// In the right lower corner, or beside the map and over the strip.
void Hud::build_measured(const HudView& view) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const glm::vec2 corner_px(size.x - kMargin_px, size.y - kMargin_px);
    measure_.build(*view.measured, view.horizon ? beside_horizon_px_ : corner_px);
}

void Hud::build_help() {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0.5f * size.x, 0.5f * size.y), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::Begin("keys", nullptr, kPanelFlags);
    for (const KeyHelp& key : key_help()) {
        ImGui::TextColored(kFrameCurve, "%s", key.keys);
        ImGui::SameLine(140.0f);
        ImGui::TextUnformatted(key.what);
    }
    ImGui::End();
}

std::optional<glm::dvec2> Hud::build_go_to(const HudView& view, WalkSettings& settings) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0.5f * size.x, 0.4f * size.y), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::Begin("go to", nullptr, kPanelFlags & ~ImGuiWindowFlags_NoNav);
    ImGui::TextColored(kLabelColor, "Go to (in the data's own coordinates)");
    if (!go_to_opened_) {
        go_to_ = {view.pose.eye_m.x, view.pose.eye_m.y};
        ImGui::SetKeyboardFocusHere();
        go_to_opened_ = true;
    }
    ImGui::InputDouble("east", &go_to_[0], 0.0, 0.0, "%.1f");
    ImGui::InputDouble("north", &go_to_[1], 0.0, 0.0, "%.1f");
    const bool entered = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false);
    const bool go = ImGui::Button("Go") || entered;
    ImGui::SameLine();
    if (ImGui::Button("Close")) settings.go_to = Panel::hidden;
    ImGui::End();
    if (!go) return std::nullopt;
    settings.go_to = Panel::hidden;
    return glm::dvec2(go_to_[0], go_to_[1]);
}

}  // namespace ridgeline::app
