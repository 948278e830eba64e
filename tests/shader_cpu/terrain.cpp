// The terrain's shader functions, run on the CPU: the very text that the GPU runs.
#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <random>

#include "ridgeline/select/drawn_surface.h"
#include "ridgeline/shaders/lib/atmosphere.h"
#include "ridgeline/shaders/lib/display.h"
#include "ridgeline/shaders/lib/morph.h"
#include "ridgeline/shaders/lib/normals.h"
#include "ridgeline/shaders/lib/tint.h"
#include "ridgeline/shaders/lib/validity.h"

using namespace ridgeline;
using namespace ridgeline::shaders;

namespace {

float uniform(std::mt19937& random, float least, float most) {
    return std::uniform_real_distribution<float>(least, most)(random);
}

vec3 random_direction(std::mt19937& random) {
    while (true) {
        const vec3 v(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
        if (dot(v, v) > 0.01f && dot(v, v) <= 1.0f) return normalize(v);
    }
}

}  // namespace

TEST_CASE("The vertex shader puts a vertex where selection believes it, bit for bit") {
    std::mt19937 random(1);
    for (int i = 0; i < 20000; ++i) {
        select::EyeFrame eye;
        eye.cell_rest = {uniform(random, 0, 1), uniform(random, 0, 1)};
        eye.quanta = static_cast<int>(random() % 9000);
        eye.quanta_rest = uniform(random, 0, 1);
        eye.spacing_m = {uniform(random, 0.5f, 40), uniform(random, 0.5f, 40)};
        eye.quantum_m = uniform(random, 0.01f, 3);
        const glm::ivec2 origin(static_cast<int>(random() % 20000) - 10000,
                                static_cast<int>(random() % 20000) - 10000);
        io::ChunkVertex vertex;
        const std::uint32_t vertex_class = random() % io::vertex_class::kCount;
        vertex.x_and_class = vertex_class << 24 | random() % 4096;
        vertex.y = random() % 4096;
        vertex.quanta = static_cast<int>(random() % 9000);
        vertex.delta = static_cast<int>(random() % 200) - 100;
        select::MorphTable table{};
        table[vertex_class] = {uniform(random, 0, 1e-3f), uniform(random, -1, 1), uniform(random, 0, 0.3f)};
        const select::DrawnVertex expected = select::drawn_vertex(eye, origin, table, vertex);

        // As passes/terrain.vert.
        const ivec2 lattice = origin + ivec2(static_cast<int>(vertex.x()), static_cast<int>(vertex.y));
        const vec4 rest(eye.cell_rest, eye.quanta_rest, 0.0f), scale(eye.spacing_m, eye.quantum_m, 1.0f);
        const int quanta = vertex.quanta - eye.quanta;
        const vec3 own = position_from_eye(lattice, static_cast<float>(quanta), rest, scale);
        const MorphEntry entry{table[vertex_class].scale, table[vertex_class].bias, table[vertex_class].fade};
        const float weight = morph_weight(entry, distance_from_eye(own));
        const vec3 drawn =
            position_from_eye(lattice, morphed_quanta(quanta, vertex.delta, weight), rest, scale);
        REQUIRE(std::bit_cast<std::uint32_t>(weight) == std::bit_cast<std::uint32_t>(expected.omega));
        REQUIRE(drawn == expected.position_m);
    }
}

TEST_CASE("A fully morphed vertex is exactly the parent's whole quanta") {
    std::mt19937 random(2);
    for (int i = 0; i < 1000; ++i) {
        const int quanta = static_cast<int>(random() % (1 << 22)) - (1 << 21);
        const int delta = static_cast<int>(random() % (1 << 20)) - (1 << 19);
        CHECK(morphed_quanta(quanta, delta, 1.0f) == static_cast<float>(quanta + delta));
        CHECK(morphed_quanta(quanta, delta, 0.0f) == static_cast<float>(quanta));
    }
}

TEST_CASE("Cells and mask bits are those of the chunk") {
    constexpr int kQuads = 32;
    CHECK(cell_at(vec2(0.0f, 0.0f), kQuads) == 0);
    CHECK(cell_at(vec2(31.99f, 0.5f), kQuads) == 31);
    CHECK(cell_at(vec2(0.5f, 1.0f), kQuads) == kQuads);
    // The far borders belong to the last cells.
    CHECK(cell_at(vec2(32.0f, 32.0f), kQuads) == kQuads * kQuads - 1);
    CHECK(cell_at(vec2(-0.01f, -0.01f), kQuads) == 0);
    for (int cell = 0; cell < 64; ++cell)
        for (int bit = 0; bit < 32; ++bit) CHECK(cell_bit(1u << bit, cell) == (cell % 32 == bit));
}

TEST_CASE("Normals are read at the lattice lines, own and parent's at the same places") {
    constexpr int kQuads = 64;
    const uint place = 3u << 16 | 2u << 8 | 1u;
    const NormalTexels corner = normal_texels(place, vec2(0.0f, 0.0f), kQuads);
    CHECK(corner.north_west == ivec3(65, 130, 3));
    CHECK(corner.share == vec2(0.0f, 0.0f));
    // The last line is reached as the far end of the last cell: the filter never leaves the square.
    const NormalTexels far = normal_texels(place, vec2(64.0f, 64.0f), kQuads);
    CHECK(far.north_west == ivec3(65 + 63, 130 + 63, 3));
    CHECK(far.share == vec2(1.0f, 1.0f));
    // Corners of a child lie on lines of the parent.
    for (uint quarter = 0; quarter < 4; ++quarter) {
        const vec2 north_west = parent_texel(vec2(0.0f), quarter, kQuads);
        CHECK(north_west == vec2((quarter & 1u) != 0 ? 32.0f : 0.0f, (quarter & 2u) != 0 ? 32.0f : 0.0f));
        CHECK(parent_texel(vec2(64.0f), quarter, kQuads) == north_west + 32.0f);
    }
    std::mt19937 random(3);
    for (int i = 0; i < 1000; ++i) {
        const vec3 normal = random_direction(random);
        const vec3 unpacked = unpack_normal(vec2(normal.x, normal.y));
        CHECK(length(unpacked) == doctest::Approx(1.0f).epsilon(1e-5));
        CHECK(unpacked.z == doctest::Approx(std::abs(normal.z)).epsilon(1e-3));
    }
}

TEST_CASE("No colour that is shown is the background's, and each is a whole step") {
    std::mt19937 random(4);
    for (int i = 0; i < 200000; ++i) {
        const vec3 radiance(uniform(random, 0, 1.2f), uniform(random, 0, 1.2f), uniform(random, 0, 1.2f));
        const vec2 pixel(uniform(random, 0, 2000), uniform(random, 0, 2000));
        const vec4 free = display_color(radiance, pixel, vec4(0.0f));
        const vec4 steps = round(free * 255.0f);
        REQUIRE(abs(steps.x - free.x * 255.0f) < 1e-3f);
        // The very colour that would be shown is the background now.
        const vec4 shown =
            round(display_color(radiance, pixel, vec4(steps.x, steps.y, steps.z, 1.0f)) * 255.0f);
        REQUIRE(vec3(shown) != vec3(steps));
        REQUIRE(abs(shown.y - steps.y) == 1.0f);
        REQUIRE((shown.y >= 0.0f && shown.y <= 255.0f));
    }
}

TEST_CASE("The tone curve rises and keeps within the screen's range") {
    float before = -1.0f;
    for (int i = 0; i <= 4000; ++i) {
        const float x = static_cast<float>(i) * 0.01f;
        const float mapped = tone_map(vec3(x)).x;
        CHECK(mapped >= before);
        CHECK(mapped <= 1.0f);
        before = mapped;
    }
}

TEST_CASE("Ground fades into the sky behind it, near ground is clear, and rising rays meet thinner air") {
    std::mt19937 random(5);
    for (int i = 0; i < 2000; ++i) {
        const float rise = uniform(random, -3000, 3000), eye_m = uniform(random, 0, 6000);
        const vec3 far = transmittance(3.0e7f, rise, eye_m, 1.0f);
        CHECK(far.x < 0.01f);
        const vec3 near = transmittance(10.0f, 0.0f, eye_m, 1.0f);
        CHECK(near.z > 0.999f);
        CHECK(transmittance(5.0e4f, 0.0f, eye_m, 0.0f) == vec3(1.0f));
        // Red comes further than blue.
        const vec3 middle = transmittance(4.0e4f, rise, eye_m, 1.0f);
        CHECK(middle.x > middle.z);
        CHECK(transmittance(4.0e4f, rise + 500.0f, eye_m, 1.0f).y > middle.y);
    }
}

TEST_CASE("The sky has no seam: near directions, near colours, the horizon included") {
    std::mt19937 random(6);
    const vec3 sun = normalize(vec3(-0.5f, 0.5f, 0.6f));
    for (int i = 0; i < 20000; ++i) {
        vec3 direction = random_direction(random);
        if (i % 2 == 0) direction = normalize(vec3(direction.x, direction.y, 1e-4f * direction.z));
        const vec3 beside = normalize(direction + 1e-3f * random_direction(random));
        const vec3 difference = abs(sky_radiance(direction, sun) - sky_radiance(beside, sun));
        CHECK(max(difference.x, max(difference.y, difference.z)) < 0.01f);
    }
}

TEST_CASE("The ground's colours are reflectances that exist, and change without a jump") {
    std::mt19937 random(7);
    const vec3 range(0.0f, 3900.0f, 0.0f);
    for (int i = 0; i < 50000; ++i) {
        const float height_m = uniform(random, -50, 4200), up = uniform(random, 0.2f, 1.0f);
        const vec2 noise(uniform(random, 0, 1), uniform(random, 0, 1));
        const vec3 color = ground_color(height_m, up, noise, range);
        REQUIRE(min(color.x, min(color.y, color.z)) >= 0.0f);
        REQUIRE(max(color.x, max(color.y, color.z)) <= 0.95f);
        if (height_m < 1.0f) continue;
        const vec3 difference = abs(ground_color(height_m + 1.0f, up, noise, range) - color);
        REQUIRE(max(difference.x, max(difference.y, difference.z)) < 0.02f);
    }
    // Level and no higher than the sea: water. As level, but higher: none.
    const vec2 even(0.5f, 0.5f);
    CHECK(ground_color(0.0f, 1.0f, even, range).z > ground_color(0.0f, 1.0f, even, range).x);
    CHECK(water_share(5.0f, 0.0f, 1.0f) == 0.0f);
    CHECK(snow_share(0.99f, 1.0f, 0.5f) == 1.0f);
    CHECK(snow_share(0.99f, 0.4f, 0.5f) == 0.0f);
}
