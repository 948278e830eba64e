// K. Perlin, "Improving noise" (2002), for the quintic fade; gradients are any vector of a square, hashed by
// C. Wellons's lowbias32 (nullprogram.com, "Prospecting for hash functions").
#include "noise.h"

#include <algorithm>
#include <cmath>

namespace ridgeline::synth {
namespace {

float fade(float t) { return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f); }

float gradient_dot(std::int32_t x, std::int32_t y, std::uint32_t seed, float dx, float dy) {
    const std::uint32_t h = hash(x, y, seed);
    const float gx = static_cast<float>(h & 0xffffu) * (2.0f / 65535.0f) - 1.0f;
    const float gy = static_cast<float>(h >> 16) * (2.0f / 65535.0f) - 1.0f;
    return gx * dx + gy * dy;
}

}  // namespace

std::uint32_t hash(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ x >> 16;
}

std::uint32_t hash(std::int32_t x, std::int32_t y, std::uint32_t seed) {
    return hash(static_cast<std::uint32_t>(x) * 0x9e3779b1u ^
                hash(static_cast<std::uint32_t>(y) * 0x85ebca77u ^ seed));
}

float unit_interval(std::uint32_t hash) { return static_cast<float>(hash >> 8) * 0x1p-24f; }

float gradient_noise(float x, float y, std::uint32_t seed) {
    const float floor_x = std::floor(x);
    const float floor_y = std::floor(y);
    const auto ix = static_cast<std::int32_t>(floor_x);
    const auto iy = static_cast<std::int32_t>(floor_y);
    const float dx = x - floor_x;
    const float dy = y - floor_y;
    const float north =
        std::lerp(gradient_dot(ix, iy, seed, dx, dy), gradient_dot(ix + 1, iy, seed, dx - 1, dy), fade(dx));
    const float south = std::lerp(gradient_dot(ix, iy + 1, seed, dx, dy - 1),
                                  gradient_dot(ix + 1, iy + 1, seed, dx - 1, dy - 1), fade(dx));
    constexpr float kToUnit = 1.6f;  // the corner mix of such gradients rarely passes 0.6
    return kToUnit * std::lerp(north, south, fade(dy));
}

float fractal_noise(float x, float y, std::uint32_t seed, int octaves) {
    float sum = 0.0f;
    float amplitude = 1.0f;
    float amplitudes = 0.0f;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += amplitude * gradient_noise(x, y, seed + static_cast<std::uint32_t>(octave));
        amplitudes += amplitude;
        amplitude *= 0.5f;
        // Not exactly twice, and moved: octaves must not share their zeros.
        x = x * 2.03f + 17.3f;
        y = y * 2.03f - 9.1f;
    }
    return sum / amplitudes;
}

float smooth_step(float from, float to, float x) {
    const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

}  // namespace ridgeline::synth
