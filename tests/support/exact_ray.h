// The height of a ray over bilinear ground, cell by cell and without any hierarchy: what ray casts are held
// against. Slow and in long double; of a different make than theirs: values and bisection instead of roots.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "ridgeline/io/terrain_info.h"

namespace ridgeline::test {

struct SampledGround {
    const io::TerrainInfo* info = nullptr;
    // Metres; empty where the sample is invalid.
    std::function<std::optional<double>(std::int64_t x, std::int64_t y)> height_m;
};

class ExactRay {
  public:
    using Real = long double;
    static constexpr Real kInfinite = std::numeric_limits<Real>::infinity();

    // unit: of length 1. rim: cells reach that much farther, in their sides; rounding decides whether a ray
    // brushes one.
    ExactRay(const SampledGround& ground, const glm::dvec3& origin_m, const glm::dvec3& unit, double length_m,
             double rim)
        : ground_(ground), rim_(rim) {
        const io::TerrainInfo& info = *ground.info;
        origin_[0] = (Real{origin_m.x} - info.west_m) / info.spacing_x_m;
        origin_[1] = (Real{info.north_m} - origin_m.y) / info.spacing_y_m;
        slope_[0] = Real{unit.x} / info.spacing_x_m;
        slope_[1] = -Real{unit.y} / info.spacing_y_m;
        for (int axis = 0; axis < 2; ++axis)
            if (slope_[axis] == 0 && std::abs(origin_[axis] - std::round(origin_[axis])) < 1e-6L)
                origin_[axis] = std::round(origin_[axis]);
        up_ = origin_m.z;
        climb_ = unit.z;
        find_pieces(length_m);
    }

    // Where the ray has gone from `clear` on one side of the ground to `clear` on the other for the first
    // time; infinite if it never does.
    Real crossed_m(Real clear) const {
        Real side = 0, known_until = -kInfinite;
        for (const Piece& piece : pieces_) {
            if (piece.from > known_until + 1e-9L) side = 0;
            known_until = std::max(known_until, piece.to);
            if (side != 0 && side * over(piece, piece.from) <= -clear) return piece.from;
            if (side == 0 && std::abs(over(piece, piece.from)) >= clear) side = over(piece, piece.from);
            const Real last = over(piece, piece.to);
            if (side != 0 && side * last < 0 && std::abs(last) >= clear)
                return bisected(piece, side > 0 ? -clear : clear);
            if (side == 0 && std::abs(last) >= clear) side = last;
            side = side > 0 ? 1 : side < 0 ? -1 : 0;
        }
        return kInfinite;
    }
    // Where it is `depth` under ground for the first time; infinite if it never is. Ground that it runs over
    // for less than `brush` does not count.
    Real under_m(Real depth, Real brush) const {
        for (const Piece& piece : pieces_) {
            if (piece.to - piece.from < brush) continue;
            if (over(piece, piece.from) <= -depth) return piece.from;
            if (over(piece, piece.to) <= -depth) return bisected(piece, -depth);
        }
        return kInfinite;
    }
    // Its height over ground there, of the smallest amount; infinite over none.
    Real over_m(Real t) const {
        Real least = kInfinite;
        for (const Piece& piece : pieces_)
            if (piece.from - 1e-9L <= t && t <= piece.to + 1e-9L &&
                std::abs(over(piece, t)) < std::abs(least))
                least = over(piece, t);
        return least;
    }

  private:
    // Part of a ray over one cell, on which its height over the ground only rises or only falls.
    struct Piece {
        Real from = 0, to = 0;
        std::int64_t x = 0, y = 0;
        Real corner_m[4] = {};
    };

    void clip(Real& from, Real& to, Real origin, Real slope, Real low, Real high) const {
        if (slope == 0) {
            if (origin < low || origin > high) from = 1, to = 0;
            return;
        }
        const Real a = (low - rim_ - origin) / slope, b = (high + rim_ - origin) / slope;
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }

