#include "ridgeline/platform/path_generators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

namespace ridgeline::platform {

namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;
// Twice this many samples change no frame's place by more than a few millimetres.
constexpr std::size_t kSamplesPerRound = 240;

glm::dvec2 on_unit_circle(double share) { return {std::sin(share * kFullTurn), std::cos(share * kFullTurn)}; }

// --- orbit -------------------------------------------------------------------------------------------------

Pose orbit_pose(const Box& bounds, const OrbitOptions& options, double share) {
    const glm::dvec3 extent = bounds.max - bounds.min;
    const glm::dvec3 center = (bounds.min + bounds.max) / 2.0;
    const glm::dvec2 place =
        glm::dvec2(center) + on_unit_circle(share) * glm::dvec2(extent) * options.radius_share;
    const glm::dvec3 eye(place, bounds.max.z + options.height_share * std::min(extent.x, extent.y));
    return looking_along(eye, center - eye);
}

// --- walk --------------------------------------------------------------------------------------------------

constexpr std::size_t kWayPoints = 8;
constexpr std::size_t kStepsPerLeg = 64;
using Route = std::array<glm::dvec2, kWayPoints>;

// Uniform in [0, 1). The standard fixes the generator's numbers, but not those of its distributions.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// How steep the ground is over a span, as the tangent of the steepest direction; nothing without data.
class SlopeField {
  public:
    SlopeField(const Box& bounds, const GroundFunction& ground, double span_m)
        : bounds_(bounds), ground_(ground), half_span_m_(span_m / 2.0) {}

    std::optional<double> at(const glm::dvec2& place) const {
        const auto east = ground_(place + glm::dvec2(half_span_m_, 0.0));
        const auto west = ground_(place - glm::dvec2(half_span_m_, 0.0));
        const auto north = ground_(place + glm::dvec2(0.0, half_span_m_));
        const auto south = ground_(place - glm::dvec2(0.0, half_span_m_));
        if (!east || !west || !north || !south) return std::nullopt;
        return std::hypot(*east - *west, *north - *south) / (2.0 * half_span_m_);
    }

    // Over an even grid inside the bounds; nothing without data.
    std::optional<double> median() const {
        constexpr int kSide = 32;
        std::vector<double> slopes;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x)
                if (const auto slope = at(inside((glm::dvec2(x, y) + 0.5) / double{kSide})))
                    slopes.push_back(*slope);
        if (slopes.empty()) return std::nullopt;
        const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
        std::ranges::nth_element(slopes, middle);
        return *middle;
    }

    // (0, 0) to (1, 1) spans the places that lie half a span or more inside the bounds.
    glm::dvec2 inside(const glm::dvec2& share) const {
        return glm::mix(glm::dvec2(bounds_.min) + half_span_m_, glm::dvec2(bounds_.max) - half_span_m_,
                        share);
    }

  private:
    const Box& bounds_;
    const GroundFunction& ground_;
    double half_span_m_;
};

glm::dvec2 catmull_rom(const Route& route, std::size_t leg, double share) {
    const auto& p0 = route[(leg + kWayPoints - 1) % kWayPoints];
    const auto& p1 = route[leg];
    const auto& p2 = route[(leg + 1) % kWayPoints];
    const auto& p3 = route[(leg + 2) % kWayPoints];
    return 0.5 * (2.0 * p1 + (p2 - p0) * share + (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) * (share * share) +
                  (3.0 * p1 - p0 - 3.0 * p2 + p3) * (share * share * share));
}

// The closed curve through the way-points, as a fine polygon that ends where it begins.
std::vector<glm::dvec2> trace(const Route& route) {
    std::vector<glm::dvec2> curve;
    for (std::size_t leg = 0; leg < kWayPoints; ++leg)
        for (std::size_t i = 0; i < kStepsPerLeg; ++i)
            curve.push_back(catmull_rom(route, leg, static_cast<double>(i) / kStepsPerLeg));
    curve.push_back(curve.front());
    return curve;
}

double length_of(const std::vector<glm::dvec2>& curve) {
    double length = 0.0;
    for (std::size_t i = 1; i < curve.size(); ++i) length += glm::distance(curve[i - 1], curve[i]);
    return length;
}

// A loop about the origin, `length_m` long: a circle pulled into an ellipse and shaken a little.
Route random_loop(std::mt19937_64& random, double length_m) {
    const double stretch = 1.0 + 0.5 * uniform(random);
    const double turn = uniform(random);
    Route route;
    for (std::size_t i = 0; i < kWayPoints; ++i) {
        const double radius = 0.85 + 0.3 * uniform(random);
        const glm::dvec2 on_ellipse =
            on_unit_circle(static_cast<double>(i) / kWayPoints) * glm::dvec2(stretch, 1.0);
        const glm::dvec2 axis = on_unit_circle(turn);
        route[i] = radius * glm::dvec2(axis.y * on_ellipse.x + axis.x * on_ellipse.y,
                                       axis.y * on_ellipse.y - axis.x * on_ellipse.x);
    }
    const double scale = length_m / length_of(trace(route));
    for (auto& point : route) point *= scale;
    return route;
}

