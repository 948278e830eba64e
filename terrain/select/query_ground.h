// A store's finest ground, or what is made below it, read and made as it is asked for: for heights and for rays.
// Internal to the room; one thread. The store outlives it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "ridgeline/base/least_recent_cache.h"
#include "ridgeline/detail/made_ground.h"
#include "ridgeline/detail/made_range.h"
#include "ridgeline/io/store.h"
#include "ridgeline/select/ray_walk.h"

namespace ridgeline::select {

class QueryGround final : public RayGround, private detail::RootSource {
  public:
    // detail_levels: octaves of made ground, of those that the store foretells.
    QueryGround(const io::Store& store, int detail_levels, std::size_t cached_tiles);

    const io::TerrainInfo& info() const { return store_.info(); }
    const io::Grid& grid() const { return store_.grid(); }
    // Over all ground.
    double top_m() const { return top_m_; }
    // Of a place within the raster, in lattice coordinates, where all samples that matter are valid: bilinear on the
    // deepest level; else nothing.
    Result<std::optional<double>> height_m(double column, double row);

    int deepest_level() const override { return grid().finest() + octaves(); }
    Result<std::optional<HeightRange>> range(io::NodeId node) override;
    Result<CellHeights> cells(io::NodeId node) override;

  private:
    int octaves() const { return made_.ground().octaves(); }
    bool exists(io::NodeId node) const;
    // Of the source's finest level, over a node of it or below it.
    io::NodeId source_of(io::NodeId node) const;
    double height_m_of(double units) const;
    HeightRange range_of(const detail::UnitRange& units) const;

    Result<const io::HeightsTile*> source_tile(io::NodeId node);
    Result<std::optional<double>> sample_quanta(std::int64_t column, std::int64_t row);
    Result<std::optional<double>> source_quanta(double column, double row);
    Result<std::optional<double>> made_units(double column, double row);
    std::optional<detail::UnitRange> source_range(io::NodeId node) const;
    CellHeights source_cells(const io::HeightsTile& tile) const;
    const std::uint8_t* made_valid(const io::HeightsTile& source, const detail::DetailTile& made);
    Result<bool> fill_root(io::NodeId node, detail::DetailTile& root) override;

    const io::Store& store_;
    LeastRecentCache<io::HeightsTile> tiles_;
    detail::MadeGround made_;
    double top_m_ = -std::numeric_limits<double>::infinity();
    std::vector<std::uint8_t> bytes_;
    std::vector<std::uint8_t> valid_;  // of the last cells()
};

}  // namespace ridgeline::select
