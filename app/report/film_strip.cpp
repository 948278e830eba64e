#include "ridgeline/app/report/film_strip.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ridgeline/app/report/html_text.h"

namespace ridgeline::app::report {
namespace {

// A picture is no wider than this share of the row, however few they are, and less where rows stand below one
// another; between two there is a little room.
constexpr double kMostWidth = 0.2;
constexpr double kMostWidthOfSeveral = 0.125;
constexpr double kGap = 0.006;
// The lines' picture, in units that are stretched to the row.
constexpr int kLinesWide = 1000;
constexpr int kLinesHigh = 16;

struct Shot {
    const Thumbnail* picture;
    double at;     // on the walk's axis
    double share;  // of the row
};

// Those whose frame is in the table: what else lies in the folder is of another walk.
std::vector<Shot> shots_of(const RunFolder& run, const WalkAxis& walk) {
    const std::vector<double> places = places_on(walk, run.frames);
    std::vector<Shot> shots;
    for (const Thumbnail& picture : run.thumbnails.pictures) {
        if (picture.frame >= static_cast<std::int64_t>(places.size())) continue;
        const double at = places[static_cast<std::size_t>(picture.frame)];
        if (!std::isnan(at)) shots.push_back({&picture, at, walk.axis.share(at)});
    }
    std::stable_sort(shots.begin(), shots.end(),
                     [](const Shot& a, const Shot& b) { return a.share < b.share; });
    return shots;
}

std::string picture_html(const Shot& shot, double left, double width, const WalkAxis& walk) {
    const Thumbnail& picture = *shot.picture;
    const std::string when = quantity(shot.at, walk.unit);
    return "<figure style=\"left:" + percent_of(left) + ";width:" + percent_of(width) + "\" data-at=\"" +
           percent_of(shot.share) + "\"><img alt=\"The walk at " + when + ", frame " +
           std::to_string(picture.frame) + "\" width=\"" + std::to_string(picture.width_px) + "\" height=\"" +
           std::to_string(picture.height_px) + "\" src=\"data:image/jpeg;base64," + picture.jpeg_base64 +
           "\"/><figcaption>" + when + "</figcaption></figure>";
}

struct Row {
    std::size_t run;
    std::vector<Shot> shots;
    double room;  // of one picture
    std::vector<double> lefts;
};

Row row_of(std::size_t run, std::vector<Shot> shots, double most_width) {
    const double room = std::min(1.0 / static_cast<double>(shots.size()), most_width);
    std::vector<double> moments;
    for (const Shot& shot : shots) moments.push_back(shot.share);
    return {run, std::move(shots), room, places_in_row(moments, room)};
}

std::string shots_html(const Row& row, const WalkAxis& walk) {
    const Thumbnail& first = *row.shots.front().picture;
    std::string html = "<div class=\"shots\" style=\"--room:" + percent_of(row.room - kGap) +
                       ";--shape:" + std::to_string(first.width_px) + "/" + std::to_string(first.height_px) +
                       "\">";
    for (std::size_t i = 0; i < row.shots.size(); ++i)
        html += picture_html(row.shots[i], row.lefts[i] + 0.5 * kGap, row.room - kGap, walk);
    return html + "</div>";
}

std::string lines_svg(const Row& row) {
    std::string path;
    for (std::size_t i = 0; i < row.shots.size(); ++i) {
        const auto across = [](double share) { return std::to_string(std::lround(share * kLinesWide)); };
        path += "M" + across(row.lefts[i] + 0.5 * row.room) + " 0L" + across(row.shots[i].share) + " " +
                std::to_string(kLinesHigh);
    }
    return "<svg viewBox=\"0 0 " + std::to_string(kLinesWide) + " " + std::to_string(kLinesHigh) +
           "\" preserveAspectRatio=\"none\" aria-hidden=\"true\"><path d=\"" + path + "\"/></svg>";
}

}  // namespace

std::vector<double> places_in_row(std::span<const double> moments, double width) {
    std::vector<double> lefts;
    for (const double moment : moments) {
        const double free = lefts.empty() ? 0.0 : lefts.back() + width;
        lefts.push_back(std::max(moment - 0.5 * width, free));
    }
    // What was pushed out at the end pushes back.
    double most = 1.0 - width;
    for (auto left = lefts.rbegin(); left != lefts.rend(); ++left, most -= width)
        *left = std::min(*left, most);
    return lefts;
}

std::string film_strips(std::span<const RunFolder> runs, const WalkAxis& walk) {
    const double most_width = runs.size() > 1 ? kMostWidthOfSeveral : kMostWidth;
    std::vector<Row> rows;
    for (std::size_t run = 0; run < runs.size(); ++run)
        if (auto shots = shots_of(runs[run], walk); !shots.empty())
            rows.push_back(row_of(run, std::move(shots), most_width));
    std::string html;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        html += "<div class=\"strip run " + colour_class(rows[i].run) + "\">" + shots_html(rows[i], walk);
        if (i + 1 == rows.size()) html += lines_svg(rows[i]);
        if (runs.size() > 1) html += "<b class=\"badge\">" + letter(rows[i].run) + "</b>";
        html += "</div>\n";
    }
    return html;
}

}  // namespace ridgeline::app::report
