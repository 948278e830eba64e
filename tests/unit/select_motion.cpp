// The surface from frame to frame: it glides where the eye moves, and the eye stays above it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "unit/select_scene.h"

namespace ridgeline::test {
namespace {

struct Sample {
    double column = 0.0, row = 0.0;
};

std::vector<Sample> random_samples(const Scene& scene, Random& random, int count) {
    std::vector<Sample> samples;
    for (int i = 0; i < count; ++i)
        samples.push_back({uniform(random, 0.0, static_cast<double>(scene.info().width - 1)),
                           uniform(random, 0.0, static_cast<double>(scene.info().height - 1))});
    return samples;
}

enum class Morphing { as_chosen, none };

// The drawn surface's height over the eye.
std::optional<double> drawn_over_eye_m(const Scene& scene, const select::Selection& selection,
                                       select::Residency residency, const Sample& at,
                                       Morphing morphing = Morphing::as_chosen) {
    select::DrawEntry entry;
    if (!selection.entry_at(at.column, at.row, residency, entry)) return {};
    if (morphing == Morphing::none) entry.morph = {};
    const auto place = select::locate(scene.chunk(entry.index), entry, scene.grid(), at.column, at.row);
    REQUIRE(place.has_value());
    return select::drawn_height_m(scene.chunk(entry.index), selection.result().eye, entry, *place);
}

// How the surface moves at the samples while the eye does, in tolerated pixels from frame to frame.
struct Movement {
    double largest = 0.0;
    int jumps = 0;  // over a twentieth
};

void add_movement(const Scene& scene, select::Selection& selection, select::View view, Random& random,
                  Morphing morphing, Movement& movement) {
    constexpr int kFrames = 60;
    const auto residency = all_resident(scene);
    const auto samples = random_samples(scene, random, 40);
    const double heading = uniform(random, 0.0, 6.3);
    const glm::dvec3 step_m(3.0 * std::cos(heading), 3.0 * std::sin(heading), uniform(random, -0.5, 0.5));
    std::vector<std::optional<double>> last(samples.size());
    for (int frame = 0; frame < kFrames; ++frame, view.eye_m += step_m) {
        selection.run(view, residency);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const auto over_eye = drawn_over_eye_m(scene, selection, residency, samples[i], morphing);
            if (!over_eye) continue;
            const double height = *over_eye + view.eye_m.z;
            const glm::dvec2 away =
                scene.info().world(samples[i].column, samples[i].row) - glm::dvec2(view.eye_m);
            const double distance_m = std::max(glm::length(glm::dvec3(away, *over_eye)), 1.0);
            if (last[i]) {
                const double moved_px = std::abs(height - *last[i]) * view.projection_px / distance_m;
                movement.largest = std::max(movement.largest, moved_px / view.pixel_error_px);
                movement.jumps += moved_px > 0.05 * view.pixel_error_px;
            }
            last[i] = height;
        }
    }
}

void lift(select::View& view, double by_m) {
    view.eye_m.z += by_m;
    for (auto& plane : view.visible.planes) plane.offset -= plane.normal.z * by_m;
}

// The same view from a little over what is drawn there with everything resident, as far as the near plane
// reaches and half a metre more; none where the ground ends.
std::optional<select::View> close_to_ground(select::Selection& all, select::View view,
                                            select::Residency resident, const SceneGround& ground) {
    constexpr double kClearance_m = 0.7;
    view.near_reach_m = 0.2;
    // What is drawn depends on where the eye is; a second look is near enough.
    for (int i = 0; i < 2; ++i) {
        all.run(view, resident, &ground);
        const auto about = all.ground_about(resident, ground, -1e6);
        if (!about.complete) return {};
        lift(view, about.highest_m + kClearance_m);
    }
    return view;
}

// What a walk that begins here has loaded when it wants nothing else.
std::vector<io::NodeResidency> settled(const Scene& scene, select::Selection& selection,
                                       const select::View& view, const SceneGround& ground) {
    std::vector<io::NodeResidency> residency(scene.records().size());
    for (std::size_t i = 0; i < residency.size(); ++i)
        residency[i].resident = scene.grid().node_at(static_cast<std::int64_t>(i)).level == 0;
    for (bool again = true; again;) {
        const auto& result = selection.run(view, residency, &ground);
        again = result.unsettled;
        for (const auto& tile : result.wanted)
            if (tile.visible && !tile.resident) residency[tile.index].resident = again = true;
    }
    return residency;
}

}  // namespace

TEST_CASE("from frame to frame the surface moves vertically by no more than the pixel error") {
    Movement morphed, unmorphed;
    for (const SceneShape& shape : {SceneShape{600, 530, 32, 1}, SceneShape{390, 300, 32, 9, 0.0, 10},
                                    SceneShape{520, 515, 64, 6}, SceneShape{450, 390, 32, 7}}) {
        const Scene scene(shape);
        const auto criterion = select::make_criterion("screen_error").value();
        select::Selection selection(scene.info(), scene.records(), *criterion);
        Random random(shape.seed);
        for (int run = 0; run < 80; ++run) {
            const auto view = view_of_all(scene, random);
            const Random same = random;
            add_movement(scene, selection, view, random, Morphing::as_chosen, morphed);
            random = same;
            add_movement(scene, selection, view, random, Morphing::none, unmorphed);
        }
    }
    MESSAGE("largest ", morphed.largest, ", jumps ", morphed.jumps, "; unmorphed ", unmorphed.largest, ", ",
            unmorphed.jumps);
    CHECK(morphed.largest <= 1.0);
    CHECK(morphed.jumps * 2 < unmorphed.jumps);
}

