// Literature: cascaded shadow maps (Engel, ShaderX5, 2006; parallel-split shadow maps, Zhang et al. 2006):
// slices of the view, each with a map of its own, at distances that grow by a constant factor. Maps stay
// still under a moving camera because their texels are snapped to a lattice fixed to the ground (Valient,
// "Stable Rendering of Cascaded Shadow Maps", ShaderX6, 2008).
//
// How we differ. A slice is a ring of distances, not of depths, so that turning the camera moves no border. A
// rectangle is fitted to what the slice and the terrain's bounds have in common, each axis for itself: a low
// sun sees the ground foreshortened, and texels as flat as that keep a shadow's length sharp. Instead of one
// constant size, sizes come in steps, so that most frames keep the last one's texels.
#include "ridgeline/render/shadow_cascades.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ridgeline/shaders/lib/shadow.h"

namespace ridgeline::render {
namespace {

// The nearest ring reaches so many samples: its texels are then a fortieth of a sample's spacing, finer than
// any triangle.
constexpr double kFirstRingSamples = 24.0;
// From ring to ring at least.
constexpr double kLeastGrowth = 1.5;
// The last part of a ring, in which the next one takes over.
constexpr double kBlendShare = 0.2;
// Texel sizes are powers of this: a step changes a shadow's edge by less than the filter blurs it.
constexpr double kTexelSteps = 4.0;  // per octave
// Texels are at most so many times longer than wide, which bounds how far a lookup strays.
constexpr double kMostStretch = 4.0;
// The filter's reach, the tent's last texel and snapping.
constexpr double kFilterMargin_px = 4.0;
// Float rounding of depths in a map and of what is compared with them, as a share of the map's depth.
constexpr double kDepthRounding = 0x1p-21;

using Plane = Frustum::Plane;

// A convex solid of eight corners and six sides: a box, or a slice of a view.
struct Solid {
    std::array<glm::dvec3, 8> corners;
    std::array<Plane, 6> sides;  // inward
};

// Corners differ in one bit where an edge joins them.
constexpr int kEdges[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                               {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

Solid solid_of(const Box& box) {
    Solid solid;
    for (std::size_t i = 0; i < 8; ++i)
        solid.corners[i] = {(i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                            (i & 4) != 0 ? box.max.z : box.min.z};
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 inward(0.0);
        inward[axis] = 1.0;
        solid.sides[static_cast<std::size_t>(2 * axis)] = {inward, -box.min[axis]};
        solid.sides[static_cast<std::size_t>(2 * axis + 1)] = {-inward, box.max[axis]};
    }
    return solid;
}

// What a camera in the origin sees between two depths.
Solid slice_of(const platform::Camera& camera, double from_m, double to_m) {
    const glm::dvec3 ahead = platform::forward(camera.pose);
    const glm::dvec2 tangents = platform::half_tangents(camera.lens);
    const glm::dvec3 right = platform::right(camera.pose) * tangents.x;
    const glm::dvec3 up = platform::up(camera.pose) * tangents.y;
    Solid solid;
    for (std::size_t i = 0; i < 8; ++i)
        solid.corners[i] = (ahead + ((i & 1) != 0 ? right : -right) + ((i & 2) != 0 ? up : -up)) *
                           ((i & 4) != 0 ? to_m : from_m);
    const auto inward = [](const glm::dvec3& normal) { return Plane{glm::normalize(normal), 0.0}; };
    const double x = tangents.x, y = tangents.y;
    solid.sides = {inward(x * x * ahead + right), inward(x * x * ahead - right), inward(y * y * ahead + up),
                   inward(y * y * ahead - up),    Plane{ahead, -from_m},         Plane{-ahead, to_m}};
    return solid;
}

bool clip(const Solid& solid, glm::dvec3& a, glm::dvec3& b) {
    for (const Plane& side : solid.sides) {
        const double from = glm::dot(side.normal, a) + side.offset,
                     to = glm::dot(side.normal, b) + side.offset;
        if (from < 0.0 && to < 0.0) return false;
        const glm::dvec3 crossing = from == to ? a : a + (b - a) * (from / (from - to));
        if (from < 0.0) a = crossing;
        if (to < 0.0) b = crossing;
    }
    return true;
}

// Bounds, along the light axes, of what two convex solids have in common: every corner of that is an end of
// an edge of one as far as it runs within the other.
std::optional<select::SunBox> common_bounds(const select::SunAxes& axes, const Solid& one,
                                            const Solid& other) {
    select::SunBox bounds{glm::dvec3(std::numeric_limits<double>::max()),
                          glm::dvec3(std::numeric_limits<double>::lowest())};
    const auto add_edges = [&](const Solid& edges, const Solid& within) {
        for (const auto& edge : kEdges) {
            glm::dvec3 a = edges.corners[static_cast<std::size_t>(edge[0])];
            glm::dvec3 b = edges.corners[static_cast<std::size_t>(edge[1])];
            if (!clip(within, a, b)) continue;
            for (const glm::dvec3& end : {a, b}) {
                const glm::dvec3 place(glm::dot(axes.across, end), glm::dot(axes.along, end),
                                       glm::dot(axes.towards, end));
                bounds.min = glm::min(bounds.min, place);
                bounds.max = glm::max(bounds.max, place);
            }
        }
    };
    add_edges(one, other);
    add_edges(other, one);
    if (bounds.min.x > bounds.max.x) return std::nullopt;
    return bounds;
}

// The way off the surface is at most so many times both sides of a texel (shaders/lib/shadow.h).
constexpr double kMostOffset_px = double{shaders::kShadowFilterTexels} + double{shaders::kShadowCreaseTexels};

// How far a lookup strays across the map: by the filter, and by the way off the surface.
glm::dvec2 stray_m(const glm::dvec2& texel_m) {
    return kFilterMargin_px * texel_m + kMostOffset_px * (texel_m.x + texel_m.y);
}

// The step that is no smaller than `texel_m`.
double stepped(double texel_m) {
    return std::exp2(std::ceil(std::log2(texel_m) * kTexelSteps) / kTexelSteps);
}

// Texels with which a map covers an extent and what lookups stray past it.
glm::dvec2 texel_size_m(const glm::dvec2& extent_m, int map_px) {
    // Strays are widest where texels are stretched most, on both sides; and snapping takes one texel more.
    const double strays_px = 2.0 * (kFilterMargin_px + kMostOffset_px * (1.0 + kMostStretch)) + 1.0;
    const glm::dvec2 wanted = glm::max(extent_m / (map_px - strays_px), glm::dvec2(1e-3));
    const double least = std::max(wanted.x, wanted.y) / kMostStretch;
    const glm::dvec2 texel(stepped(std::max(wanted.x, least)), stepped(std::max(wanted.y, least)));
    return texel;
}

glm::dvec3 coordinates(const select::SunAxes& axes, const glm::dvec3& place) {
    return {glm::dot(axes.across, place), glm::dot(axes.along, place), glm::dot(axes.towards, place)};
}

// From the light axes' box to clip space.
glm::dmat4 map_matrix(const select::SunAxes& axes, const select::SunBox& box) {
    const glm::dvec3 scale = glm::dvec3(2.0, 2.0, 1.0) / (box.max - box.min);
    const glm::dvec3 shift = -box.min * scale - glm::dvec3(1.0, 1.0, 0.0);
    const glm::dmat3 turn = glm::transpose(glm::dmat3(axes.across, axes.along, axes.towards));
    glm::dmat4 map(1.0);
    for (int column = 0; column < 3; ++column) map[column] = glm::dvec4(turn[column] * scale, 0.0);
    map[3] = glm::dvec4(shift, 1.0);
    return map;
}

struct Fit {
    const ShadowView& view;
    const select::SunAxes& axes;
    Solid terrain;      // relative to the eye
    double sunward_m;   // the terrain's end towards the sun
    glm::dvec3 anchor;  // the light coordinates, relative to the eye, of a place fixed to the ground
};

void fit(const Fit& fit, double from_m, ShadowCascade& ring) {
    // The nearest depth of a distance is in the picture's corners.
    const glm::dvec2 tangents = platform::half_tangents(fit.view.camera.lens);
    const double depth_share = 1.0 / std::sqrt(1.0 + glm::dot(tangents, tangents));
    const Solid slice = slice_of(fit.view.camera, from_m * depth_share, ring.end_m);
    const auto seen = common_bounds(fit.axes, slice, fit.terrain);
    if (!seen) return;
    ring.texel_m = texel_size_m(glm::dvec2(seen->max - seen->min), fit.view.map_px);
    const glm::dvec2 anchor(fit.anchor), stray = stray_m(ring.texel_m);
    ring.least_m =
        glm::floor((glm::dvec2(seen->min) - stray - anchor) / ring.texel_m) * ring.texel_m + anchor;
    ring.most_m = ring.least_m + ring.texel_m * double(fit.view.map_px);
    const double slack_m = stray.x + stray.y;
    ring.map_from_eye = map_matrix(fit.axes, {glm::dvec3(ring.least_m, seen->min.z - slack_m),
                                              glm::dvec3(ring.most_m, fit.sunward_m + slack_m)});
}

// The distances at which rings end: growing by a constant factor from the first to the terrain's far end.
void place_rings(const ShadowView& view, ShadowCascades& cascades) {
    const glm::dvec3& eye_m = view.camera.pose.eye_m;
    const glm::dvec3 farthest =
        glm::max(glm::abs(view.terrain_m.min - eye_m), glm::abs(view.terrain_m.max - eye_m));
    const double far_m = glm::length(farthest);
    const double near_m = distance(eye_m, view.terrain_m) * (1.0 + kBlendShare);
    const double steps = static_cast<double>(ShadowCascades::kCount - 1);
    const double first_m =
        std::min(std::max(kFirstRingSamples * view.spacing_m, near_m), far_m / std::pow(kLeastGrowth, steps));
    const double growth = std::pow(far_m / first_m, 1.0 / steps);
    double end_m = first_m;
    for (ShadowCascade& ring : cascades.rings) {
        ring.end_m = end_m;
        ring.blend_m = end_m * (1.0 - kBlendShare);
        end_m *= growth;
    }
    // Past the last ring there is nothing; rounding must not make it so.
    cascades.rings.back().end_m = far_m * 1.001;
}

}  // namespace

bool ShadowCascades::holds(std::size_t ring, const select::SunBox& box) const {
    const ShadowCascade& map = rings[ring];
    return box.min.x <= map.most_m.x && box.max.x >= map.least_m.x && box.min.y <= map.most_m.y &&
           box.max.y >= map.least_m.y && map.least_m.x <= map.most_m.x;
}

ShadowCascades shadow_cascades(const ShadowView& view) {
    ShadowCascades cascades;
    cascades.axes = select::sun_axes(view.daylight.sun_azimuth, view.daylight.sun_elevation);
    cascades.sun_is_up = cascades.axes.towards.z > 0.0;
    if (!cascades.sun_is_up) return cascades;
    place_rings(view, cascades);
    const glm::dvec3& eye_m = view.camera.pose.eye_m;
    const Box terrain{view.terrain_m.min - eye_m, view.terrain_m.max - eye_m};
    const Fit common{view, cascades.axes, solid_of(terrain),
                     select::sun_box(cascades.axes, glm::dvec3(0.0), terrain).max.z,
                     coordinates(cascades.axes, terrain.min)};
    double from_m = 0.0;
    for (ShadowCascade& ring : cascades.rings) {
        fit(common, from_m, ring);
        from_m = ring.blend_m;
    }
    return cascades;
}

select::SunView sun_view(const ShadowCascades& cascades, select::CasterSet casters) {
    static_assert(ShadowCascades::kCount <= select::SunView::kMostReaches);
    select::SunView view;
    if (!cascades.sun_is_up) return view;
    view.casters = casters;
    view.axes = cascades.axes;
    view.reach_count = ShadowCascades::kCount;
    select::ShadowReach reach;
    for (std::size_t i = 0; i < ShadowCascades::kCount; ++i) {
        const glm::dvec2 stray = stray_m(cascades.rings[i].texel_m);
        reach.aside_m = glm::max(reach.aside_m, stray);
        reach.down_m = std::max(reach.down_m, stray.x + stray.y);
        view.reaches[i] = reach;
        reach.from_m = cascades.rings[i].blend_m;
    }
    return view;
}

shaders::ShadowUniforms shadow_uniforms(const ShadowCascades& cascades, int map_px) {
    shaders::ShadowUniforms uniforms{};
    for (std::size_t i = 0; i < ShadowCascades::kCount; ++i) {
        const ShadowCascade& ring = cascades.rings[i];
        uniforms.cascades[i] = {glm::mat4(ring.map_from_eye),
                                glm::vec4(ring.blend_m, ring.end_m, ring.texel_m.x, ring.texel_m.y)};
    }
    uniforms.across = glm::vec4(glm::vec3(cascades.axes.across), 0.0f);
    uniforms.along = glm::vec4(glm::vec3(cascades.axes.along), 0.0f);
    uniforms.map = glm::vec4(map_px, 1.0 / map_px, kDepthRounding, 0.0);
    return uniforms;
}

}  // namespace ridgeline::render
