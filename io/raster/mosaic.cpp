#include "mosaic.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dem_source.h"

namespace ridgeline::raster {
namespace {

bool is_height(double height_m) { return !std::isnan(height_m); }
bool is_height(std::int32_t step) { return step != kNoStep; }

// Steps are comparable only where they count the same thing.
HeightFormat common_format(const std::vector<Mosaic::Part>& parts) {
    HeightFormat common = parts.front().grid->format();
    for (const auto& part : parts) {
        const HeightFormat format = part.grid->format();
        common.integer &=
            format.integer && format.step_m == common.step_m && format.offset_m == common.offset_m;
    }
    common.may_have_nodata = true;  // parts need not cover the whole extent
    return common;
}

Window overlap(const Window& a, const Window& b) {
    Window both;
    both.column = std::max(a.column, b.column);
    both.row = std::max(a.row, b.row);
    both.columns =
        std::max<std::int64_t>(0, std::min(a.column + a.columns, b.column + b.columns) - both.column);
    both.rows = std::max<std::int64_t>(0, std::min(a.row + a.rows, b.row + b.rows) - both.row);
    return both;
}

template <class T, class Read>
Result<void> paint(const Mosaic::Part& part, const Window& window, std::span<T> target,
                   std::vector<T>& scratch, Read&& read) {
    Window shared = overlap(window, {part.column, part.row, part.grid->width(), part.grid->height()});
    if (shared.samples() == 0) return {};
    scratch.resize(static_cast<std::size_t>(shared.samples()));
    const Window in_part{shared.column - part.column, shared.row - part.row, shared.columns, shared.rows};
    RIDGELINE_TRY(read(*part.grid, in_part, std::span<T>(scratch)));
    for (std::int64_t row = 0; row < shared.rows; ++row) {
        const auto from = scratch.begin() + row * shared.columns;
        const auto to =
            target.begin() + (shared.row + row - window.row) * window.columns + shared.column - window.column;
        for (std::int64_t column = 0; column < shared.columns; ++column)
            if (is_height(from[column])) to[column] = from[column];
    }
    return {};
}

}  // namespace

Mosaic::Mosaic(std::vector<Part> parts) : parts_(std::move(parts)), format_(common_format(parts_)) {
    for (const Part& part : parts_) {
        RIDGELINE_CHECK(part.column >= 0 && part.row >= 0);
        width_ = std::max(width_, part.column + part.grid->width());
        height_ = std::max(height_, part.row + part.grid->height());
        natural_rows_ = std::max(natural_rows_, part.grid->natural_rows());
    }
}

Result<void> Mosaic::read_heights(const Window& window, std::span<double> heights_m) {
    std::fill(heights_m.begin(), heights_m.end(), std::numeric_limits<double>::quiet_NaN());
    for (const Part& part : parts_)
        RIDGELINE_TRY(paint(part, window, heights_m, part_heights_,
                            [](HeightGrid& grid, const Window& inner, std::span<double> into) {
                                return grid.read_heights(inner, into);
                            }));
    return {};
}

Result<void> Mosaic::read_steps(const Window& window, std::span<std::int32_t> steps) {
    RIDGELINE_CHECK(format_.integer);
    std::fill(steps.begin(), steps.end(), kNoStep);
    for (const Part& part : parts_)
        RIDGELINE_TRY(paint(part, window, steps, part_steps_,
                            [](HeightGrid& grid, const Window& inner, std::span<std::int32_t> into) {
                                return grid.read_steps(inner, into);
                            }));
    return {};
}

}  // namespace ridgeline::raster
