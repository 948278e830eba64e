#include "ridgeline/app/report/curve_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "ridgeline/app/report/curve_path.h"
#include "ridgeline/app/report/html_text.h"

namespace ridgeline::app::report {
namespace {

// As close as letters of the margin may stand, one above the other.
constexpr double kLetter_px = 14.0;
// Columns between two marks of values above the scale.
constexpr int kMarkGap = 12;

std::string plain(double number) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.9g", number);
    return text.data();
}

std::string curve_svg(const Curve& curve, const Axis& y) {
    std::string svg =
        "<g class=\"run " + colour_class(curve.run) + "\" data-run=\"" + letter(curve.run) + "\">";
    if (const std::string band = band_path(curve.columns, y); !band.empty())
        svg += "<path class=\"band\" d=\"" + band + "\"/>";
    return svg + "<path class=\"line\" d=\"" + line_path(curve.columns, y) + "\"/></g>";
}

std::string level_svg(const Level& level, const Axis& y, int columns) {
    const int height = static_cast<int>(std::lround((1.0 - y.share(level.value)) * kHeight));
    return "<path class=\"level " + level.style + "\" d=\"M0 " + std::to_string(height) + "h" +
           std::to_string(columns) + "\"/>";
}

std::string level_label(const Level& level, const Axis& y) {
    if (level.label.empty()) return {};
    return "<span class=\"level-label " + level.style +
           "\" style=\"bottom:" + percent_of(y.share(level.value)) + "\">" + level.label + "</span>";
}

// A mark at the upper edge over each value that is off the scale; those side by side share one.
std::string marks_above(const Curve& curve, const Axis& y, int columns) {
    std::string html;
    int last = -kMarkGap;
    for (const Column& column : curve.columns) {
        if (column.most <= y.last || column.index - last < kMarkGap) continue;
        last = column.index;
        html += "<i class=\"above " + colour_class(curve.run) +
                "\" style=\"left:" + percent_of((column.index + 0.5) / columns) + "\"></i>";
    }
    return html;
}

struct PlacedLetter {
    std::size_t run;
    double share;  // from the foot
};

// Letters where the curves end, moved apart where they would cover one another.
std::vector<PlacedLetter> placed_letters(const CurveChart& chart) {
    std::vector<PlacedLetter> letters;
    for (const Curve& curve : chart.curves)
        if (!curve.columns.empty())
            letters.push_back({curve.run, std::clamp(chart.y.share(curve.columns.back().median), 0.0, 1.0)});
    std::stable_sort(letters.begin(), letters.end(),
                     [](const auto& a, const auto& b) { return a.share < b.share; });
    const double gap = kLetter_px / chart.height_px;
    for (std::size_t i = 1; i < letters.size(); ++i)
        letters[i].share = std::max(letters[i].share, letters[i - 1].share + gap);
    // What was pushed out at the top pushes back.
    double most = 1.0;
    for (auto placed = letters.rbegin(); placed != letters.rend(); ++placed, most -= gap)
        placed->share = std::min(placed->share, most);
    return letters;
}

std::string letters_html(const CurveChart& chart) {
    if (chart.curves.size() < 2) return {};
    std::string html;
    for (const PlacedLetter& placed : placed_letters(chart))
        html += "<b class=\"end run " + colour_class(placed.run) +
                "\" style=\"bottom:" + percent_of(placed.share) + "\">" + letter(placed.run) + "</b>";
    return html;
}

std::string picture(const CurveChart& chart, const WalkAxis& walk) {
    std::string svg = "<svg viewBox=\"0 0 " + std::to_string(walk.columns) + " " + std::to_string(kHeight) +
                      "\" preserveAspectRatio=\"none\" aria-hidden=\"true\">";
    svg += grid_lines(walk.axis, chart.y, walk.columns);
    // The first run lies on top: the others are compared with it.
    for (auto curve = chart.curves.rbegin(); curve != chart.curves.rend(); ++curve)
        svg += curve_svg(*curve, chart.y);
    for (const Level& level : chart.levels) svg += level_svg(level, chart.y, walk.columns);
    return svg + "</svg>";
}

std::string words(const CurveChart& chart, const WalkAxis& walk) {
    std::string html = ticks_at_left(chart.y, chart.unit) + ticks_at_foot(walk.axis, walk.unit);
    for (const Curve& curve : chart.curves) html += marks_above(curve, chart.y, walk.columns);
    for (const Level& level : chart.levels) html += level_label(level, chart.y);
    return html + (chart.beside.empty() ? letters_html(chart) : chart.beside);
}

}  // namespace

std::string letter(std::size_t run) { return std::string(1, static_cast<char>('A' + run)); }

std::string colour_class(std::size_t run) { return "r" + std::to_string(run); }

std::string percent_of(double share) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.2f%%", 100.0 * std::clamp(share, -10.0, 10.0));
    return text.data();
}

std::string ticks_at_left(const Axis& y, Unit unit) {
    std::string html;
    for (const double tick : y.ticks)
        html += "<span class=\"ty\" style=\"bottom:" + percent_of(y.share(tick)) + "\">" +
                tick_text(tick, unit) + "</span>";
    return html;
}

std::string ticks_at_foot(const Axis& x, Unit unit) {
    std::string html;
    for (std::size_t i = 0; i < x.ticks.size(); ++i) {
        // Where the page is narrow, every other one is left out; the last, which names the unit, stays.
        const std::size_t left = x.ticks.size() - 1 - i;
        html += "<span class=\"tx" + std::string(left % 2 == 1 ? " odd" : "") +
                "\" style=\"left:" + percent_of(x.share(x.ticks[i])) + "\">" + tick_text(x.ticks[i], unit) +
                (left == 0 && !unit_name(unit).empty() ? "\xE2\x80\xAF" + unit_name(unit) : "") + "</span>";
    }
    return html;
}

std::string grid_lines(const Axis& x, const Axis& y, int columns) {
    std::string path;
    for (const double tick : y.ticks)
        path += "M0 " + std::to_string(std::lround((1.0 - y.share(tick)) * kHeight)) + "h" +
                std::to_string(columns);
    std::string foot;
    for (const double tick : x.ticks)
        foot += "M" + std::to_string(std::lround(x.share(tick) * columns)) + " 0v" + std::to_string(kHeight);
    return "<path class=\"grid\" d=\"" + path + "\"/><path class=\"grid faint\" d=\"" + foot + "\"/>";
}

std::string html(const CurveChart& chart, const WalkAxis& walk) {
    const std::string unit = unit_name(chart.unit);
    std::string page = "<figure class=\"chart " + chart.style + "\"><figcaption><h3>" + escaped(chart.title);
    if (!unit.empty()) page += " <span class=\"unit\">" + unit + "</span>";
    page += "</h3><output class=\"readout\" aria-hidden=\"true\"></output><p>" + chart.note +
            "</p></figcaption>" + chart.above;
    page += "<div class=\"plot curve\" role=\"img\" aria-label=\"" + escaped(chart.description) +
            "\" style=\"--h:" + std::to_string(chart.height_px) + "px\" data-unit=\"" +
            (chart.unit == Unit::bytes ? "B" : unit) + "\" data-y0=\"" + plain(chart.y.first) +
            "\" data-y1=\"" + plain(chart.y.last) + "\"><div class=\"area\">";
    return page + picture(chart, walk) + words(chart, walk) + "</div></div></figure>\n";
}

}  // namespace ridgeline::app::report
