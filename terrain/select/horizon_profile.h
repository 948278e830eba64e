// The horizon as azimuths see it: from a selection's columns, which are projective and lie in eight slices,
// to equal steps of angle. For pictures of the horizon; nothing is decided by it.
#pragma once

#include <span>

#include "ridgeline/base/units.h"
#include "ridgeline/select/selection.h"

namespace ridgeline::select {

// Where an azimuth falls in the columns.
struct ColumnPlace {
    int slice = 0;
    int column = 0;
    // Height over horizontal distance = a column's value times this: z's share of the distance.
    double slope_per_value = 1.0;
};
// azimuth: clockwise from the heading to which the slices are turned; any angle.
ColumnPlace column_place(Angle azimuth);

// What a profile says where no slice was looked at: nothing is known. Minus infinity: nothing hides.
constexpr float kNotLookedAt = -2.0e38f;

// The horizon of the last run at azimuths from - to, the middles of equal steps: height over the eye per
// horizontal distance, the tangent of the elevation below which ground is hidden.
void horizon_profile(const Selection& selection, Angle from, Angle to, std::span<float> slopes);

}  // namespace ridgeline::select
