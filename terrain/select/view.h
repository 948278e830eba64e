// What selection knows of the camera: where the eye is, what it sees, what a turn or a move can show it soon.
//
// Everything is in the drawn frame: metres, x east, y north, z up, with heights as they are drawn, that is
// z = height_offset_m + quanta * quantum_m * exaggeration. So the eye and the frustum need no second frame,
// and the exaggeration in the view only tells selection how to place the store's quanta. Plain values; copy
// them freely.
#pragma once

#include <chrono>
#include <glm/glm.hpp>
#include <span>

#include "ridgeline/base/geometry.h"
#include "ridgeline/base/units.h"
#include "ridgeline/io/node_record.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/select/sun_view.h"

namespace ridgeline::select {

// What may come into view before a tile asked for now has arrived: a cone about the view direction, with its
// apex anywhere within margin_m of the eye. A half angle of 180 degrees is everything.
struct ExtensionZone {
    ExtensionZone() = default;
    ExtensionZone(const glm::dvec3& direction, Angle half_angle, double margin_m);

    glm::dvec3 direction{0.0, 1.0, 0.0};  // unit length
    double cos_half_angle = -1.0;
    double sin_half_angle = 0.0;
    double margin_m = 0.0;
};

// Whether a ball comes within the zone of an eye; conservative.
bool touches(const ExtensionZone& zone, const glm::dvec3& eye_m, const glm::dvec3& centre_m, double radius_m);

// Leave out what the ground in front hides: nothing; by one silhouette per axis and node against boxes, as
// earlier systems do; by chains of ridges against grids of maxima.
enum class HorizonMode { off, boxes, ridges };

struct View {
    glm::dvec3 eye_m{0.0};
    // Four sides and a plane through the eye. Nothing outside it is drawn.
    Frustum visible;
    // A cone about the eye that holds it.
    ExtensionZone picture;
    ExtensionZone extension;
    // Pixels that a length of one metre covers at one metre's distance: (width / 2) / tan(horizontal field /
    // 2).
    double projection_px = 512.0;
    double pixel_error_px = 1.0;
    double exaggeration = 1.0;  // above 0
    // The eye's height over the ground; read by the density criterion alone.
    double eye_above_ground_m = 2.0;
    // Whose shadows are drawn.
    SunView sun;

    HorizonMode horizon = HorizonMode::off;
    // Level unit vector, east and north, to which the horizon's slices are turned. Any gives a right answer,
    // the camera's heading the best.
    glm::dvec2 heading{0.0, 1.0};
    // How deep under the horizon is hidden: rasterisers move vertices by 1/256 pixel, each of two edges.
    double horizon_margin_px = 1.0 / 64.0;
    // Nothing that is this near is sure to be drawn: the picture's corners on the near plane.
    double near_reach_m = 0.2;
    // How far the eye may rise within the paging latency: what would then be seen is wanted ahead.
    double expected_rise_m = 0.0;
    // How far over or under chunks the ground may be that is drawn in their place, as drawn. It is seen, and hides, as
    // far as that allows.
    double beside_finest_m = 0.0;
    // Nearer than this all nodes are of the finest level, whatever their error; metres.
    double finest_within_m = 0.0;
};

// A perspective camera and how it moves.
struct Camera {
    glm::dvec3 eye_m{0.0};
    // Right-handed, orthonormal.
    glm::dvec3 right{1.0, 0.0, 0.0};
    glm::dvec3 up{0.0, 0.0, 1.0};
    glm::dvec3 forward{0.0, 1.0, 0.0};
    Angle horizontal_field = Angle::from_degrees(75.0);
    int width_px = 1024;
    int height_px = 768;
    double near_m = 0.1;
    double speed_m_per_s = 0.0;
    Angle turn_per_second;
};

struct ViewOptions {
    double pixel_error_px = 1.0;
    double exaggeration = 1.0;
    double eye_above_ground_m = 2.0;
    HorizonMode horizon = HorizonMode::off;
    double beside_finest_m = 0.0;
    // From asking for a tile to drawing it; what a turn and a move can reveal within it is asked for ahead.
    std::chrono::duration<double> paging_latency{0.5};
    // Asked for around the frustum even when the camera rests, so that a turn that starts finds its first
    // tiles.
    Angle resting_margin = Angle::from_degrees(6.0);
    // Metres that the eye rises for a metre that it moves.
    double steepest_climb = 0.5;
};

// The frustum is a pixel wider on each side than the picture: rasterisers snap vertices.
View make_view(const Camera& camera, const ViewOptions& options);

// Bounds everything that may be drawn of a terrain, in the drawn frame. records: as in Store::records().
Box drawn_bounds(const io::TerrainInfo& info, std::span<const io::NodeRecord> records, double exaggeration);

// The eye split into a lattice place that integers subtract exactly and a small rest, so that a vertex comes
// out the same from every chunk that draws it: first integers, then one subtraction, then one scale. Uploaded
// as it stands. The place is kept on the terrain, so that differences of integers stay below 2^24 and exact
// as floats.
struct EyeFrame {
    glm::ivec2 cell{0};         // column, row
    glm::vec2 cell_rest{0.0f};  // eye minus cell, in finest samples
    int quanta = 0;
    float quanta_rest = 0.0f;   // eye minus quanta, in quanta
    glm::vec2 spacing_m{1.0f};  // of finest samples, east and south
    float quantum_m = 1.0f;     // with exaggeration
};
EyeFrame eye_frame(const View& view, const io::TerrainInfo& info);
EyeFrame eye_frame(const glm::dvec3& eye_m, double exaggeration, const io::TerrainInfo& info);

}  // namespace ridgeline::select
