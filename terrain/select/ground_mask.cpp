// Literature: the visible rectangle of ground coordinates (scheduling paper, 3.1, step 1), nested grids about
// the eye (geometry clipmaps).
//
// How we differ. The paper keeps only the rectangle, which at eye level holds mostly what is not seen. A grid
// over a rectangle would need to know it before the ground is counted, and its cells would be too coarse near
// the eye; grids about the eye need neither a second pass nor more than a few kilobytes.
#include "ridgeline/select/ground_mask.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ridgeline::select {
namespace {

constexpr int kHalf = GroundMask::kSide / 2;
constexpr int kLast = GroundMask::kSide - 1;
constexpr int kHalfDigits = 6;
static_assert(1 << (kHalfDigits - 1) == kHalf);

std::uint64_t bits(int first, int last) { return ~std::uint64_t{0} >> (kLast - (last - first)) << first; }

}  // namespace

GroundLattice::GroundLattice(const GroundRectangle& terrain) : corner_m(terrain.min) {
    const glm::dvec2 size = terrain.max - terrain.min;
    // From an eye on one border to the other one, in cells of the outermost grid: one less than there are,
    // because the eye stands somewhere in its cell.
    constexpr double kAcross = (kHalf - 1) * static_cast<double>(1 << (GroundMask::kGrids - 1));
    cell_m = std::max(std::max(size.x, size.y), 1e-6) / kAcross;
    cells_per_m = 1.0 / cell_m;
    cells = glm::max(glm::ivec2(glm::ceil(size * cells_per_m)), glm::ivec2(1));
}

glm::ivec2 GroundLattice::cell(const glm::dvec2& place_m) const {
    const glm::dvec2 last(cells - 1);
    return glm::ivec2(glm::clamp(glm::floor((place_m - corner_m) * cells_per_m), glm::dvec2(0.0), last));
}

void GroundMask::clear(const GroundLattice& lattice, const glm::dvec2& eye_m) {
    lattice_ = lattice;
    centre_ = lattice.cell(eye_m);
    words_.fill(0);
}

// Asked a few thousand times a frame: numbers that are not negative need no floor().
GroundMask::Range GroundMask::cells_of(const GroundRectangle& area) const {
    const glm::dvec2 end(lattice_.cells);
    const glm::dvec2 from = (area.min - lattice_.corner_m) * lattice_.cells_per_m;
    const glm::dvec2 to = (area.max - lattice_.corner_m) * lattice_.cells_per_m;
    Range range;
    range.first = glm::ivec2(glm::clamp(from, glm::dvec2(0.0), end - 1.0));
    const glm::dvec2 bounded = glm::clamp(to, glm::dvec2(0.0), end);
    const glm::ivec2 last(bounded);
    range.last = glm::max(last - glm::ivec2(glm::equal(glm::dvec2(last), bounded)), range.first);
    return range;
}

GroundMask::Range GroundMask::in_grid(const Range& cells, int grid) const {
    const glm::ivec2 corner = (centre_ >> grid) - kHalf;
    return {(cells.first >> grid) - corner, (cells.last >> grid) - corner};
}

void GroundMask::mark(const GroundRectangle& area) {
    const Range cells = cells_of(area);
    for (int grid = 0; grid < kGrids; ++grid) {
        Range range = in_grid(cells, grid);
        range.first = glm::max(range.first, glm::ivec2(0));
        range.last = glm::min(range.last, glm::ivec2(kLast));
        if (range.first.x > range.last.x) continue;
        const std::uint64_t seen = bits(range.first.x, range.last.x);
        for (int y = range.first.y; y <= range.last.y; ++y) row(grid, y) |= seen;
    }
}

void GroundMask::mark(std::span<const std::uint64_t, kWords> words) {
    for (std::size_t i = 0; i < words.size(); ++i) words_[i] |= words[i];
    for (int grid = 0; grid + 1 < kGrids; ++grid) {
        const glm::ivec2 corner = (centre_ >> grid) - kHalf, outer = (centre_ >> (grid + 1)) - kHalf;
        for (int y = 0; y < kSide; ++y) {
            std::uint64_t& wide = row(grid + 1, ((corner.y + y) >> 1) - outer.y);
            for (std::uint64_t rest = row(grid, y); rest != 0; rest &= rest - 1) {
                const int x = std::countr_zero(rest);
                wide |= std::uint64_t{1} << (((corner.x + x) >> 1) - outer.x);
            }
        }
    }
}

void GroundMask::widen() {
    for (int grid = 0; grid < kGrids; ++grid) {
        std::uint64_t below = 0;
        for (int y = 0; y < kSide; ++y) {
            const std::uint64_t here = row(grid, y), above = y < kLast ? row(grid, y + 1) : 0;
            const std::uint64_t all = below | here | above;
            row(grid, y) = all | all << 1 | all >> 1;
            below = here;
        }
    }
}

bool GroundMask::any(const GroundRectangle& area) const {
    const Range cells = cells_of(area);
    const glm::ivec2 far = glm::max(glm::abs(cells.first - centre_), glm::abs(cells.last - centre_));
    // None within holds what is so far from the eye's cell.
    const int digits = static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(far.x, far.y))));
    int grid = std::clamp(digits - kHalfDigits, 0, kGrids - 1);
    Range range = in_grid(cells, grid);
    const auto is_held = [](const Range& r) {
        return r.first.x >= 1 && r.first.y >= 1 && r.last.x < kLast && r.last.y < kLast;
    };
    while (!is_held(range) && grid + 1 < kGrids) range = in_grid(cells, ++grid);
    const int last_y = std::min(range.last.y, kLast);
    const std::uint64_t asked = bits(std::max(range.first.x, 0), std::min(range.last.x, kLast));
    for (int y = std::max(range.first.y, 0); y <= last_y; ++y)
        if ((row(grid, y) & asked) != 0) return true;
    return false;
}

bool GroundMask::seen_at(const glm::dvec2& place_m) const {
    const Range cells{lattice_.cell(place_m), lattice_.cell(place_m)};
    int grid = 0;
    Range range = in_grid(cells, grid);
    while (grid + 1 < kGrids && (glm::any(glm::lessThan(range.first, glm::ivec2(0))) ||
                                 glm::any(glm::greaterThan(range.first, glm::ivec2(kLast)))))
        range = in_grid(cells, ++grid);
    return (row(grid, range.first.y) >> range.first.x & 1) != 0;
}

}  // namespace ridgeline::select
