// Hashes and gradient noise: the same numbers on every machine and thread, from integer coordinates and a
// seed.
#pragma once

#include <cstdint>

namespace ridgeline::synth {

std::uint32_t hash(std::uint32_t x);
std::uint32_t hash(std::int32_t x, std::int32_t y, std::uint32_t seed);
// In [0, 1).
float unit_interval(std::uint32_t hash);

// Gradient noise of wavelength 1, zero on the integer lattice, within about ±1.
float gradient_noise(float x, float y, std::uint32_t seed);
// Octaves of it, each of half the wavelength and amplitude of the one before, within about ±1.
float fractal_noise(float x, float y, std::uint32_t seed, int octaves);

// 0 below `from`, 1 above `to`, smooth between.
float smooth_step(float from, float to, float x);

}  // namespace ridgeline::synth