TEST_CASE("the drawn height is the own surface near the eye and the parent's at the end of the range") {
    const Scene scene({390, 300, 32, 9, 0.0, 10});
    const auto criterion = select::make_criterion("screen_error").value();
    select::Selection selection(scene.info(), scene.records(), *criterion);
    Random random(1);
    auto view = view_of_all(scene, random);
    view.exaggeration = 1.0;
    for (const float fade : {0.0f, 1.0f}) {
        auto residency = all_resident(scene);
        view.pixel_error_px = 1e-6;  // the finest level everywhere, far inside its range
        for (auto& node : residency) node.fade = fade;
        selection.run(view, residency);
        const int level = scene.grid().finest() - (fade > 0.0f ? 1 : 0);
        double worst = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const std::int64_t x = whole(random, 0, 389), y = whole(random, 0, 299);
            const auto over_eye = drawn_over_eye_m(scene, selection, residency,
                                                   {static_cast<double>(x), static_cast<double>(y)});
            REQUIRE(over_eye.has_value());
            const double expected = scene.info().height_m(scene.surface(x, y, level));
            worst = std::max(worst, std::abs(*over_eye + view.eye_m.z - expected));
        }
        // Morph heights are rounded to the quantum, positions to floats.
        CHECK(worst <= 0.5 * scene.info().quantum_m + 0.01);
    }
}

TEST_CASE("what stands about the eye is bounded from above, whatever is missing or morphs") {
    const Scene scene({600, 530, 32, 1});
    const SceneGround ground(scene);
    const auto criterion = select::make_criterion("screen_error").value();
    select::Selection selection(scene.info(), scene.records(), *criterion);
    Random random(2);
    constexpr double kReach_m = 7.0, kFloor_m = -40.0;
    int above = 0, at_floor = 0;
    for (int i = 0; i < 400; ++i) {
        auto view = random_view(scene, random);
        view.near_reach_m = kReach_m;
        const glm::dvec2 place = scene.info().lattice(view.eye_m.x, view.eye_m.y);
        const auto residency = random_residency(scene, random);
        selection.run(view, residency);
        const auto about = selection.ground_about(residency, ground, kFloor_m);
        CHECK(about.highest_m >= kFloor_m);
        if (about.highest_m == kFloor_m) ++at_floor;
        const glm::dvec2 reach = kReach_m / glm::dvec2(scene.info().spacing_x_m, scene.info().spacing_y_m);
        for (int k = 0; k < 30; ++k) {
            const glm::dvec2 aside(uniform(random, -1.0, 1.0), uniform(random, -1.0, 1.0));
            const glm::dvec2 near = place + aside * reach;
            const auto over_eye = drawn_over_eye_m(scene, selection, residency, {near.x, near.y});
            if (!over_eye) continue;
            CHECK(*over_eye <= about.highest_m + 1e-3);
            above += *over_eye > kFloor_m ? 1 : 0;
        }
    }
    CHECK(above > 100);
    CHECK(at_floor > 20);
}

TEST_CASE("no stand-in lifts the eye: what is drawn about it is wanted, whatever was assumed to be hidden") {
    const auto criterion = select::make_criterion("screen_error").value();
    int close = 0, hidden = 0;
    for (const SceneShape& shape : {SceneShape{.width = 600, .height = 530, .seed = 1},
                                    SceneShape{.width = 450, .height = 390, .seed = 12, .relief = 1.5},
                                    SceneShape{.width = 450, .height = 390, .seed = 7, .relief = 2.0}}) {
        const Scene scene(shape);
        const SceneGround ground(scene);
        const auto resident = all_resident(scene);
        select::Selection walked(scene.info(), scene.records(), *criterion),
            all(scene.info(), scene.records(), *criterion);
        Random random(shape.seed);
        for (int i = 0; i < 400; ++i) {
            auto view = close_to_ground(all, random_view(scene, random), resident, ground);
            if (!view) continue;
            view->horizon = i % 4 == 0 ? select::HorizonMode::off : select::HorizonMode::ridges;
            const auto residency = settled(scene, walked, *view, ground);
            hidden += static_cast<int>(walked.result().counters.horizon_culled);
            // Assumes nothing.
            select::Selection fresh(scene.info(), scene.records(), *criterion);
            all.run(*view, resident, &ground);
            const double expected_m = all.ground_about(resident, ground, -1e6).highest_m;
            for (select::Selection* selection : {&walked, &fresh}) {
                selection->run(*view, residency, &ground);
                CHECK(selection->ground_about(residency, ground, -1e6).highest_m ==
                      doctest::Approx(expected_m));
            }
            ++close;
        }
    }
    CHECK(close > 600);
    CHECK(hidden > 10000);
}

}  // namespace ridgeline::test
