// Fractal value noise (K. Perlin, "An Image Synthesizer", SIGGRAPH 1985, with values instead of gradients),
// wrapped at the texture's size.
#include "ridgeline/render/ground_noise.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace ridgeline::render {
namespace {

constexpr int kSize_px = 256;
// The coarsest octave has this many lattice points a side; below 8, repeats show.
constexpr int kCoarsestLattice = 8;
constexpr int kOctaves = 5;
// Amplitude from octave to octave: rougher than terrain (0.5), as patches of soil and plants are.
constexpr float kPersistence = 0.62f;

// A finaliser of MurmurHash3's kind; all that is asked of it is that neighbours look unrelated.
float hash_value(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
    std::uint32_t h = x * 0x8da6b343u ^ y * 0xd8163841u ^ seed * 0xcb1ab31fu;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return static_cast<float>((h ^ (h >> 15)) >> 8) * 0x1p-24f;
}

float smooth(float t) { return t * t * (3.0f - 2.0f * t); }

float octave(float x, float y, std::uint32_t lattice, std::uint32_t seed) {
    const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y);
    const float u = smooth(x - static_cast<float>(column)), v = smooth(y - static_cast<float>(row));
    const std::uint32_t east = (column + 1) % lattice, south = (row + 1) % lattice;
    const float north_value = std::lerp(hash_value(column, row, seed), hash_value(east, row, seed), u);
    const float south_value = std::lerp(hash_value(column, south, seed), hash_value(east, south, seed), u);
    return std::lerp(north_value, south_value, v);
}

float fractal(int x, int y, int size_px, std::uint32_t seed) {
    float sum = 0.0f, weights = 0.0f, amplitude = 1.0f;
    for (int i = 0; i < kOctaves; ++i) {
        const int lattice = kCoarsestLattice << i;
        const float scale = static_cast<float>(lattice) / static_cast<float>(size_px);
        sum += amplitude * octave(static_cast<float>(x) * scale, static_cast<float>(y) * scale,
                                  static_cast<std::uint32_t>(lattice), seed + static_cast<std::uint32_t>(i));
        weights += amplitude;
        amplitude *= kPersistence;
    }
    return sum / weights;
}

// Value noise keeps to the middle: spread it over the range.
float spread(float value) { return std::clamp(0.5f + 1.6f * (value - 0.5f), 0.0f, 1.0f); }

std::uint8_t eight_bits(float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
}

// Central differences; a texel's step of a quarter of the range is as steep as it gets.
std::uint8_t slope(float before, float after) { return eight_bits(0.5f + 2.0f * (after - before)); }

}  // namespace

std::vector<NoiseTexel> ground_noise(int size_px, std::uint32_t seed) {
    const auto side = static_cast<std::size_t>(size_px);
    std::vector<float> values;
    values.reserve(side * side);
    for (int y = 0; y < size_px; ++y)
        for (int x = 0; x < size_px; ++x) values.push_back(spread(fractal(x, y, size_px, seed)));
    std::vector<NoiseTexel> texels(side * side);
    for (std::size_t y = 0; y < side; ++y)
        for (std::size_t x = 0; x < side; ++x) {
            const std::size_t west = (x + side - 1) % side, east = (x + 1) % side;
            const std::size_t south = (y + side - 1) % side, north = (y + 1) % side;
            texels[y * side + x] = {eight_bits(values[y * side + x]),
                                    slope(values[y * side + west], values[y * side + east]),
                                    slope(values[south * side + x], values[north * side + x])};
        }
    return texels;
}

Result<gl::Texture2D> create_ground_noise() {
    const int levels = static_cast<int>(std::log2(kSize_px)) + 1;
    auto texture = gl::Texture2D::create(
        {.format = GL_RGBA8, .size_px = {kSize_px, kSize_px}, .levels = levels, .label = "ground noise"});
    if (!texture) return texture.error();
    const auto texels = ground_noise(kSize_px, 1);
    texture->upload({.size_px = {kSize_px, kSize_px}}, {GL_RGBA, GL_UNSIGNED_BYTE},
                    std::as_bytes(std::span(texels)));
    texture->generate_mipmaps();
    return texture;
}

}  // namespace ridgeline::render
