// Ground finer than the source: a tile's samples at twice their rate (synthesis paper, 3.1, 3.2).
//
// Literature: multifractal displacement by gradient noise (Perlin, "An image synthesizer", SIGGRAPH 1985) over a
// subdivided grid, as much of it as the ground's own slope and roughness allow. How we differ: samples that are there
// never move; new ones are interpolated from four (Dyn, Levin, Gregory, "A 4-point interpolatory subdivision scheme",
// 1987), which misses real ground by less than Catmull-Clark's rules do (docs/detail.md). All is integers, so that the
// GPU, the CPU and every neighbour find the same heights.
//
// An octave's noise is zero on the lattice of the samples that were there. Level ground stays level: between equal
// neighbours there is nothing to interpolate, and where a corner's surroundings are flat nothing is displaced.
#pragma once

#include "../shared/detail_octave.h"

// Where a parent's heights come from: in GLSL a function detail_height, in C++ an object with a function height.
#ifdef __cplusplus
#define DETAIL_FUNCTION     \
    template <class Parent> \
    inline
#define DETAIL_PARAMETER const Parent &parent,
#define DETAIL parent,
#define DETAIL_HEIGHT(at) parent.height(at)
#else
#define DETAIL_FUNCTION
#define DETAIL_PARAMETER
#define DETAIL
#define DETAIL_HEIGHT(at) detail_height(at)
#endif

SHADER_BEGIN

// Noise of unit variance in fixed point, as a shift.
SHADER_CONSTANT int kDetailNoiseShift = 10;
// Slopes and roughness beyond it count as this: products stay within 32 bits.
SHADER_CONSTANT int kMostDetailControl = 262144;

// --- subdivision

// Between b and c, of four samples in a row.
SHADER_FUNCTION int four_point(int a, int b, int c, int d) {
    return b == c ? b : b + ((9 * (c - b) - (a - b) - (d - b) + 8) >> 4);
}

DETAIL_FUNCTION int between_columns(DETAIL_PARAMETER ivec2 at) {
    return four_point(DETAIL_HEIGHT(ivec2(at.x - 1, at.y)), DETAIL_HEIGHT(at),
                      DETAIL_HEIGHT(ivec2(at.x + 1, at.y)), DETAIL_HEIGHT(ivec2(at.x + 2, at.y)));
}
DETAIL_FUNCTION int between_rows(DETAIL_PARAMETER ivec2 at) {
    return four_point(DETAIL_HEIGHT(ivec2(at.x, at.y - 1)), DETAIL_HEIGHT(at),
                      DETAIL_HEIGHT(ivec2(at.x, at.y + 1)), DETAIL_HEIGHT(ivec2(at.x, at.y + 2)));
}
DETAIL_FUNCTION int amid_four(DETAIL_PARAMETER ivec2 at) {
    return four_point(between_columns(DETAIL ivec2(at.x, at.y - 1)), between_columns(DETAIL at),
                      between_columns(DETAIL ivec2(at.x, at.y + 1)),
                      between_columns(DETAIL ivec2(at.x, at.y + 2)));
}

// --- noise

// One of sixteen directions, of length 1 in kDetailNoiseShift.
SHADER_FUNCTION ivec2 detail_gradient(ivec2 node, int octave) {
    uint hash = uint(node.x) * 0x9e3779b1u + uint(node.y) * 0x85ebca77u + uint(octave) * 0xc2b2ae3du;
    hash = (hash ^ (hash >> 15u)) * 0x2c1b3c6du;
    hash = (hash ^ (hash >> 12u)) * 0x297a2d39u;
    hash = hash ^ (hash >> 15u);
    // 11.25, 33.75, 56.25 and 78.75 degrees, and quarters of a turn on.
    uint step = (hash >> 28u) & 3u, quarter = hash >> 30u;
    int across = step == 0u ? 1004 : step == 1u ? 851 : step == 2u ? 569 : 200;
    int up = step == 0u ? 200 : step == 1u ? 569 : step == 2u ? 851 : 1004;
    ivec2 turned = (quarter & 1u) == 0u ? ivec2(across, up) : ivec2(-up, across);
    return (quarter & 2u) == 0u ? turned : ivec2(-turned.x, -turned.y);
}

