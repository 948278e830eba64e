// Refinement criteria: how near the eye must come before a node splits.
//
// Every criterion is reduced once a frame to a SwitchingRule, which gives each node its switching distance:
// the node splits where the eye is nearer to its box than that. Switching distances never grow downwards,
// because a node's stored error and its size do not; morphing rests on it (docs/selection.md). Stateless; any
// thread.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <string_view>

#include "ridgeline/base/result.h"
#include "ridgeline/io/grid.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/select/view.h"

namespace ridgeline::select {

// One frame's criterion: the larger of an error's and a level's distance.
struct SwitchingRule {
    double metres_per_error_m = 0.0;
    std::array<double, io::Grid::kMaxLevels> level_m{};

    // error_m: the node's stored error, without exaggeration.
    double distance_m(float error_m, int level) const {
        return std::max(metres_per_error_m * static_cast<double>(error_m),
                        level_m[static_cast<std::size_t>(level)]);
    }
};

// The rule, but no node nearer than `metres` is coarser than the finest level. Each coarser one reaches half as far
// again, so that there is a way on which it morphs.
inline SwitchingRule with_finest_within(SwitchingRule rule, double metres, int finest) {
    for (int level = finest - 1; level >= 0; --level, metres *= 1.5) {
        double& level_m = rule.level_m[static_cast<std::size_t>(level)];
        level_m = std::max(level_m, metres);
    }
    return rule;
}

// The same for the cells of a surface that samples heights (docs/quadtree.md): the larger of what a cell's error and its
// quads ask for.
struct CellRule {
    // Metres by metre of the error as it is drawn, with exaggeration; and by metre of a quad's side.
    double by_error = 512.0, by_spacing = 0.0;
};

class Criterion {
  public:
    virtual ~Criterion() = default;
    virtual std::string_view name() const = 0;
    virtual SwitchingRule rule(const View& view, const io::TerrainInfo& info, const io::Grid& grid) const = 0;
    // quads: of a cell's side. By default the error covers at most the tolerated pixels; such a surface has its light
    // and holes by fragment, so quads may be of any size.
    virtual CellRule cell_rule(const View& view, int quads) const;
};

// At a pixel error of 1; the other criteria's distances shrink with the tolerated error as that of
// screen_error does.
struct CriterionOptions {
    // screen_error: how far apart two samples of a node lie at most, in pixels. Rough ground is finer by its
    // error.
    double most_sample_pixels = 3.0;
    // distance: a node splits within this many of its sides (scheduling paper: nearer tiles, finer levels).
    // Four give about the triangles of one pixel's error on mountains.
    double distance_factor = 4.0;
    // roughness: the least number of sides as above, and how many metres of error weigh as much as a metre of
    // side.
    double roughness_factor = 2.0;
    double roughness_weight = 150.0;
    // density: triangles per radian below which a node splits (synthesis paper, eq. 7).
    double density_triangles_per_radian = 2.0e5;
};

// screen_error as the stored error alone asks for: where meshes are compared, not pictures.
constexpr CriterionOptions kErrorAlone{.most_sample_pixels = std::numeric_limits<double>::infinity()};

// Names: screen_error, distance, roughness, density; anything else is an Error that lists them.
Result<std::unique_ptr<Criterion>> make_criterion(std::string_view name,
                                                  const CriterionOptions& options = {});

}  // namespace ridgeline::select
