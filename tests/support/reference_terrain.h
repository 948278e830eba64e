// A small terrain worked out slowly and exactly: heights, propagated errors, vertex sets of every level, and
// the surface of every level at every lattice point. What the engine computes in streams and in parallel is
// held against this.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <random>
#include <vector>

#include "ridgeline/io/chunk_codec.h"
#include "ridgeline/io/grid.h"

namespace ridgeline::test {

class ReferenceTerrain {
  public:
    using Height = std::function<std::int32_t(std::int64_t x, std::int64_t y)>;
    using Valid = std::function<bool(std::int64_t x, std::int64_t y)>;

    // height is asked for samples of the raster only; beyond it the nearest sample repeats. Where a lattice
    // point is not valid, its own error counts as none; without `valid`, every point is.
    ReferenceTerrain(io::Grid grid, const Height& height, Valid valid = {})
        : grid_(grid), valid_(std::move(valid)) {
        side_x_ = grid_.nodes_x(0) * grid_.extent(0) + 1;
        side_y_ = grid_.nodes_y(0) * grid_.extent(0) + 1;
        for (std::int64_t y = 0; y < side_y_; ++y)
            for (std::int64_t x = 0; x < side_x_; ++x)
                quanta_.push_back(height(std::min(x, grid_.width() - 1), std::min(y, grid_.height() - 1)));
        propagate_errors();
        // Halves of quanta: from "all that matters" at the finest level upwards by doubling.
        for (int level = 0; level < grid_.levels(); ++level)
            thresholds_.push_back((std::int64_t{6} << (grid_.finest() - level)) - 2);
        code_thresholds_.assign(thresholds_.size(), 255);
    }

    const io::Grid& grid() const { return grid_; }
    std::int32_t quanta(std::int64_t x, std::int64_t y) const { return quanta_[at(x, y)]; }
    bool contains(std::int64_t x, std::int64_t y) const { return within(x, y); }
    // The propagated vertical error in half quanta: e_v = max(own, errors of the vertices that depend on v).
    std::int64_t error(std::int64_t x, std::int64_t y) const { return errors_[at(x, y)]; }
    void set_threshold(int level, std::int64_t half_quanta) {
        thresholds_[static_cast<std::size_t>(level)] = half_quanta;
    }

    // A second error of vertices, as codes that compare; it is propagated as the vertical one is, and a level
    // holds what exceeds either threshold. own is asked for the lattice points that are valid, with the step
    // of their scale.
    using OwnCode = std::function<std::uint8_t(std::int64_t x, std::int64_t y, std::int64_t step)>;
    void join(const OwnCode& own) {
        codes_.assign(quanta_.size(), 0);
        propagate(codes_, [&](std::int64_t x, std::int64_t y, std::int64_t s) {
            return valid_ && !valid_(x, y) ? std::uint8_t{0} : own(x, y, s);
        });
    }
    std::uint8_t joined_code(std::int64_t x, std::int64_t y) const {
        return codes_.empty() ? std::uint8_t{0} : codes_[at(x, y)];
    }
    void set_joined_threshold(int level, std::uint8_t code) {
        code_thresholds_[static_cast<std::size_t>(level)] = code;
    }

    bool in_level(int level, std::int64_t x, std::int64_t y) const {
        if (level < 0) return false;
        if (level > grid_.finest()) return true;
        const std::int64_t s = scale(x, y), extent = grid_.extent(level);
        if (s >= extent / 2 || (s == extent / 4 && is_centre(x, y, s))) return true;
        return error(x, y) > thresholds_[static_cast<std::size_t>(level)] ||
               joined_code(x, y) > code_thresholds_[static_cast<std::size_t>(level)];
    }

    // The exact surface of a level at any lattice point, in quanta.
    double surface(int level, std::int64_t x, std::int64_t y) const {
        if (in_level(level, x, y)) return quanta(x, y);
        const auto [a, b] = ends(x, y);
        return 0.5 * (surface(level, a.x, a.y) + surface(level, b.x, b.y));
    }

    // The ends of the hypotenuse that a vertex halves.
    static std::pair<io::LatticePoint, io::LatticePoint> ends(std::int64_t x, std::int64_t y) {
        const std::int64_t s = scale(x, y);
        if (is_centre(x, y, s)) {
            const std::int64_t a = (x / s) % 4 == 1 ? s : -s, b = (y / s) % 4 == 1 ? s : -s;
            return {{x + a, y + b}, {x - a, y - b}};
        }
        if ((x / s) % 2 != 0) return {{x - s, y}, {x + s, y}};
        return {{x, y - s}, {x, y + s}};
    }

    // The chunk encoder's view of one node.
    class NodeSource final : public io::ChunkSource {
      public:
        NodeSource(const ReferenceTerrain& terrain, io::NodeId node)
            : terrain_(terrain), level_(node.level), origin_(terrain.grid().origin(node)) {}
        std::int32_t quanta(std::int64_t x, std::int64_t y) const override {
            return terrain_.quanta(origin_.x + x, origin_.y + y);
        }
        bool in_level(std::int64_t x, std::int64_t y, int relative) const override {
            return terrain_.in_level(level_ - relative, origin_.x + x, origin_.y + y);
        }

