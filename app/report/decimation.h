// A long series as few columns: what a chart can show of it, and nothing of what it must show lost.
//
// Of every column of the picture the least and the greatest value are kept, so that the one slow frame among
// a hundred thousand is as high as if each had been drawn, and the median, which says what was usual there.
// Pure, any thread.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace ridgeline::app::report {

struct Column {
    int index = 0;
    std::size_t values = 0;
    double least = 0.0;
    double median = 0.0;  // the lower of two
    double most = 0.0;
    friend bool operator==(const Column&, const Column&) = default;
};

// From `first` to `last` on the axis, first < last, in `columns` equal parts; `last` itself is in the last of
// them.
struct ColumnGrid {
    double first = 0.0;
    double last = 1.0;
    int columns = 1;

    // Held to the grid.
    int column_of(double x) const;
};

// Columns that hold values, in order. x and y are of one length; pairs in which either is NaN are no values.
std::vector<Column> decimated(std::span<const double> x, std::span<const double> y, const ColumnGrid& grid);

}  // namespace ridgeline::app::report
