// Literature: the horizon paper (3.1) takes the half angle of the cone of normals (Shirman and Abi-Ezzi, "The
// cone of normals technique for fast processing of curved patches", 1993) as the only error, 0 in hollows.
// Alone it bounds no pixels: a fold a metre long weighs as much as one of a kilometre. So the turn is
// multiplied by a length that belongs to the scale, and joins the vertical error instead of replacing it. Its
// test for hollows looks along either axis, which also erases passes; ours asks for both, and for the
// diagonals, because a pass that lies askew is straight along both axes.
#include "ridgeline/build/vertex_metric.h"

namespace ridgeline::build {

const char* metric_name(Metric metric) { return metric == Metric::cone ? "cone" : "geometric"; }

VertexMetric::VertexMetric(Metric metric, const io::TerrainInfo& info) : metric_(metric) {
    // Lengths of 1/2, 1, 1.4 and 2 steps gave skylines nearer to the source's by 22, 29, 40 and 46 % at as
    // many triangles, for 2, 6, 22 and 47 % more triangles a frame at the same pixel error (mountains at 20
    // m): the step itself is where the heights that bound pixels still decide.
    for (std::size_t scale = 0; scale < scales_.size(); ++scale) {
        const double step = std::ldexp(1.0, static_cast<int>(scale));
        const double length_m = step * std::sqrt(info.spacing_x_m * info.spacing_y_m);
        ConeScale& to = scales_[scale];
        to.slope_east = static_cast<float>(info.quantum_m / (2.0 * step * info.spacing_x_m));
        to.slope_south = static_cast<float>(info.quantum_m / (2.0 * step * info.spacing_y_m));
        to.height_squared = static_cast<float>(std::pow(2.0 * length_m / info.quantum_m, 2.0));
    }
}

}  // namespace ridgeline::build