// Gradient noise half-way between nodes, scaled to a variance of 1.
SHADER_FUNCTION int noise_between_columns(ivec2 node, int octave) {
    return detail_gradient(node, octave).x - detail_gradient(ivec2(node.x + 1, node.y), octave).x;
}
SHADER_FUNCTION int noise_between_rows(ivec2 node, int octave) {
    return detail_gradient(node, octave).y - detail_gradient(ivec2(node.x, node.y + 1), octave).y;
}
SHADER_FUNCTION int noise_amid_four(ivec2 node, int octave) {
    ivec2 nw = detail_gradient(node, octave);
    ivec2 ne = detail_gradient(ivec2(node.x + 1, node.y), octave);
    ivec2 sw = detail_gradient(ivec2(node.x, node.y + 1), octave);
    ivec2 se = detail_gradient(ivec2(node.x + 1, node.y + 1), octave);
    return (nw.x + nw.y - ne.x + ne.y + sw.x - sw.y - se.x - se.y) >> 1;
}

// --- what the ground allows

// Of a parent's sample, in its heights' units: the slope over a spacing, and how much its neighbours bend.
struct DetailControl {
    int slope, roughness;
};

DETAIL_FUNCTION DetailControl detail_control(DETAIL_PARAMETER ivec2 at) {
    int own = DETAIL_HEIGHT(at);
    int west = DETAIL_HEIGHT(ivec2(at.x - 1, at.y)), east = DETAIL_HEIGHT(ivec2(at.x + 1, at.y));
    int north = DETAIL_HEIGHT(ivec2(at.x, at.y - 1)), south = DETAIL_HEIGHT(ivec2(at.x, at.y + 1));
    int along_x = abs(east - west), along_y = abs(south - north);
    // The larger and half the smaller one: a length without a root.
    int slope = (2 * max(along_x, along_y) + min(along_x, along_y)) / 4;
    int roughness = abs(east - own + west - own) + abs(south - own + north - own);
    DetailControl control;
    control.slope = min(slope, kMostDetailControl);
    control.roughness = min(roughness, kMostDetailControl);
    return control;
}

SHADER_FUNCTION bool is_flat(DetailControl control) { return control.slope == 0 && control.roughness == 0; }

// The mean of two; nothing where one of them is flat.
SHADER_FUNCTION DetailControl mean_control(DetailControl a, DetailControl b) {
    bool level = is_flat(a) || is_flat(b);
    DetailControl mean;
    mean.slope = level ? 0 : (a.slope + b.slope) / 2;
    mean.roughness = level ? 0 : (a.roughness + b.roughness) / 2;
    return mean;
}

DETAIL_FUNCTION DetailControl control_between_columns(DETAIL_PARAMETER ivec2 at) {
    return mean_control(detail_control(DETAIL at), detail_control(DETAIL ivec2(at.x + 1, at.y)));
}
DETAIL_FUNCTION DetailControl control_between_rows(DETAIL_PARAMETER ivec2 at) {
    return mean_control(detail_control(DETAIL at), detail_control(DETAIL ivec2(at.x, at.y + 1)));
}
DETAIL_FUNCTION DetailControl control_amid_four(DETAIL_PARAMETER ivec2 at) {
    return mean_control(control_between_columns(DETAIL at),
                        control_between_columns(DETAIL ivec2(at.x, at.y + 1)));
}

// --- a sample of the child

SHADER_FUNCTION int displacement(int noise, DetailControl control, int slope_gain, int roughness_gain) {
    int high =
        (slope_gain * control.slope) / kDetailGainOne + (roughness_gain * control.roughness) / kDetailGainOne;
    // Shifted, not divided: what division makes of negative numbers is the compiler's choice.
    return (noise * min(high, kMostDetailControl)) >> kDetailNoiseShift;
}

// child: column and row at twice the parent's rate, from the parent's first sample. first: that sample's place on its
// level's lattice. octave: counts from 1 at the source's own samples.
DETAIL_FUNCTION int detail_sample(DETAIL_PARAMETER ivec2 child, ivec2 first, int octave, DetailOctave gains) {
    ivec2 at = ivec2(child.x >> 1, child.y >> 1);
    ivec2 node = ivec2(first.x + at.x, first.y + at.y);
    bool odd_column = (child.x & 1) != 0, odd_row = (child.y & 1) != 0;
    if (odd_column && odd_row)
        return amid_four(DETAIL at) + displacement(noise_amid_four(node, octave),
                                                   control_amid_four(DETAIL at), gains.face_slope,
                                                   gains.face_roughness);
    if (odd_column)
        return between_columns(DETAIL at) + displacement(noise_between_columns(node, octave),
                                                         control_between_columns(DETAIL at), gains.edge_slope,
                                                         gains.edge_roughness);
    if (odd_row)
        return between_rows(DETAIL at) + displacement(noise_between_rows(node, octave),
                                                      control_between_rows(DETAIL at), gains.edge_slope,
                                                      gains.edge_roughness);
    return DETAIL_HEIGHT(at);
}

SHADER_END
