// A ridge is followed as a walker in fog would: of all directions ahead, the one that climbs most or falls
// least.
#include "ridgeline/app/bench/stress_paths.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

#include "ridgeline/app/walk/course.h"

namespace ridgeline::app {
namespace {

using platform::Pose;

constexpr double kFullTurn = 2.0 * std::numbers::pi;
constexpr std::size_t kFramesPerSecond = 60;
constexpr int kTeleports = 12;
constexpr int kTurns = 4;
constexpr int kDives = 2;
constexpr double kEye_m = 2.0;
constexpr double kTop_m = 20'000.0;
constexpr double kSprint_m_per_s = 1000.0;
constexpr double kSprintSeconds = 10.0;
constexpr double kOverRidge_m = 30.0;

class Places {
  public:
    Places(const Box& bounds, const platform::GroundFunction& ground) : bounds_(bounds), ground_(ground) {}

    // Uniform in [0, 1). The standard fixes the generator's numbers, but not those of its distributions.
    double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

    // On the ground, away from the border; nothing where chance finds none.
    std::optional<glm::dvec3> any() {
        constexpr int kTries = 1000;
        constexpr double kBorder = 0.1;
        for (int i = 0; i < kTries; ++i) {
            const double across = uniform();
            const glm::dvec2 share = kBorder + (1.0 - 2.0 * kBorder) * glm::dvec2(across, uniform());
            if (const auto found = at(glm::mix(glm::dvec2(bounds_.min), glm::dvec2(bounds_.max), share)))
                return found;
        }
        return std::nullopt;
    }
    std::optional<glm::dvec3> at(const glm::dvec2& place) const {
        const auto height_m = ground_(place);
        return height_m ? std::optional(glm::dvec3(place, *height_m)) : std::nullopt;
    }
    // The highest of some.
    std::optional<glm::dvec3> high() {
        constexpr int kSome = 64;
        auto best = any();
        for (int i = 1; i < kSome && best; ++i)
            if (const auto other = any(); other && other->z > best->z) best = other;
        return best;
    }

    const platform::GroundFunction& ground() const { return ground_; }
    double shorter_side_m() const {
        return std::min(bounds_.max.x - bounds_.min.x, bounds_.max.y - bounds_.min.y);
    }

  private:
    const Box& bounds_;
    const platform::GroundFunction& ground_;
    std::mt19937_64 random_{1};
};

Pose over(const glm::dvec3& ground, double height_m, Angle heading, Angle pitch) {
    return {ground + glm::dvec3(0.0, 0.0, height_m), heading, pitch};
}

Error no_ground() { return Error{"suite stress: finds no ground to go over"}; }

platform::ResolvedPath frames_of(std::vector<Pose> poses) {
    return {std::move(poses), kHeadlessFrameTime, platform::PathEnd::hold};
}

Result<platform::ResolvedPath> teleports(Places& places) {
    constexpr double kHighest_m = 500.0;
    std::vector<Pose> poses;
    for (int i = 0; i < kTeleports; ++i) {
        const auto ground = places.any();
        if (!ground) return no_ground();
        const double height_m = kEye_m * std::pow(kHighest_m / kEye_m, places.uniform());
        const Angle heading = Angle::from_radians(kFullTurn * places.uniform());
        poses.insert(poses.end(), kFramesPerSecond / 2,
                     over(*ground, height_m, heading, Angle::from_degrees(-5.0)));
    }
    return frames_of(std::move(poses));
}

Result<platform::ResolvedPath> turns(Places& places) {
    std::vector<Pose> poses;
    for (int i = 0; i < kTurns; ++i) {
        const auto ground = places.any();
        if (!ground) return no_ground();
        for (std::size_t frame = 0; frame < kFramesPerSecond; ++frame)
            poses.push_back(over(*ground, kEye_m,
                                 Angle::from_radians(kFullTurn * static_cast<double>(frame) /
                                                     static_cast<double>(kFramesPerSecond)),
                                 Angle()));
    }
    return frames_of(std::move(poses));
}

Result<platform::ResolvedPath> dives(Places& places) {
    constexpr std::size_t kFrames = 3 * kFramesPerSecond, kAtBottom = kFramesPerSecond / 2;
    std::vector<Pose> poses;
    for (int i = 0; i < kDives; ++i) {
        const auto ground = places.any();
        if (!ground) return no_ground();
        const Angle heading = Angle::from_radians(kFullTurn * places.uniform());
        for (std::size_t frame = 0; frame < kFrames; ++frame) {
            const double share = static_cast<double>(frame) / static_cast<double>(kFrames - 1);
            poses.push_back(over(*ground, kTop_m * std::pow(kEye_m / kTop_m, share), heading,
                                 Angle::from_degrees(-89.0 * (1.0 - share))));
        }
        poses.insert(poses.end(), kAtBottom, poses.back());
    }
    return frames_of(std::move(poses));
}

glm::dvec2 towards(double heading) { return {std::sin(heading), std::cos(heading)}; }

// The heading within `spread` of another that leads to the highest ground a step away; nothing where none
// leads to ground.
std::optional<double> highest_ahead(const Places& places, const glm::dvec2& from, double heading,
                                    double spread, double step_m) {
    constexpr int kTried = 17;
    std::optional<double> best;
    double best_m = 0.0;
    for (int i = 0; i < kTried; ++i) {
        const double tried = heading + spread * (2.0 * i / (kTried - 1) - 1.0);
        const auto ground = places.at(from + step_m * towards(tried));
        if (!ground || (best && ground->z <= best_m)) continue;
        best = tried;
        best_m = ground->z;
    }
    return best;
}

Result<platform::ResolvedPath> sprint(Places& places) {
    constexpr double kStep_s = 0.25, kAhead = kFullTurn / 8.0;
    constexpr int kSteps = static_cast<int>(kSprintSeconds / kStep_s);
    const auto start = places.high();
    if (!start) return no_ground();
    const double step_m = std::min(kSprint_m_per_s * kStep_s, places.shorter_side_m() / 20.0);
    platform::CameraPath path;
    glm::dvec2 place(*start);
    double heading = highest_ahead(places, place, 0.0, kFullTurn / 2.0, step_m).value_or(0.0);
    for (int i = 0; i <= kSteps; ++i) {
        const auto ahead = highest_ahead(places, place, heading, kAhead, step_m);
        const auto back = ahead ? ahead : highest_ahead(places, place, heading, kFullTurn / 2.0, step_m);
        if (!back) return no_ground();
        heading = *back;
        path.samples.push_back(
            {platform::Seconds(i * kStep_s),
             {glm::dvec3(place, kOverRidge_m), Angle::from_radians(heading), Angle::from_degrees(-5.0)},
             platform::HeightReference::above_ground});
        place += step_m * towards(heading);
    }
    return platform::resolve(path, places.ground(), {.frame_interval = kHeadlessFrameTime});
}

}  // namespace

Result<std::vector<StressPath>> stress_paths(const Box& bounds, const platform::GroundFunction& ground) {
    using Lay = Result<platform::ResolvedPath> (*)(Places & places);
    constexpr std::pair<const char*, Lay> kLaid[] = {
        {"teleports", teleports}, {"turns", turns}, {"sprint", sprint}, {"dives", dives}};
    std::vector<StressPath> paths;
    for (const auto& [name, lay] : kLaid) {
        Places places(bounds, ground);
        auto path = lay(places);
        if (!path) return path.error();
        paths.push_back({name, std::move(*path)});
    }
    return paths;
}

}  // namespace ridgeline::app
