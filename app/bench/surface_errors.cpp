#include "ridgeline/app/bench/surface_errors.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace ridgeline::app {
namespace {

// Of the cell with its north-western corner here, from the means of its sides; not a number where a corner
// is none.
glm::dvec3 cell_normal(const io::TerrainInfo& info, const SurfaceField& field, std::int64_t column,
                       std::int64_t row) {
    const double nw = field.at(column, row), ne = field.at(column + 1, row);
    const double sw = field.at(column, row + 1), se = field.at(column + 1, row + 1);
    const double east = 0.5 * (ne - nw + se - sw) / info.spacing_x_m;
    const double south = 0.5 * (sw - nw + se - ne) / info.spacing_y_m;
    return glm::normalize(glm::dvec3(-east, south, 1.0));
}

// Half the angle's sine is exact where the angle is small.
double angle_degrees(const glm::dvec3& a, const glm::dvec3& b) {
    return 2.0 * std::asin(std::min(0.5 * glm::length(a - b), 1.0)) * 180.0 / std::numbers::pi;
}

// Visits the places of a skyline's column from near to far: metres away, column and row of the lattice.
template <class Visit>
void along_column(const io::TerrainInfo& info, const Eye& eye, const SkylineOptions& options, int i,
                  Visit&& visit) {
    const double step_m = std::min(info.spacing_x_m, info.spacing_y_m);
    const auto last_column = static_cast<double>(info.width - 1),
               last_row = static_cast<double>(info.height - 1);
    const double azimuth = 2.0 * std::numbers::pi * (i + 0.5) / options.columns;
    const double columns_a_m = std::sin(azimuth) / info.spacing_x_m;
    const double rows_a_m = -std::cos(azimuth) / info.spacing_y_m;
    for (double away_m = std::max(options.from_m, step_m);; away_m += step_m) {
        const double column = eye.column + away_m * columns_a_m, row = eye.row + away_m * rows_a_m;
        if (!(column >= 0.0 && row >= 0.0 && column < last_column && row < last_row)) return;
        visit(away_m, column, row);
    }
}

struct Mean {
    double sum = 0.0;
    std::int64_t count = 0;

    void add(double value) {
        if (std::isnan(value)) return;
        sum += value;
        ++count;
    }
    double value() const { return count > 0 ? sum / static_cast<double>(count) : 0.0; }
};

}  // namespace

GroundErrors ground_errors(const io::TerrainInfo& info, const SurfaceField& source,
                           const SurfaceField& surface) {
    GroundErrors errors;
    Mean heights, normals;
    for (std::int64_t row = 0; row < info.height; ++row)
        for (std::int64_t column = 0; column < info.width; ++column) {
            const double apart = std::abs(double{surface.at(column, row)} - double{source.at(column, row)});
            heights.add(apart);
            if (apart > errors.worst_m) errors.worst_m = apart;
            if (column + 1 < info.width && row + 1 < info.height)
                normals.add(angle_degrees(cell_normal(info, source, column, row),
                                          cell_normal(info, surface, column, row)));
        }
    errors.mean_m = heights.value();
    errors.normal_degrees = normals.value();
    return errors;
}

std::vector<Eye> random_eyes(const io::TerrainInfo& info, const SurfaceField& source, int count,
                             std::uint32_t seed) {
    constexpr double kAbove_m[] = {2.0, 30.0, 200.0};
    // Among this many places one has a height, or there is hardly ground to look at.
    constexpr int kTries = 1000;
    std::mt19937 random(seed);
    const auto along = [&random](std::int64_t samples) {
        return (0.1 + 0.8 * (random() / 4294967296.0)) * static_cast<double>(samples - 1);
    };
    std::vector<Eye> eyes;
    for (int i = 0; i < count; ++i)
        for (int tries = 0; tries < kTries; ++tries) {
            const double column = along(info.width), row = along(info.height);
            const double ground_m = source.at_place(column, row);
            if (std::isnan(ground_m)) continue;
            eyes.push_back({column, row, ground_m + kAbove_m[i % 3]});
            break;
        }
    return eyes;
}

std::vector<SkylinePoint> skyline(const io::TerrainInfo& info, const SurfaceField& field, const Eye& eye,
                                  const SkylineOptions& options) {
    std::vector<SkylinePoint> points(static_cast<std::size_t>(options.columns));
    for (int i = 0; i < options.columns; ++i)
        along_column(info, eye, options, i, [&](double away_m, double column, double row) {
            const double height_m = field.at_place(column, row);
            const double slope = (height_m - eye.height_m) / away_m;
            SkylinePoint& point = points[static_cast<std::size_t>(i)];
            if (slope > point.slope) point = {slope, away_m};
        });
    return points;
}

void append_skyline_errors(const io::TerrainInfo& info, const SurfaceField& source,
                           const SurfaceField& surface, const Eye& eye, const SkylineOptions& options,
                           std::vector<double>& errors_px) {
    for (int i = 0; i < options.columns; ++i) {
        double source_slope = kNoGround, surface_slope = kNoGround;
        along_column(info, eye, options, i, [&](double away_m, double column, double row) {
            const double height_m = source.at_place(column, row);
            if (std::isnan(height_m)) return;
            source_slope = std::max(source_slope, (height_m - eye.height_m) / away_m);
            surface_slope =
                std::max(surface_slope, (double{surface.at_place(column, row)} - eye.height_m) / away_m);
        });
        if (source_slope != kNoGround)
            errors_px.push_back(std::abs(source_slope - surface_slope) * options.projection_px);
    }
}

}  // namespace ridgeline::app
