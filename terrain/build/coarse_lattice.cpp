#include "ridgeline/build/coarse_lattice.h"

#include <algorithm>
#include <bit>

#include "ridgeline/build/error_code.h"

namespace ridgeline::build {
namespace {

constexpr int kStep = 1 << CoarseLattice::kFirstScale;

// Whether some cell of the kStep x kStep under a sample is valid.
std::int32_t any_cell(std::span<const std::uint8_t> flags, std::size_t at) {
    int any = 0;
    for (int row = 0; row < kStep; ++row)
        for (int column = 0; column < kStep; ++column)
            any |= flags[at + static_cast<std::size_t>(row * kWindow + column)];
    return any & sample::kCellValid;
}

}  // namespace

CoarseLattice::CoarseLattice(const io::Grid& grid, const VertexMetric& metric)
    : grid_(grid), metric_(metric) {
    Samples eighth{(grid.width() - 2) / kStep + 2, (grid.height() - 2) / kStep + 2, {}};
    const auto count = static_cast<std::size_t>(eighth.columns * eighth.rows);
    eighth.packed.resize(count);
    codes_.push_back({eighth.columns, eighth.rows, {}, {}, std::vector<std::uint8_t>(count)});
    samples_.push_back(std::move(eighth));
}

void CoarseLattice::hand_up(const BlockGrid& blocks, std::int64_t block, const BlockWindow& window,
                            const VertexErrors& errors) {
    Samples& samples = samples_.front();
    Codes& codes = codes_.front();
    const Phases<std::uint8_t>& fine = errors.codes[kFineScales - 1];
    constexpr int kFirst = first_cell(kFineScales - 1);
    const io::LatticePoint origin = blocks.origin(block);
    const int columns = kBlock / kStep + (blocks.last_column(block) ? 1 : 0);
    const int rows = kBlock / kStep + (blocks.last_row(block) ? 1 : 0);
    for (int row = 0; row < rows && origin.y / kStep + row < samples.rows; ++row)
        for (int column = 0; column < columns && origin.x / kStep + column < samples.columns; ++column) {
            const auto to = static_cast<std::size_t>((origin.y / kStep + row) * samples.columns +
                                                     origin.x / kStep + column);
            const std::size_t from = BlockWindow::at(column * kStep, row * kStep);
            const auto flags = window.flags();
            const std::int32_t flag =
                flags.empty() ? sample::kFlags : (flags[from] & sample::kValid) | any_cell(flags, from);
            samples.packed[to] = sample::pack(window.quanta()[from]) | flag;
            codes.centre[to] = fine.centre[fine.at(kFirst + column, kFirst + row)];
        }
}

CoarseLattice::Samples CoarseLattice::decimate(const Samples& fine) {
    Samples coarse{fine.columns / 2 + 1, fine.rows / 2 + 1, {}};
    coarse.packed.reserve(static_cast<std::size_t>(coarse.columns * coarse.rows));
    const auto at = [&](std::int64_t column, std::int64_t row) {
        const bool inside = column < fine.columns && row < fine.rows;
        const std::int64_t nearest =
            std::min(row, fine.rows - 1) * fine.columns + std::min(column, fine.columns - 1);
        return fine.packed[static_cast<std::size_t>(nearest)] & (inside ? ~0 : ~sample::kFlags);
    };
    for (std::int64_t row = 0; row < coarse.rows; ++row)
        for (std::int64_t column = 0; column < coarse.columns; ++column) {
            const std::int32_t cells = at(2 * column, 2 * row) | at(2 * column + 1, 2 * row) |
                                       at(2 * column, 2 * row + 1) | at(2 * column + 1, 2 * row + 1);
            coarse.packed.push_back(at(2 * column, 2 * row) | (cells & sample::kCellValid));
        }
    return coarse;
}

void CoarseLattice::finish() {
    const int top = std::countr_zero(static_cast<std::uint64_t>(grid_.extent(0)));
    while (static_cast<int>(samples_.size()) <= top - kFirstScale)
        samples_.push_back(decimate(samples_.back()));
    for (int scale = kFirstScale; scale < top; ++scale) codes_.push_back(find_codes(scale));
    codes_.front() = {};
}

std::int32_t CoarseLattice::sample(int scale, std::int64_t column, std::int64_t row) const {
    const Samples& samples = samples_[static_cast<std::size_t>(scale - kFirstScale)];
    const std::int64_t x = std::clamp<std::int64_t>(column, 0, samples.columns - 1);
    const std::int64_t y = std::clamp<std::int64_t>(row, 0, samples.rows - 1);
    const std::int32_t packed = samples.packed[static_cast<std::size_t>(y * samples.columns + x)];
    return x == column && y == row ? packed : packed & ~sample::kFlags;
}

std::uint8_t CoarseLattice::own_code(int scale, io::LatticePoint vertex, io::LatticePoint a,
                                     io::LatticePoint b) const {
    const std::int32_t packed = sample(scale, vertex.x, vertex.y);
    if ((packed & sample::kValid) == 0) return 0;
    const std::uint8_t vertical = error_code(sample::quanta(packed), sample::quanta(sample(scale, a.x, a.y)),
                                             sample::quanta(sample(scale, b.x, b.y)));
    return metric_.has_cones() ? std::max(vertical, cone_code(scale, vertex)) : vertical;
}

std::uint8_t CoarseLattice::cone_code(int scale, io::LatticePoint vertex) const {
    const ConeScale& cones = metric_.cones(scale);
    std::int32_t around[3][3], valid = sample::kValid;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            const std::int32_t packed = sample(scale, vertex.x + column - 1, vertex.y + row - 1);
            around[row][column] = sample::quanta(packed);
            valid &= packed;
        }
    if (valid == 0) return 0;
    const auto face = [&](int row, int column) {
        return face_of(around[row][column], around[row][column + 1], around[row + 1][column],
                       around[row + 1][column + 1], cones);
    };
    return error_code_of_square(cones.height_squared *
                                squared_chord(face(0, 0), face(0, 1), face(1, 0), face(1, 1)));
}

