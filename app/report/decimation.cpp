// Column-wise extremes are those of M4 (Jugel et al., "M4: a visualization-oriented time series data
// aggregation", VLDB 2014). We keep the median in place of the first and the last value of a column: a band
// and a line within it read better than the solid block that the joined extremes of many noisy frames are.
#include "ridgeline/app/report/decimation.h"

#include <algorithm>
#include <cmath>

#include "ridgeline/base/contract.h"

namespace ridgeline::app::report {
namespace {

struct Placed {
    int column;
    double value;
};

std::vector<Placed> placed(std::span<const double> x, std::span<const double> y, const ColumnGrid& grid) {
    std::vector<Placed> values;
    values.reserve(x.size());
    for (std::size_t i = 0; i < x.size(); ++i)
        if (!std::isnan(x[i]) && !std::isnan(y[i])) values.push_back({grid.column_of(x[i]), y[i]});
    return values;
}

}  // namespace

int ColumnGrid::column_of(double x) const {
    const double column = std::floor((x - first) / (last - first) * columns);
    return static_cast<int>(std::clamp(column, 0.0, columns - 1.0));
}

std::vector<Column> decimated(std::span<const double> x, std::span<const double> y, const ColumnGrid& grid) {
    RIDGELINE_CHECK(x.size() == y.size() && grid.first < grid.last && grid.columns > 0);
    std::vector<Placed> values = placed(x, y, grid);
    std::sort(values.begin(), values.end(), [](const Placed& a, const Placed& b) {
        return a.column != b.column ? a.column < b.column : a.value < b.value;
    });
    std::vector<Column> columns;
    for (std::size_t begin = 0, end = 0; begin < values.size(); begin = end) {
        while (end < values.size() && values[end].column == values[begin].column) ++end;
        columns.push_back({.index = values[begin].column,
                           .values = end - begin,
                           .least = values[begin].value,
                           .median = values[begin + (end - begin - 1) / 2].value,
                           .most = values[end - 1].value});
    }
    return columns;
}

}  // namespace ridgeline::app::report
