// The eye stays over what is drawn: how far a walk, and whoever draws as a walk does, must lift it.
#pragma once

#include "ridgeline/render/disc_look.h"
#include "ridgeline/select/selection.h"

namespace ridgeline::stage {

// The eye keeps this far above the drawn ground: four times the near plane's distance, as far as its corners reach in a
// picture of 140 degrees.
constexpr double kClearance_m = 0.4;
// A lifted eye selects anew, which may draw the ground under it higher. Each level that the ground steps down
// makes one more round; two are the usual number.
constexpr int kMostLifts = 8;

// For the selection's last run; residency and ground as it had them. Over all that stands within the near
// plane's reach: a steep face would be cut open there. 0 where the eye is high enough.
inline double eye_lift_m(const select::Selection& selection, select::Residency residency,
                         const select::GroundSource& ground) {
    // Less is a float's rounding, and not worth another selection.
    constexpr double kLeast_m = 1e-3;
    const double lift_m = selection.ground_about(residency, ground, -kClearance_m).highest_m + kClearance_m;
    return lift_m < kLeast_m ? 0.0 : lift_m;
}

// The same over a surface that samples heights, as it would be drawn.
template <class Look>
double sampled_eye_lift_m(const Look& look) {
    constexpr double kLeast_m = 1e-3, kNearReach_m = 0.2;
    const double lift_m = look.highest_about_eye_m(kNearReach_m) + kClearance_m;
    return lift_m < kLeast_m ? 0.0 : lift_m;
}

}  // namespace ridgeline::stage
