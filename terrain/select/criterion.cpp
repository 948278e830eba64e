// Literature, by criterion:
//   screen_error  the stored vertical error, seen from the nearest point of the node's box, covers at most the
//                 tolerated pixels (chunked LOD; horizon paper, section 3), and two samples lie at most three times
//                 as many apart: light and holes are as fine as samples, however smooth the ground is.
//   distance      the nearer a tile the finer (scheduling paper, section 3.1, second step): a node splits within so
//                 many of its own sides. Sides halve with each level, so rings of levels are similar.
//   roughness     distance and local roughness together (gpu-quadtree paper, section 1, after Roettger's rule
//                 distance / (side * C * max(c * d2, 1)) < 1, with d2 = error / side): C * max(c * error, side).
//                 The paper measures d2 at a cell's corners and middles; the stored error is the exact maximum.
//   density       triangles per radian seen of a node of n*n samples d apart from height h over the ground,
//                 f = x^2 / (d h) * 2 (n - 1); refine while f <= tau (synthesis paper, eq. 7), solved for x. With
//                 d doubling per level the distance grows by the square root of two, so it never grows downwards.
// The papers test each node; here the same rule is solved for the distance once a frame, which morph ranges
// need.
#include "ridgeline/select/criterion.h"

#include <cmath>
#include <string>

namespace ridgeline::select {
namespace {

double spacing_m(const io::TerrainInfo& info, const io::Grid& grid, int level) {
    return static_cast<double>(grid.step(level)) * std::max(info.spacing_x_m, info.spacing_y_m);
}

void scale_sides(const io::TerrainInfo& info, const io::Grid& grid, double factor, SwitchingRule& rule) {
    for (int level = 0; level < grid.levels(); ++level)
        rule.level_m[static_cast<std::size_t>(level)] = factor * grid.quads() * spacing_m(info, grid, level);
}

class ScreenError final : public Criterion {
  public:
    explicit ScreenError(double most_sample_pixels) : most_sample_pixels_(most_sample_pixels) {}
    std::string_view name() const override { return "screen_error"; }
    SwitchingRule rule(const View& view, const io::TerrainInfo& info, const io::Grid& grid) const override {
        SwitchingRule rule;
        rule.metres_per_error_m = view.exaggeration * view.projection_px / view.pixel_error_px;
        const double metres_a_metre = view.projection_px / (most_sample_pixels_ * view.pixel_error_px);
        for (int level = 0; level < grid.levels(); ++level)
            rule.level_m[static_cast<std::size_t>(level)] = metres_a_metre * spacing_m(info, grid, level);
        return rule;
    }

  private:
    double most_sample_pixels_;
};

class Distance final : public Criterion {
  public:
    explicit Distance(double factor) : factor_(factor) {}
    std::string_view name() const override { return "distance"; }
    SwitchingRule rule(const View& view, const io::TerrainInfo& info, const io::Grid& grid) const override {
        SwitchingRule rule;
        scale_sides(info, grid, factor_ / view.pixel_error_px, rule);
        return rule;
    }
    CellRule cell_rule(const View& view, int quads) const override {
        return {0.0, factor_ * quads / view.pixel_error_px};
    }

  private:
    double factor_;
};

class Roughness final : public Criterion {
  public:
    Roughness(double factor, double weight) : factor_(factor), weight_(weight) {}
    std::string_view name() const override { return "roughness"; }
    SwitchingRule rule(const View& view, const io::TerrainInfo& info, const io::Grid& grid) const override {
        SwitchingRule rule;
        const double factor = factor_ / view.pixel_error_px;
        scale_sides(info, grid, factor, rule);
        rule.metres_per_error_m = factor * weight_ * view.exaggeration;
        return rule;
    }
    CellRule cell_rule(const View& view, int quads) const override {
        const double factor = factor_ / view.pixel_error_px;
        return {factor * weight_, factor * quads};
    }

  private:
    double factor_, weight_;
};

class Density final : public Criterion {
  public:
    explicit Density(double triangles_per_radian) : triangles_per_radian_(triangles_per_radian) {}
    std::string_view name() const override { return "density"; }
    SwitchingRule rule(const View& view, const io::TerrainInfo& info, const io::Grid& grid) const override {
        SwitchingRule rule;
        const double tau = triangles_per_radian_ / view.pixel_error_px;
        // An eye in the ground would see no density at all.
        const double height_m = std::max(view.eye_above_ground_m, 1.0);
        for (int level = 0; level < grid.levels(); ++level)
            rule.level_m[static_cast<std::size_t>(level)] =
                std::sqrt(tau * spacing_m(info, grid, level) * height_m / (2.0 * grid.quads()));
        return rule;
    }

  private:
    double triangles_per_radian_;
};

}  // namespace

CellRule Criterion::cell_rule(const View& view, int) const {
    return {view.projection_px / view.pixel_error_px, 0.0};
}

Result<std::unique_ptr<Criterion>> make_criterion(std::string_view name, const CriterionOptions& options) {
    std::unique_ptr<Criterion> made;
    if (name == "screen_error") made = std::make_unique<ScreenError>(options.most_sample_pixels);
    if (name == "distance") made = std::make_unique<Distance>(options.distance_factor);
    if (name == "roughness")
        made = std::make_unique<Roughness>(options.roughness_factor, options.roughness_weight);
    if (name == "density") made = std::make_unique<Density>(options.density_triangles_per_radian);
    if (made) return made;
    return Error{"'" + std::string(name) +
                 "' is not a criterion: use screen_error, distance, roughness or density"};
}

}  // namespace ridgeline::select
