#include "ridgeline/shaders/lib/fullscreen.h"

#include <doctest/doctest.h>

#include <initializer_list>

namespace ridgeline::shaders {
namespace {

TEST_CASE("the triangle winds counter-clockwise and holds the whole screen") {
    const vec2 a = fullscreen_corner(0);
    const vec2 b = fullscreen_corner(1);
    const vec2 c = fullscreen_corner(2);
    const auto side = [](vec2 from, vec2 to, vec2 p) {
        return (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
    };
    CHECK(side(a, b, c) > 0.0f);
    for (const vec2 corner : {vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(1, 1)}) {
        CHECK(side(a, b, corner) >= 0.0f);
        CHECK(side(b, c, corner) >= 0.0f);
        CHECK(side(c, a, corner) >= 0.0f);
    }
}

}  // namespace
}  // namespace ridgeline::shaders
