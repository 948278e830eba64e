// Every so manieth sample of a store's finest heights, where it was, as the builder's source.
//
// The store outlives it. One thread at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "ridgeline/app/bench/store_rows.h"

namespace ridgeline::app {

class DecimatedRows final : public build::HeightRows {
  public:
    // step: a power of two; two samples are left in each direction at least.
    DecimatedRows(const io::Store& store, int step);

    const io::TerrainInfo& info() const override { return info_; }
    bool may_have_nodata() const override { return rows_.may_have_nodata(); }
    std::int64_t natural_rows() const override;
    Result<void> read(std::int64_t row, std::int64_t rows, std::span<std::int32_t> quanta) override;
    std::vector<std::string> findings() const override { return {}; }

  private:
    StoreRows rows_;
    int step_;
    io::TerrainInfo info_;
    std::vector<std::int32_t> whole_row_;
};

}  // namespace ridgeline::app
