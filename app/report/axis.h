// The scale of a chart: its ends, and the round values at which it has ticks. Pure, any thread.
#pragma once

#include <vector>

#include "ridgeline/app/report/quantity.h"

namespace ridgeline::app::report {

struct Axis {
    double first = 0.0;
    double last = 1.0;
    std::vector<double> ticks;
    bool logarithmic = false;

    // 0 at first, 1 at last; beyond the ends beyond these.
    double share(double value) const;
};

// From `first` to `last` with at most `most_ticks` ticks at 1, 2 or 5 times a power of ten; bytes at powers
// of two.
Axis linear_axis(double first, double last, Unit unit, int most_ticks);
// Around `least` and `most`, both above 0, out to the next of 1, 2 or 5 times a power of ten; what is less
// than a millionth of `most` lies before its first.
Axis logarithmic_axis(double least, double most);

}  // namespace ridgeline::app::report