    void find_pieces(Real length_m) {
        const std::int64_t columns = ground_.info->width - 1, rows = ground_.info->height - 1;
        for (std::int64_t y = 0; y < rows; ++y) {
            Real from = 0, to = length_m;
            clip(from, to, origin_[1], slope_[1], static_cast<Real>(y), static_cast<Real>(y + 1));
            if (!(from <= to)) continue;
            clip(from, to, origin_[0], slope_[0], 0, static_cast<Real>(columns));
            if (!(from <= to)) continue;
            const Real a = origin_[0] + slope_[0] * from, b = origin_[0] + slope_[0] * to;
            const auto first = static_cast<std::int64_t>(std::floor(std::min(a, b))) - 1;
            const auto last = static_cast<std::int64_t>(std::floor(std::max(a, b))) + 1;
            for (std::int64_t x = std::max<std::int64_t>(first, 0); x <= std::min(last, columns - 1); ++x)
                add_cell(x, y, from, to);
        }
        std::stable_sort(pieces_.begin(), pieces_.end(), [](const Piece& a, const Piece& b) {
            return a.from != b.from ? a.from < b.from : a.to < b.to;
        });
    }

    void add_cell(std::int64_t x, std::int64_t y, Real from, Real to) {
        clip(from, to, origin_[0], slope_[0], static_cast<Real>(x), static_cast<Real>(x + 1));
        Piece piece{from, to, x, y};
        if (!(from <= to) || !find_corners(piece)) return;
        // Where the height neither rises nor falls: its second difference is constant.
        const Real length = to - from;
        const Real at[3] = {over(piece, from), over(piece, from + length / 2), over(piece, to)};
        const Real bend = at[0] - 2 * at[1] + at[2];
        const Real still = bend != 0 ? from + length * (3 * at[0] - 4 * at[1] + at[2]) / (4 * bend) : from;
        if (still > from && still < to) {
            Piece rest = piece;
            piece.to = rest.from = still;
            pieces_.push_back(rest);
        }
        pieces_.push_back(piece);
    }

    // A ray on a line of the lattice needs the samples on it alone.
    bool find_corners(Piece& piece) const {
        for (int corner = 0; corner < 4; ++corner) {
            const int east = corner & 1, south = corner >> 1;
            const bool off_x = slope_[0] == 0 && origin_[0] == static_cast<Real>(piece.x + 1 - east);
            const bool off_y = slope_[1] == 0 && origin_[1] == static_cast<Real>(piece.y + 1 - south);
            const auto height =
                ground_.height_m(piece.x + (off_x ? 1 - east : east), piece.y + (off_y ? 1 - south : south));
            if (!height) return false;
            piece.corner_m[corner] = *height;
        }
        return true;
    }

    Real over(const Piece& piece, Real t) const {
        const Real u = origin_[0] + slope_[0] * t - static_cast<Real>(piece.x);
        const Real v = origin_[1] + slope_[1] * t - static_cast<Real>(piece.y);
        const auto& h = piece.corner_m;
        return up_ + climb_ * t - ((h[0] * (1 - u) + h[1] * u) * (1 - v) + (h[2] * (1 - u) + h[3] * u) * v);
    }

    // Where the height over ground, which passes `level` within the piece, does.
    Real bisected(const Piece& piece, Real level) const {
        Real low = piece.from, high = piece.to;
        const bool rises = over(piece, high) > over(piece, low);
        for (int i = 0; i < 80; ++i) {
            const Real middle = (low + high) / 2;
            ((over(piece, middle) < level) == rises ? low : high) = middle;
        }
        return high;
    }

    const SampledGround& ground_;
    const Real rim_;
    Real origin_[2] = {}, slope_[2] = {}, up_ = 0, climb_ = 0;
    std::vector<Piece> pieces_;
};

}  // namespace ridgeline::test