CoarseLattice::Codes CoarseLattice::find_codes(int scale) const {
    const Codes& finer = codes(scale - 1);
    // A vertex of scale s takes errors from less than 3 s away.
    Codes result{
        ((grid_.width() - 1) >> (scale + 1)) + 3, ((grid_.height() - 1) >> (scale + 1)) + 3, {}, {}, {}};
    const auto raised = [&](std::uint8_t own, std::int64_t column, std::int64_t row) {
        for (const std::int64_t dy : {0, 1})
            for (const std::int64_t dx : {0, 1})
                own = std::max(own, finer.at(finer.centre, column + dx, row + dy));
        return own;
    };
    for (std::int64_t row = 0; row < result.rows; ++row)
        for (std::int64_t column = 0; column < result.columns; ++column) {
            const std::int64_t i = 2 * column, j = 2 * row;
            result.x.push_back(raised(own_code(scale, {i + 1, j}, {i, j}, {i + 2, j}), i, j - 1));
            result.y.push_back(raised(own_code(scale, {i, j + 1}, {i, j}, {i, j + 2}), i - 1, j));
        }
    for (std::int64_t row = 0; row < result.rows; ++row)
        for (std::int64_t column = 0; column < result.columns; ++column) {
            const std::int64_t i = 2 * column, j = 2 * row;
            const bool falls = falls_eastwards(static_cast<int>(column & 1), static_cast<int>(row & 1));
            const std::uint8_t own = falls ? own_code(scale, {i + 1, j + 1}, {i, j}, {i + 2, j + 2})
                                           : own_code(scale, {i + 1, j + 1}, {i + 2, j}, {i, j + 2});
            result.centre.push_back(
                std::max({own, result.at(result.x, column, row), result.at(result.x, column, row + 1),
                          result.at(result.y, column, row), result.at(result.y, column + 1, row)}));
        }
    return result;
}

std::uint8_t CoarseLattice::code(std::int64_t x, std::int64_t y) const {
    const VertexKind kind = vertex_kind(x, y);
    if (kind.scale - kFirstScale + 1 >= static_cast<int>(codes_.size())) return 0;
    const Codes& found = codes(kind.scale);
    const std::int64_t column = x >> (kind.scale + 1), row = y >> (kind.scale + 1);
    if (kind.centre) return found.at(found.centre, column, row);
    return found.at((x >> kind.scale & 1) != 0 ? found.x : found.y, column, row);
}

std::uint8_t CoarseLattice::level(const Levels& levels, std::int64_t x, std::int64_t y) const {
    return std::min(levels.of_place(vertex_kind(x, y)), levels.of_code(code(x, y)));
}

}  // namespace ridgeline::build
