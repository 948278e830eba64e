#include "ridgeline/app/report/curve_path.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace ridgeline::app::report {
namespace {

// Values off the axis keep their place above or below the picture, up to a million times its height.
std::int64_t height_of(double value, const Axis& y) {
    constexpr double kFarthest = 1e6 * kHeight;
    return std::llround(std::clamp((1.0 - y.share(value)) * kHeight, -kFarthest, kFarthest));
}

class PathText {
  public:
    void to(int x, std::int64_t y) {
        const int dx = text_.empty() ? x : x - x_;
        const std::int64_t dy = text_.empty() ? y : y - y_;
        if (text_.empty()) text_ = "M";
        // The second point opens the steps; a sign is as good a separator as a space.
        else if (points_ == 1)
            text_ += 'l';
        else if (dx >= 0)
            text_ += ' ';
        text_ += std::to_string(dx) + (dy < 0 ? "" : " ") + std::to_string(dy);
        x_ = x;
        y_ = y;
        ++points_;
    }
    std::string take() { return std::move(text_); }

  private:
    std::string text_;
    int x_ = 0, points_ = 0;
    std::int64_t y_ = 0;
};

}  // namespace

std::string line_path(std::span<const Column> columns, const Axis& y) {
    PathText path;
    for (const Column& column : columns) path.to(column.index, height_of(column.median, y));
    // A single frame is a dash: a path of one point draws nothing.
    if (columns.size() == 1) path.to(columns[0].index + 1, height_of(columns[0].median, y));
    return path.take();
}

std::string band_path(std::span<const Column> columns, const Axis& y) {
    if (std::none_of(columns.begin(), columns.end(), [](const Column& column) { return column.values > 1; }))
        return {};
    PathText path;
    for (const Column& column : columns) path.to(column.index, height_of(column.most, y));
    for (auto column = columns.rbegin(); column != columns.rend(); ++column)
        path.to(column->index, height_of(column->least, y));
    return path.take() + 'z';
}

}  // namespace ridgeline::app::report
