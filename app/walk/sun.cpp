// The Astronomical Almanac's low-precision formulae for the sun (section C, "Low precision formulas for the
// Sun"), as J. Michalsky, "The Astronomical Almanac's algorithm for approximate solar position", Solar Energy
// 40 (1988), has them.
#include "ridgeline/app/walk/sun.h"

#include <cmath>

namespace ridgeline::app {
namespace {

// Days since noon of 1 January 2000, UTC.
double days_since_2000(std::chrono::sys_seconds time) {
    constexpr std::chrono::sys_seconds kEpoch =
        std::chrono::sys_days(std::chrono::January / 1 / 2000) + std::chrono::hours(12);
    return std::chrono::duration<double, std::ratio<86400>>(time - kEpoch).count();
}

struct Equatorial {
    double right_ascension = 0.0;  // radians
    double declination = 0.0;
};

Equatorial sun_among_the_stars(double days) {
    const double anomaly = Angle::from_degrees(357.528 + 0.9856003 * days).radians();
    const double mean_longitude = 280.460 + 0.9856474 * days;
    const double longitude =
        Angle::from_degrees(mean_longitude + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2.0 * anomaly))
            .radians();
    const double obliquity = Angle::from_degrees(23.439 - 0.0000004 * days).radians();
    return {std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude)),
            std::asin(std::sin(obliquity) * std::sin(longitude))};
}

}  // namespace

render::Daylight daylight_at(std::chrono::sys_seconds time, const glm::dvec2& longitude_latitude) {
    const double days = days_since_2000(time);
    const Equatorial sun = sun_among_the_stars(days);
    // Greenwich mean sidereal time, in degrees.
    const double sidereal = 280.46062 + 360.985647366 * days;
    const double hour_angle =
        Angle::from_degrees(sidereal + longitude_latitude.x).radians() - sun.right_ascension;
    const double latitude = Angle::from_degrees(longitude_latitude.y).radians();
    const double sine = std::sin(latitude) * std::sin(sun.declination) +
                        std::cos(latitude) * std::cos(sun.declination) * std::cos(hour_angle);
    const double east = -std::cos(sun.declination) * std::sin(hour_angle);
    const double north = std::sin(sun.declination) * std::cos(latitude) -
                         std::cos(sun.declination) * std::sin(latitude) * std::cos(hour_angle);
    return {Angle::from_radians(std::atan2(east, north)), Angle::from_radians(std::asin(sine))};
}

}  // namespace ridgeline::app
