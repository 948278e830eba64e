// A store's finest heights as the builder's source, so that another store can be made of them.
//
// The store outlives it. One thread at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "ridgeline/build/height_rows.h"
#include "ridgeline/io/store.h"

namespace ridgeline::app {

class StoreRows final : public build::HeightRows {
  public:
    explicit StoreRows(const io::Store& store);

    const io::TerrainInfo& info() const override { return info_; }
    bool may_have_nodata() const override { return true; }
    std::int64_t natural_rows() const override { return store_.grid().quads(); }
    Result<void> read(std::int64_t row, std::int64_t rows, std::span<std::int32_t> quanta) override;
    std::vector<std::string> findings() const override { return {}; }

  private:
    Result<void> load_band(std::int32_t node_row);
    void take_tile(std::int64_t first_column);

    const io::Store& store_;
    io::TerrainInfo info_;
    std::int32_t loaded_ = -1;  // the row of nodes in band_
    std::vector<std::int32_t> band_;
    io::HeightsTile tile_;
    std::vector<std::uint8_t> bytes_;
};

}  // namespace ridgeline::app
