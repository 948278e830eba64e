#include "ridgeline/select/seen_ground.h"

#include <algorithm>
#include <cmath>

namespace ridgeline::select {
namespace {

// A mask's cell is at least this part of its distance wide: its grid reaches half a side.
constexpr double kCellPerDistance = 2.0 / GroundMask::kSide;

// By the cells in which its sides lie, at most, as the mask is.
GroundRectangle widened(const GroundRectangle& area, const glm::dvec2& eye, double least_m) {
    if (area.empty()) return area;
    const auto cell = [&](const glm::dvec2& corner) {
        return glm::max(glm::dvec2(least_m), 2.0 * kCellPerDistance * glm::abs(corner - eye));
    };
    return {area.min - cell(area.min), area.max + cell(area.max)};
}

// Where the corners' middle lies, from which all four are as far.
glm::dvec3 forward(const Sight& sight) {
    return glm::normalize(sight.corners[0] + sight.corners[1] + sight.corners[2] + sight.corners[3]);
}

}  // namespace

Sight sight_of(const Camera& camera) {
    const double across = std::tan(camera.horizontal_field.radians() / 2.0);
    const double along = across * camera.height_px / camera.width_px;
    Sight sight{.eye_m = camera.eye_m};
    for (std::size_t i = 0; i < sight.corners.size(); ++i)
        sight.corners[i] = glm::normalize(camera.forward + (i % 2 == 0 ? -across : across) * camera.right +
                                          (i / 2 == 0 ? -along : along) * camera.up);
    return sight;
}

// A move shifts the ground in the picture by as much, at any distance; a turn by its angle times the
// distance. Each may take half a cell.
bool Sight::is_close_to(const Sight& earlier, const GroundLattice& lattice) const {
    if (glm::distance(eye_m, earlier.eye_m) > 0.5 * lattice.cell_m) return false;
    for (std::size_t i = 0; i < corners.size(); ++i)
        if (glm::distance(corners[i], earlier.corners[i]) > 0.5 * kCellPerDistance) return false;
    return true;
}

bool GroundReadback::shows_the_same(const GroundReadback& other) const {
    return sight.eye_m == other.sight.eye_m && sight.corners == other.sight.corners &&
           rectangle.min == other.rectangle.min && rectangle.max == other.rectangle.max &&
           std::equal(mask.words().begin(), mask.words().end(), other.mask.words().begin());
}

GroundView SeenGround::see(const View& view, const Sight& sight, const SelectionResult& selection,
                           const GroundReadback* late) {
    GroundView seen{.rectangle = {},
                    .seen = {},
                    .eye_m = view.eye_m,
                    .forward = forward(sight),
                    .least_cosine = glm::dot(forward(sight), sight.corners.front()),
                    .projection_px = view.projection_px,
                    .pixel_error_px = view.pixel_error_px,
                    .exaggeration = view.exaggeration,
                    .eye_above_ground_m = view.eye_above_ground_m,
                    .picture = view.picture,
                    .soon_m = view.extension.margin_m};
    if (late) add_readback(*late, seen);
    if (!late || !sight.is_close_to(late->sight, lattice_)) add_drawn(view, selection, seen);
    return seen;
}

void SeenGround::add_readback(const GroundReadback& late, GroundView& seen) {
    GroundMask& mask = masks_[seen.seen.size()];
    mask = late.mask;
    mask.widen();
    seen.rectangle.add(widened(late.rectangle, glm::dvec2(late.sight.eye_m), lattice_.cell_m));
    seen.seen = std::span(masks_).first(seen.seen.size() + 1);
}

void SeenGround::add_drawn(const View& view, const SelectionResult& selection, GroundView& seen) {
    GroundMask& mask = masks_[seen.seen.size()];
    mask.clear(lattice_, glm::dvec2(view.eye_m));
    const io::Grid grid = info_.grid();
    for (const DrawEntry& entry : selection.draws)
        for (int q = 0; q < io::kQuarters; ++q) {
            if ((entry.quarters >> q & 1) == 0) continue;
            const io::NodeId square = entry.node.child(q);
            const double side = static_cast<double>(grid.extent(entry.node.level)) / 2.0;
            const glm::dvec2 north_west = info_.world(square.x * side, square.y * side);
            const glm::dvec2 size = side * glm::dvec2(info_.spacing_x_m, info_.spacing_y_m);
            const GroundRectangle area{{north_west.x, north_west.y - size.y},
                                       {north_west.x + size.x, north_west.y}};
            mask.mark(area);
            seen.rectangle.add(area);
        }
    seen.seen = std::span(masks_).first(seen.seen.size() + 1);
}

}  // namespace ridgeline::select
