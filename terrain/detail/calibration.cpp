// Literature: fractional Brownian motion has residuals that fall by 2^-H an octave (Peitgen, Saupe, "The science of
// fractal images", 1988, midpoint displacement). How we differ: H is measured and may change from octave to octave, for
// real ground's does; and bumps are in proportion to slope and roughness, so that plains stay plains.
#include "ridgeline/detail/calibration.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ridgeline/shaders/lib/detail.h"

namespace ridgeline::detail {
namespace {

// Of a normal distribution, the root mean square over the mean size.
constexpr double kRmsOverMean = 1.2533141373155;
// The trend: from octave to octave H may rise by so much, but not to where ground is smooth. A DEM's finest octave is
// often smoothed in the making, and a trend that took it at its word would make no bumps at all.
constexpr double kMostRise = 0.15, kLeastExponent = 0.5, kMostExponent = 1.1;
// What rounding to quanta adds to the variance of a residual, in squares of a quantum: a twelfth of it for the sample,
// and for the four or sixteen about it by their weights.
constexpr double kEdgeRounding = (1.0 + 0.640625) / 12.0, kFaceRounding = (1.0 + 0.640625 * 0.640625) / 12.0;

// A window's every `step`-th sample as a parent.
struct Decimated {
    const DetailTile& tile;
    int step;

    std::int32_t height(const glm::ivec2& at) const { return tile.height(step * at.x, step * at.y); }
};

// Sums over samples of one kind, in the middle of four or between two.
struct Residuals {
    double squares = 0.0, count = 0.0;
    // Of the sizes fitted by slope and roughness: normal equations.
    double ss = 0.0, sr = 0.0, rr = 0.0, s_size = 0.0, r_size = 0.0;

    void add(double residual, const shaders::DetailControl& control) {
        const double slope = control.slope, roughness = control.roughness;
        const double size = kRmsOverMean * std::abs(residual);
        squares += residual * residual;
        count += 1.0;
        ss += slope * slope, sr += slope * roughness, rr += roughness * roughness;
        s_size += slope * size, r_size += roughness * size;
    }
    double mean_square() const { return count > 0.0 ? squares / count : 0.0; }
};

struct Kinds {
    Residuals face, edge;
};

void add_window(const DetailTile& tile, int step, Kinds& found) {
    const Decimated parent{tile, 2 * step};
    const int most = tile.quads / (2 * step);
    const auto real = [&](int column, int row) {
        return static_cast<double>(tile.height(step * column, step * row));
    };
    // Where four samples lie within the tile to either side.
    for (int y = 1; y + 2 <= most; ++y)
        for (int x = 1; x + 2 <= most; ++x) {
            const glm::ivec2 at(x, y);
            found.face.add(real(2 * x + 1, 2 * y + 1) - shaders::amid_four(parent, at),
                           shaders::control_amid_four(parent, at));
            found.edge.add(real(2 * x + 1, 2 * y) - shaders::between_columns(parent, at),
                           shaders::control_between_columns(parent, at));
            found.edge.add(real(2 * x, 2 * y + 1) - shaders::between_rows(parent, at),
                           shaders::control_between_rows(parent, at));
        }
}

// What slope and roughness are worth, but for the scale.
struct Shares {
    double slope = 0.0, roughness = 1.0;

