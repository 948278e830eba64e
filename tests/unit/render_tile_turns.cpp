// When a tile's errors begin to count: by and by where the picture before could show its ground, else at once.
#include <doctest/doctest.h>

#include <array>

#include "ridgeline/render/tile_turns.h"

using namespace ridgeline;
using namespace ridgeline::render;

namespace {

constexpr SlottedTile kTile{{1, 0, 0}, 3};

// Samples of a metre; the picture shows what lies west of a line.
TurningView west_of(double east_m) {
    TurningView view;
    view.terrain_m = {glm::dvec3(0.0), glm::dvec3(100.0)};
    view.visible.planes.fill({glm::dvec3(0.0), 1.0});
    view.visible.planes[0] = {glm::dvec3(-1.0, 0.0, 0.0), east_m};
    return view;
}

struct Pictures {
    TileTurns turns{io::Grid(65, 65, 32), 4};
    std::array<float, 4> height_fades{};
    std::uint32_t frame = 0;

    // The tile's rest, where this one is drawn.
    float next(std::span<const SlottedTile> tiles, double now_s, const TurningView& view) {
        return again(tiles, now_s, view, ++frame);
    }
    float again(std::span<const SlottedTile> tiles, double now_s, const TurningView& view,
                std::uint32_t number) {
        const TurningMoment moment{number, pager::Seconds(now_s), pager::Seconds(0.5)};
        return turns.turn(tiles, height_fades, moment, view)[kTile.slot];
    }
};

}  // namespace

TEST_CASE("ground is where the eye's frame has it: rows go southwards, spacings differ") {
    // Of 64 samples a side, 2 m and 3 m apart; the eye is at column 10.5 and row 20, 100 m east and 200 m north.
    TurningView view;
    view.eye.cell = {10, 20};
    view.eye.cell_rest = {0.5f, 0.0f};
    view.eye.spacing_m = {2.0f, 3.0f};
    view.eye_m = {100.0, 200.0, 30.0};
    view.terrain_m = {glm::dvec3(-1000.0, -1000.0, 0.0), glm::dvec3(1000.0, 1000.0, 50.0)};
    struct Look {
        glm::dvec3 normal;
        double offset;
        bool sees;
    };
    // The tile's 32 samples from the corner lie from 79 to 143 m east and from 164 to 260 m north.
    const Look looks[] = {{{-1, 0, 0}, 78.0, false},  {{-1, 0, 0}, 80.0, true},   {{1, 0, 0}, -142.0, true},
                          {{1, 0, 0}, -144.0, false}, {{0, -1, 0}, 163.0, false}, {{0, -1, 0}, 165.0, true},
                          {{0, 1, 0}, -259.0, true},  {{0, 1, 0}, -261.0, false}, {{0, 0, 1}, -51.0, false},
                          {{0, 0, 1}, -49.0, true}};
    for (const Look& look : looks) {
        CAPTURE(look.normal.x);
        CAPTURE(look.normal.y);
        CAPTURE(look.offset);
        view.visible.planes.fill({glm::dvec3(0.0), 1.0});
        view.visible.planes[0] = {look.normal, look.offset};
        Pictures pictures;
        pictures.next({}, 0.0, view);
        CHECK((pictures.next(std::array{kTile}, 1.0, view) == 1.0f) == look.sees);
    }
}

TEST_CASE("a tile turns where the picture before could show its ground, else it is there at once") {
    const std::array drawn{kTile};
    const auto all = west_of(1000.0), none = west_of(-1000.0);
    Pictures pictures;
    CHECK(pictures.next(drawn, 0.0, all) == 0.0f);  // there was no picture before
    CHECK(pictures.next({}, 1.0, all) == 0.0f);
    CHECK(pictures.next(drawn, 2.0, all) == 1.0f);
    CHECK(pictures.again(drawn, 2.0, all, pictures.frame) == 1.0f);
    CHECK(pictures.next(drawn, 2.125, all) == doctest::Approx(0.75f));
    pictures.height_fades[kTile.slot] = 0.875f;
    CHECK(pictures.next(drawn, 2.25, all) == 0.875f);
    pictures.height_fades[kTile.slot] = 0.0f;
    CHECK(pictures.next(drawn, 2.5, all) == 0.0f);
    CHECK(pictures.next({}, 3.0, none) == 0.0f);
    CHECK(pictures.next(drawn, 4.0, all) == 0.0f);  // from beside the picture
    pictures.next({}, 5.0, all);
    ++pictures.frame;  // of which nothing was drawn
    CHECK(pictures.next(drawn, 6.0, all) == 0.0f);
    CHECK(pictures.next({}, 6.1, all) == 0.0f);
    CHECK(pictures.next(drawn, 6.2, none) == 1.0f);
    CHECK(pictures.again(drawn, 6.2, all, pictures.frame) == 1.0f);  // another look of the same frame
    const std::array other{SlottedTile{{1, 1, 0}, kTile.slot}};
    CHECK(pictures.next(other, 7.0, all) == 1.0f);
}