      private:
        const ReferenceTerrain& terrain_;
        int level_;
        io::LatticePoint origin_;
    };

    io::HeightsTile heights_tile(io::NodeId node) const {
        io::HeightsTile tile;
        tile.quads = grid_.quads();
        const std::int64_t step = grid_.step(node.level);
        const io::LatticePoint origin = grid_.origin(node);
        constexpr int kApron = io::HeightsTile::kApron;
        for (int row = -kApron; row <= tile.quads + kApron; ++row)
            for (int column = -kApron; column <= tile.quads + kApron; ++column)
                tile.quanta.push_back(
                    quanta(std::clamp<std::int64_t>(origin.x + column * step, 0, side_x_ - 1),
                           std::clamp<std::int64_t>(origin.y + row * step, 0, side_y_ - 1)));
        return tile;
    }

    // Smooth hills with noise, so that vertex sets are irregular: sums of random waves.
    static Height random_hills(std::uint32_t seed, double amplitude, double noise) {
        std::mt19937 random(seed);
        struct Wave {
            double x, y, phase, amplitude;
        };
        std::vector<Wave> waves;
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        for (int i = 0; i < 12; ++i) {
            const double wavelength = 8.0 * std::pow(2.0, 0.5 * i), direction = 6.283 * unit(random);
            waves.push_back({6.283 * std::cos(direction) / wavelength,
                             6.283 * std::sin(direction) / wavelength, 6.283 * unit(random),
                             amplitude * wavelength / 200.0});
        }
        return [waves, seed, noise](std::int64_t x, std::int64_t y) {
            double h = 0.0;
            for (const Wave& w : waves)
                h += w.amplitude *
                     std::sin(w.x * static_cast<double>(x) + w.y * static_cast<double>(y) + w.phase);
            std::uint32_t k = static_cast<std::uint32_t>(x) * 0x9e3779b1u ^
                              static_cast<std::uint32_t>(y) * 0x85ebca77u ^ seed;
            k = (k ^ (k >> 15)) * 0x2c1b3c6du;
            k ^= k >> 12;
            return static_cast<std::int32_t>(std::lround(h + noise * (k % 1000) / 1000.0));
        };
    }

  private:
    static std::int64_t scale(std::int64_t x, std::int64_t y) {
        const std::int64_t both = x | y;
        return both == 0 ? std::int64_t{1} << 40 : both & -both;
    }
    static bool is_centre(std::int64_t x, std::int64_t y, std::int64_t s) {
        return (x / s) % 2 != 0 && (y / s) % 2 != 0;
    }
    std::size_t at(std::int64_t x, std::int64_t y) const { return static_cast<std::size_t>(y * side_x_ + x); }
    bool within(std::int64_t x, std::int64_t y) const {
        return x >= 0 && y >= 0 && x < side_x_ && y < side_y_;
    }

    void propagate_errors() {
        errors_.assign(quanta_.size(), 0);
        propagate(errors_, [&](std::int64_t x, std::int64_t y, std::int64_t) {
            const auto [a, b] = ends(x, y);
            if (valid_ && !valid_(x, y)) return std::int64_t{0};
            return static_cast<std::int64_t>(
                std::llabs(2 * std::int64_t{quanta(x, y)} - quanta(a.x, a.y) - quanta(b.x, b.y)));
        });
    }

    template <class T, class Own>
    void propagate(std::vector<T>& errors, const Own& own) {
        for (std::int64_t s = 1; s <= grid_.extent(0) / 2; s *= 2) {
            const std::int64_t h = s / 2;
            const io::LatticePoint around_edge[4] = {{-h, -h}, {h, -h}, {-h, h}, {h, h}};
            const io::LatticePoint around_centre[4] = {{-s, 0}, {s, 0}, {0, -s}, {0, s}};
            for (const bool centres : {false, true})
                for (std::int64_t y = 0; y < side_y_; y += s)
                    for (std::int64_t x = 0; x < side_x_; x += s) {
                        if (scale(x, y) != s || is_centre(x, y, s) != centres) continue;
                        T& e = errors[at(x, y)];
                        e = own(x, y, s);
                        if (!centres && s == 1) continue;
                        for (const auto& d : centres ? around_centre : around_edge)
                            if (within(x + d.x, y + d.y)) e = std::max(e, errors[at(x + d.x, y + d.y)]);
                    }
        }
    }

    io::Grid grid_;
    Valid valid_;
    std::int64_t side_x_ = 0, side_y_ = 0;
    std::vector<std::int32_t> quanta_;
    std::vector<std::int64_t> errors_, thresholds_;
    std::vector<std::uint8_t> codes_, code_thresholds_;
};

}  // namespace ridgeline::test