// How many way-points are steep enough; nothing where one has no data.
std::optional<std::size_t> count_steep(const Route& route, const SlopeField& slopes, double median) {
    std::size_t steep = 0;
    for (const auto& point : route) {
        const auto slope = slopes.at(point);
        if (!slope) return std::nullopt;
        steep += *slope > median ? 1 : 0;
    }
    return steep;
}

// The first loop found whose way-points are all steeper than the median; failing that, the best of those
// tried.
std::optional<Route> find_route(const SlopeField& slopes, double length_m, std::size_t seed) {
    constexpr int kTries = 256;
    const auto median = slopes.median();
    if (!median) return std::nullopt;
    std::mt19937_64 random(seed);
    std::optional<Route> best;
    std::size_t most_steep = 0;
    for (int i = 0; i < kTries && most_steep < kWayPoints; ++i) {
        const double across = uniform(random);
        const glm::dvec2 center = slopes.inside({across, uniform(random)});
        Route route = random_loop(random, length_m);
        for (auto& point : route) point += center;
        const auto steep = count_steep(route, slopes, *median);
        if (!steep || (best && *steep <= most_steep)) continue;
        best = route;
        most_steep = *steep;
    }
    return best;
}

// Places at equal distances along the closed curve, the first not repeated at the end.
std::vector<glm::dvec2> even_places(const std::vector<glm::dvec2>& curve, std::size_t count) {
    const double spacing = length_of(curve) / static_cast<double>(count);
    std::vector<glm::dvec2> places;
    double passed = 0.0;
    for (std::size_t i = 1; i < curve.size() && places.size() < count; ++i) {
        const double step = glm::distance(curve[i - 1], curve[i]);
        for (; places.size() < count && static_cast<double>(places.size()) * spacing < passed + step;) {
            const double share = (static_cast<double>(places.size()) * spacing - passed) / step;
            places.push_back(glm::mix(curve[i - 1], curve[i], share));
        }
        passed += step;
    }
    return places;
}

// The mean of a closed list over `reach` neighbours on both sides.
std::vector<double> smoothed(const std::vector<double>& values, std::size_t reach) {
    const std::size_t count = values.size();
    std::vector<double> means(count);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k <= 2 * reach; ++k) means[i] += values[(i + count + k - reach) % count];
        means[i] /= static_cast<double>(2 * reach + 1);
    }
    return means;
}

// Half of the slope ahead, over about two seconds: looks where it goes, but stays about level.
std::vector<double> pitches(const std::vector<glm::dvec2>& places, const GroundFunction& ground) {
    constexpr std::size_t kReach = 8;
    const std::size_t count = places.size();
    std::vector<double> heights(count);
    for (std::size_t i = 0; i < count; ++i)
        heights[i] = ground(places[i]).value_or(i > 0 ? heights[i - 1] : 0.0);
    heights = smoothed(heights, kReach);
    std::vector<double> pitch(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t next = (i + 1) % count;
        const double slope = (heights[next] - heights[i]) / glm::distance(places[i], places[next]);
        pitch[i] = std::clamp(std::atan(slope) / 2.0, -0.25, 0.25);
    }
    return smoothed(pitch, kReach);
}

CameraPath walk_along(const std::vector<glm::dvec2>& places, const GroundFunction& ground,
                      const GroundPathOptions& options) {
    const std::size_t count = places.size();
    const std::vector<double> pitch = pitches(places, ground);
    CameraPath path;
    path.end = PathEnd::repeat;
    for (std::size_t i = 0; i <= count; ++i) {
        const std::size_t here = i % count;
        const glm::dvec2 along = places[(here + 1) % count] - places[(here + count - 1) % count];
        Pose pose =
            looking_along(glm::dvec3(places[here], options.eye_above_ground_m), glm::dvec3(along, 0.0));
        pose.pitch = Angle::from_radians(pitch[here]);
        path.samples.push_back({options.round * (static_cast<double>(i) / static_cast<double>(count)), pose,
                                HeightReference::above_ground});
    }
    return path;
}

}  // namespace

CameraPath orbit_path(const Box& bounds, const OrbitOptions& options) {
    CameraPath path;
    path.end = PathEnd::repeat;
    for (std::size_t i = 0; i <= kSamplesPerRound; ++i) {
        const double share = static_cast<double>(i) / kSamplesPerRound;
        path.samples.push_back({options.round * share,
                                orbit_pose(bounds, options, i == kSamplesPerRound ? 0.0 : share),
                                HeightReference::absolute});
    }
    return path;
}

Result<CameraPath> ground_path(const Box& bounds, const GroundFunction& ground,
                               const GroundPathOptions& options) {
    const glm::dvec3 extent = bounds.max - bounds.min;
    const double room_m = std::min(extent.x, extent.y);
    // Small data get a smaller loop, of a third of their width, and slopes over an eighth of it.
    const double length_m = std::min(options.speed_m_per_s * options.round.count(), room_m);
    const SlopeField slopes(bounds, ground, std::min(options.slope_span_m, room_m / 4.0));
    const auto route = find_route(slopes, length_m, options.seed);
    if (!route) return Error{"path ground: found no place to walk: too little of the terrain holds data"};
    return walk_along(even_places(trace(*route), kSamplesPerRound), ground, options);
}

}  // namespace ridgeline::platform
