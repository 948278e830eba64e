// Sources that share a lattice are joined before warping, so that bilinear values across their seams come
// from both sides; only what does not fit is warped onto the first one's lattice.
#include "plan.h"

#include <algorithm>
#include <cmath>

#include "mosaic.h"
#include "warped_grid.h"

namespace ridgeline::raster {
namespace {

// Two lattices are one while no sample is off by more than this share of a spacing.
constexpr double kLatticeTolerance = 0.02;

struct Offset {
    std::int64_t columns = 0;
    std::int64_t rows = 0;
};

bool is_near_whole(double value) { return std::abs(value - std::round(value)) <= kLatticeTolerance; }

double columns_between(const Placement& from, const Placement& to) {
    return (to.world_from_pixel[0] - from.world_from_pixel[0]) / from.spacing_x();
}

double rows_between(const Placement& from, const Placement& to) {
    return (from.world_from_pixel[3] - to.world_from_pixel[3]) / from.spacing_y();
}

Offset offset_between(const Placement& from, const Placement& to) {
    return {std::llround(columns_between(from, to)), std::llround(rows_between(from, to))};
}

bool on_one_lattice(const Placement& a, const Placement& b) {
    if (!a.is_north_up() || !b.is_north_up() || !same_plane(a.crs, b.crs)) return false;
    const double stretch_x = std::abs(b.spacing_x() / a.spacing_x() - 1) * static_cast<double>(b.width);
    const double stretch_y = std::abs(b.spacing_y() / a.spacing_y() - 1) * static_cast<double>(b.height);
    return stretch_x <= kLatticeTolerance && stretch_y <= kLatticeTolerance &&
           is_near_whole(columns_between(a, b)) && is_near_whole(rows_between(a, b));
}

// Grids on one lattice as one; the placement grows over them all.
PlacedGrid mosaic_of(std::vector<PlacedGrid> parts) {
    if (parts.size() == 1) return std::move(parts.front());
    PlacedGrid whole{nullptr, parts.front().placement, parts.front().name, false};
    const Placement first = parts.front().placement;
    Offset least;
    for (const PlacedGrid& part : parts) {
        const Offset offset = offset_between(first, part.placement);
        least = {std::min(least.columns, offset.columns), std::min(least.rows, offset.rows)};
        whole.warped |= part.warped;
    }
    std::vector<Mosaic::Part> placed;
    for (PlacedGrid& part : parts) {
        const Offset offset = offset_between(first, part.placement);
        placed.push_back({std::move(part.grid), offset.columns - least.columns, offset.rows - least.rows});
    }
    whole.placement.world_from_pixel[0] += static_cast<double>(least.columns) * first.spacing_x();
    whole.placement.world_from_pixel[3] -= static_cast<double>(least.rows) * first.spacing_y();
    whole.grid = std::make_shared<Mosaic>(std::move(placed));
    whole.placement.width = whole.grid->width();
    whole.placement.height = whole.grid->height();
    return whole;
}

// Joins neighbours in the list that share a lattice; the order in which they cover one another stays.
std::vector<PlacedGrid> join_runs(std::vector<PlacedGrid> sources) {
    std::vector<PlacedGrid> joined;
    std::vector<PlacedGrid> run;
    for (PlacedGrid& source : sources) {
        if (!run.empty() && !on_one_lattice(run.front().placement, source.placement)) {
            joined.push_back(mosaic_of(std::move(run)));
            run.clear();
        }
        run.push_back(std::move(source));
    }
    joined.push_back(mosaic_of(std::move(run)));
    return joined;
}

Result<void> require_places(const std::vector<PlacedGrid>& sources) {
    if (sources.size() == 1) return {};
    for (const PlacedGrid& source : sources) {
        if (!source.placement.georeferenced)
            return Error{source.name +
                         ": has no georeference, so its place among the other rasters is unknown"};
        if (source.placement.crs.IsEmpty() != sources.front().placement.crs.IsEmpty())
            return Error{(source.placement.crs.IsEmpty() ? source : sources.front()).name +
                         ": names no CRS, the other rasters do; --crs says what its coordinates are in"};
    }
    return {};
}

Result<OGRSpatialReference> target_crs(const PlacedGrid& first, const std::string& wanted,
                                       std::vector<std::string>& notes) {
    if (!wanted.empty()) {
        if (first.placement.georeferenced) return metric_crs(wanted);
        notes.push_back("--crs " + wanted + " means nothing without a georeference");
    }
    if (!first.placement.is_geographic()) return first.placement.crs;
    auto chosen = choose_metric_crs(first.placement);
    if (!chosen) return Error{first.name + ": " + chosen.error().message};
    notes.push_back("geographic coordinates: warped to " + chosen->name + " (--crs chooses another)");
    return chosen->crs;
}

Result<PlacedGrid> warp(const PlacedGrid& source, const WarpTarget& target) {
    auto warped = WarpedGrid::create(source.grid, source.placement, target);
    if (!warped) return Error{source.name + ": " + warped.error().message};
    return PlacedGrid{*warped, (*warped)->placement(), source.name, true};
}

}  // namespace

Result<PlacedGrid> join(std::vector<PlacedGrid> sources, const PlanOptions& options,
                        std::vector<std::string>& notes) {
    RIDGELINE_TRY(require_places(sources));
    std::vector<PlacedGrid> grids = join_runs(std::move(sources));
    auto crs = target_crs(grids.front(), options.crs, notes);
    if (!crs) return crs.error();
    WarpTarget target{*crs, std::nullopt, options.threads};
    for (PlacedGrid& grid : grids) {
        const bool on_plane = grid.placement.is_north_up() && same_plane(grid.placement.crs, target.crs);
        const bool on_lattice = !target.lattice || on_one_lattice(*target.lattice, grid.placement);
        if (!on_plane || !on_lattice) {
            if (on_plane) notes.push_back(grid.name + ": is resampled onto the first raster's lattice");
            if (!grid.placement.is_north_up())
                notes.push_back(grid.name + ": is rotated and resampled to north-up");
            auto warped = warp(grid, target);
            if (!warped) return warped.error();
            grid = std::move(*warped);
        }
        if (!target.lattice) target.lattice = grid.placement;
    }
    return mosaic_of(std::move(grids));
}

}  // namespace ridgeline::raster