    double high(const shaders::DetailControl& control) const {
        return slope * control.slope + roughness * control.roughness;
    }
};

// The least squares of sizes, neither share below nothing.
Shares fitted(const Residuals& r) {
    const double determinant = r.ss * r.rr - r.sr * r.sr;
    const Shares of_roughness{0.0, r.rr > 0.0 ? r.r_size / r.rr : 0.0};
    if (determinant <= 1e-9 * r.ss * r.rr) return of_roughness;
    const Shares both{(r.s_size * r.rr - r.r_size * r.sr) / determinant,
                      (r.r_size * r.ss - r.s_size * r.sr) / determinant};
    if (both.slope < 0.0) return of_roughness;
    return both.roughness < 0.0 ? Shares{r.ss > 0.0 ? r.s_size / r.ss : 0.0, 0.0} : both;
}

using Sizes = std::array<double, 3>;

// The sizes of the octaves to come: each falls by 2^-H from the one before, and H goes on as it came.
std::array<double, io::DetailInfo::kMostOctaves> foretold(const Sizes& sizes) {
    std::array<double, io::DetailInfo::kMostOctaves> next{};
    if (sizes[0] <= 0.0 || sizes[1] <= 0.0 || sizes[2] <= 0.0) return next;
    const double finer = std::log2(sizes[1] / sizes[0]), coarser = std::log2(sizes[2] / sizes[1]);
    const double rise = std::clamp(finer - coarser, 0.0, kMostRise);
    double exponent = finer, size = sizes[0];
    for (double& octave : next) {
        exponent = std::clamp(exponent + rise, kLeastExponent, kMostExponent);
        octave = size *= std::exp2(-exponent);
    }
    return next;
}

// The mean square of what a tile's ground would get, were the shares its gains.
struct Highs {
    double face = 0.0, edge = 0.0, count = 0.0;
};

void add_highs(const DetailTile& tile, const Shares& face, const Shares& edge, Highs& highs) {
    const auto square = [](double x) { return x * x; };
    // Every second quad tells enough.
    for (int y = 0; y < tile.quads; y += 2)
        for (int x = 0; x < tile.quads; x += 2) {
            const glm::ivec2 at(x, y);
            highs.face += square(face.high(shaders::control_amid_four(tile, at)));
            highs.edge += 0.5 * square(edge.high(shaders::control_between_columns(tile, at))) +
                          0.5 * square(edge.high(shaders::control_between_rows(tile, at)));
            highs.count += 1.0;
        }
}

int gain(double share, double scale) {
    const double fixed = std::round(share * scale * shaders::kDetailGainOne);
    return static_cast<int>(std::clamp(fixed, 0.0, static_cast<double>(io::DetailInfo::kMostGain)));
}

double scale_for(double size, double mean_square) {
    return mean_square > 0.0 ? size / std::sqrt(mean_square) : 0.0;
}

// A piece of so many windows is carried on: each octave looks at as many samples as the one before.
constexpr std::size_t kCarriedOn = 128;
constexpr int kPieceQuads = 16;

// The piece at a tile's middle, with its apron.
DetailTile middle_of(const DetailTile& tile) {
    constexpr int kApron = io::HeightsTile::kApron;
    const int pieces = tile.quads / kPieceQuads, first = pieces / 2 * kPieceQuads;
    DetailTile piece;
    piece.quads = kPieceQuads;
    piece.node = {tile.node.level, tile.node.x * pieces + pieces / 2, tile.node.y * pieces + pieces / 2};
    for (int row = -kApron; row <= kPieceQuads + kApron; ++row)
        for (int column = -kApron; column <= kPieceQuads + kApron; ++column)
            piece.heights.push_back(tile.height(first + column, first + row));
    return piece;
}

class Foretelling {
  public:
    explicit Foretelling(std::span<const DetailTile> windows) {
        const std::size_t stride = (windows.size() + kCarriedOn - 1) / kCarriedOn;
        for (std::size_t i = 0; i < windows.size(); i += stride) tiles_.push_back(middle_of(windows[i]));
    }

    // The gains with which the ground as it is gets bumps of these sizes.
    io::DetailGains next(double face_size, double edge_size, const Shares& face, const Shares& edge) {
        Highs highs;
        for (const DetailTile& tile : tiles_) add_highs(tile, face, edge, highs);
        const double face_scale = scale_for(face_size, highs.face / std::max(highs.count, 1.0));
        const double edge_scale = scale_for(edge_size, highs.edge / std::max(highs.count, 1.0));
        return {gain(face.slope, face_scale), gain(face.roughness, face_scale), gain(edge.slope, edge_scale),
                gain(edge.roughness, edge_scale)};
    }
    void make(const io::DetailGains& gains) {
        for (std::size_t i = 0; i < tiles_.size(); ++i) {
            make_child(tiles_[i], static_cast<int>(i % io::kQuarters), gains, child_);
            std::swap(tiles_[i], child_);
        }
    }

  private:
    std::vector<DetailTile> tiles_;
    DetailTile child_;
};

}  // namespace

io::DetailInfo calibrate(std::span<const DetailTile> windows, const CalibrationUnits& units) {
    std::array<Kinds, 3> found{};
    for (const DetailTile& tile : windows)
        for (std::size_t octave = 0; octave < found.size(); ++octave)
            add_window(tile, 1 << octave, found[octave]);
    io::DetailInfo info;
    const double rounding = (units.quantum_m / units.unit_m) * (units.quantum_m / units.unit_m);
    Sizes face_sizes{}, edge_sizes{};
    for (std::size_t i = 0; i < found.size(); ++i) {
        face_sizes[i] = std::sqrt(std::max(found[i].face.mean_square() - kFaceRounding * rounding, 0.0));
        edge_sizes[i] = std::sqrt(std::max(found[i].edge.mean_square() - kEdgeRounding * rounding, 0.0));
        info.face_residual_m[i] = face_sizes[i] * units.unit_m;
        info.edge_residual_m[i] = edge_sizes[i] * units.unit_m;
    }
    const Shares face = fitted(found[0].face), edge = fitted(found[0].edge);
    const auto next_faces = foretold(face_sizes), next_edges = foretold(edge_sizes);
    Foretelling ground(windows);
    for (std::size_t octave = 0; octave < next_faces.size(); ++octave) {
        info.octaves.push_back(ground.next(next_faces[octave], next_edges[octave], face, edge));
        ground.make(info.octaves.back());
    }
    return info;
}

}  // namespace ridgeline::detail
