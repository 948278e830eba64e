#include "ridgeline/app/bench/decimated_rows.h"

#include <algorithm>

namespace ridgeline::app {

DecimatedRows::DecimatedRows(const io::Store& store, int step)
    : rows_(store),
      step_(step),
      info_(rows_.info()),
      whole_row_(static_cast<std::size_t>(rows_.info().width)) {
    info_.width = (info_.width - 1) / step + 1;
    info_.height = (info_.height - 1) / step + 1;
    info_.spacing_x_m *= step;
    info_.spacing_y_m *= step;
}

std::int64_t DecimatedRows::natural_rows() const {
    return std::max<std::int64_t>(rows_.natural_rows() / step_, 1);
}

Result<void> DecimatedRows::read(std::int64_t row, std::int64_t rows, std::span<std::int32_t> quanta) {
    auto to = quanta.begin();
    for (std::int64_t i = 0; i < rows; ++i) {
        RIDGELINE_TRY(rows_.read((row + i) * step_, 1, whole_row_));
        for (std::int64_t column = 0; column < info_.width; ++column)
            *to++ = whole_row_[static_cast<std::size_t>(column * step_)];
    }
    return {};
}

}  // namespace ridgeline::app
