// A block of 4 × 4 texels as BC1: two colours of 5, 6 and 5 bits, and per texel how much of each.
//
// Literature: the format is the Khronos Data Format Specification's (18.1, 18.2). Fitting the endpoints along
// the principal axis of the colours and refining them by least squares for the weights that the texels took
// is the way of squish (S. Brown, "DXT compression techniques", 2006) and of F. Giesen's stb_dxt; J.M.P. van
// Waveren, "Real-Time DXT Compression" (2006), has it in parallel. How we differ: everything but the axis is
// a whole number, so that a GPU gives what the CPU gives; the error of a fit comes from the same sums as the
// refined endpoints, without a second look at the texels; and blocks of nearly one colour are held against
// the best single colour that the format has between its endpoints, in both of its modes.
//
// Whole numbers live in floats where they stay below 2^24, and are exact there, in whatever order they are
// added.
#pragma once
#include "../shared/bc1_blocks.h"
#include "../shared/portable.h"

SHADER_BEGIN

// In how many steps one endpoint becomes the other: three with four colours; two where a texel may be
// transparent.
SHADER_CONSTANT int kBc1FourColors = 3;
SHADER_CONSTANT int kBc1ThreeColors = 2;

// Weights are refined so often at most; a round that gains nothing ends it.
SHADER_CONSTANT int kBc1Rounds = 3;

// Of all channels, how far apart colours lie at most for a single one in their place to be worth a try.
SHADER_CONSTANT float kBc1Flat = 4.0f;

// The opaque texels' colours, 0 to 255, and what is summed over them once.
struct Bc1Colors {
    vec3 color[16];
    uint opaque;  // a bit a texel
    int count;    // of the opaque ones
    vec3 sum, least, most;
    int squares;  // of all channels
};

struct Bc1Fit {
    ivec3 high, low;  // endpoints in 5, 6 and 5 bits
    int steps;
    uint weights;  // two bits a texel: how many of the steps towards `high`
    int error;     // squared, over the opaque texels, times steps²
};

// Over the opaque texels, w being a texel's weight and v = steps − w.
struct Bc1Sums {
    int ww, wv, vv;
    vec3 wc, vc;  // of weighted colours
};

SHADER_FUNCTION float bc1_dot(vec3 a, vec3 b) {
    SHADER_PRECISE float sum = a.x * b.x + a.y * b.y + a.z * b.z;
    return sum;
}

SHADER_FUNCTION vec3 bc1_texel(uint texel) {
    return vec3(float(texel & 255u), float(texel >> 8u & 255u), float(texel >> 16u & 255u));
}

SHADER_FUNCTION Bc1Colors bc1_colors(Bc1Texels texels) {
    Bc1Colors colors;
    colors.opaque = 0u;
    colors.count = 0;
    colors.sum = vec3(0.0f);
    colors.least = vec3(255.0f);
    colors.most = vec3(0.0f);
    float squares = 0.0f;
    for (int i = 0; i < 16; ++i) {
        uint texel = texels.rows[i >> 2][i & 3];
        vec3 c = bc1_texel(texel);
        colors.color[i] = c;
        if (texel >> 24u == 0u) continue;
        colors.opaque |= 1u << uint(i);
        ++colors.count;
        colors.sum = colors.sum + c;
        colors.least = min(colors.least, c);
        colors.most = max(colors.most, c);
        squares += bc1_dot(c, c);
    }
    colors.squares = int(squares);
    return colors;
}

// Quantised channels as the hardware widens them: high bits repeat below.
SHADER_FUNCTION int bc1_widened(int quantum, int bits) {
    return quantum << (8 - bits) | quantum >> (2 * bits - 8);
}
SHADER_FUNCTION vec3 bc1_widened(ivec3 quanta) {
    return vec3(float(bc1_widened(quanta.x, 5)), float(bc1_widened(quanta.y, 6)),
                float(bc1_widened(quanta.z, 5)));
}

SHADER_FUNCTION ivec3 bc1_quantized(vec3 color) {
    vec3 limited = clamp(color, vec3(0.0f), vec3(255.0f));
    return ivec3(floor(limited * vec3(31.0f / 255.0f, 63.0f / 255.0f, 31.0f / 255.0f) + vec3(0.5f)));
}

// --- from endpoints to weights and error

SHADER_FUNCTION int bc1_error(Bc1Colors colors, Bc1Sums sums, Bc1Fit fit) {
    vec3 high = bc1_widened(fit.high), low = bc1_widened(fit.low);
    int s = fit.steps;
    int ends = sums.ww * int(bc1_dot(high, high)) + sums.vv * int(bc1_dot(low, low)) +
               2 * sums.wv * int(bc1_dot(high, low));
    int mixed = int(bc1_dot(sums.wc, high)) + int(bc1_dot(sums.vc, low));
    return s * s * colors.squares + ends - 2 * s * mixed;
}

// Gives every texel the nearest colour between the endpoints, and says what that makes.
SHADER_FUNCTION Bc1Sums bc1_weigh(Bc1Colors colors, SHADER_INOUT(Bc1Fit) fit) {
    vec3 low = bc1_widened(fit.low), way = bc1_widened(fit.high) - low;
    // Halfway to the first colour past `low`; to each further one it is twice as far again.
    float half_step = bc1_dot(way, way);
    float steps = float(fit.steps);
    vec3 scaled = way * (2.0f * steps);
    float start = bc1_dot(low, scaled);
    float most = steps;
    float ww = 0.0f, w1 = 0.0f;
    Bc1Sums sums;
    sums.wc = vec3(0.0f);
    fit.weights = 0u;
    for (int i = 0; i < 16; ++i) {
        if ((colors.opaque >> uint(i) & 1u) == 0u) continue;
        vec3 c = colors.color[i];
        float past = bc1_dot(c, scaled) - start;
        float w = (past > half_step ? 1.0f : 0.0f) + (past > 3.0f * half_step ? 1.0f : 0.0f) +
                  (past > 5.0f * half_step ? 1.0f : 0.0f);
        w = min(w, most);
        ww += w * w;
        w1 += w;
        sums.wc = sums.wc + c * w;
        fit.weights |= uint(w) << uint(2 * i);
    }
    sums.ww = int(ww);
    sums.wv = fit.steps * int(w1) - sums.ww;
    sums.vv = fit.steps * fit.steps * colors.count - 2 * sums.wv - sums.ww;
    sums.vc = colors.sum * steps - sums.wc;
    fit.error = bc1_error(colors, sums, fit);
    return sums;
}

// The endpoints with the least error for those weights; false where they all are the same.
SHADER_FUNCTION bool bc1_refine(Bc1Sums sums, SHADER_INOUT(Bc1Fit) fit) {
    int determinant = sums.ww * sums.vv - sums.wv * sums.wv;
    if (determinant == 0) return false;
    float scale = float(fit.steps) / float(determinant);
    fit.high = bc1_quantized((sums.wc * float(sums.vv) - sums.vc * float(sums.wv)) * scale);
    fit.low = bc1_quantized((sums.vc * float(sums.ww) - sums.wc * float(sums.wv)) * scale);
    return true;
}

// --- where to begin

// The power of two that brings a positive number to [1, 2).
SHADER_FUNCTION float bc1_scale(float positive) {
    return uintBitsToFloat((254u << 23u) - (floatBitsToUint(positive) & 0x7f800000u));
}

struct Bc1Moments {
    vec3 squares;  // xx, yy, zz
    vec3 mixed;    // xy, xz, yz
};

// Of second order about the mean, times the count squared.
SHADER_FUNCTION Bc1Moments bc1_moments(Bc1Colors colors) {
    Bc1Moments m;
    m.squares = vec3(0.0f);
    m.mixed = vec3(0.0f);
    for (int i = 0; i < 16; ++i) {
        if ((colors.opaque >> uint(i) & 1u) == 0u) continue;
        vec3 c = colors.color[i];
        m.squares = m.squares + c * c;
        m.mixed = m.mixed + vec3(c.x * c.y, c.x * c.z, c.y * c.z);
    }
    float n = float(colors.count);
    vec3 s = colors.sum;
    m.squares = m.squares * n - s * s;
    m.mixed = m.mixed * n - vec3(s.x * s.y, s.x * s.z, s.y * s.z);
    return m;
}

SHADER_FUNCTION vec3 bc1_times(Bc1Moments m, vec3 v) {
    return vec3(bc1_dot(vec3(m.squares.x, m.mixed.x, m.mixed.y), v),
                bc1_dot(vec3(m.mixed.x, m.squares.y, m.mixed.z), v),
                bc1_dot(vec3(m.mixed.y, m.mixed.z, m.squares.z), v));
}

// By power iteration from the axis of the channel that varies most, which the principal one is never far
// from. With the trace in [1, 2) the greatest eigenvalue is above 1/3: eight rounds stay far from where
// floats end.
SHADER_FUNCTION vec3 bc1_principal_axis(Bc1Moments m) {
    float trace = m.squares.x + m.squares.y + m.squares.z;
    float scale = bc1_scale(trace);
    m.squares = m.squares * scale;
    m.mixed = m.mixed * scale;
    vec3 axis = vec3(0.0f, 1.0f, 0.0f);
    if (m.squares.x > m.squares.y && m.squares.x >= m.squares.z) axis = vec3(1.0f, 0.0f, 0.0f);
    if (m.squares.z > m.squares.y && m.squares.z > m.squares.x) axis = vec3(0.0f, 0.0f, 1.0f);
    for (int i = 0; i < 8; ++i) axis = bc1_times(m, axis);
    return axis;
}

// The texels that lie farthest along the axis become the endpoints.
SHADER_FUNCTION void bc1_span(Bc1Colors colors, vec3 axis, SHADER_INOUT(Bc1Fit) fit) {
    float least = 3.0e38f, most = -3.0e38f;
    vec3 high = vec3(0.0f), low = vec3(0.0f);
    for (int i = 0; i < 16; ++i) {
        if ((colors.opaque >> uint(i) & 1u) == 0u) continue;
        vec3 c = colors.color[i];
        float along = bc1_dot(c, axis);
        if (along > most) {
            most = along;
            high = c;
        }
        if (along < least) {
            least = along;
            low = c;
        }
    }
    fit.high = bc1_quantized(high);
    fit.low = bc1_quantized(low);
}

SHADER_FUNCTION Bc1Fit bc1_axis_fit(Bc1Colors colors, int steps) {
    Bc1Fit best;
    best.steps = steps;
    bc1_span(colors, bc1_principal_axis(bc1_moments(colors)), best);
    Bc1Sums sums = bc1_weigh(colors, best);
    for (int i = 0; i < kBc1Rounds; ++i) {
        Bc1Fit fit = best;
        if (!bc1_refine(sums, fit)) break;
        sums = bc1_weigh(colors, fit);
        if (fit.error >= best.error) break;
        best = fit;
    }
    return best;
}

// What takes no search: the corners of the colours' box, which now and then beat the axis where few colours
// lie far from a line.
SHADER_FUNCTION Bc1Fit bc1_box_fit(Bc1Colors colors, int steps) {
    Bc1Fit fit;
    fit.steps = steps;
    fit.high = bc1_quantized(colors.most);
    fit.low = bc1_quantized(colors.least);
    bc1_weigh(colors, fit);
    return fit;
}

// --- blocks of one colour

// One colour for all: so many steps towards `high`.
SHADER_FUNCTION void bc1_weigh_equally(Bc1Colors colors, int weight, SHADER_INOUT(Bc1Fit) fit) {
    int rest = fit.steps - weight;
    fit.weights = uint(weight) * 0x55555555u;
    Bc1Sums sums;
    sums.ww = weight * weight * colors.count;
    sums.wv = weight * rest * colors.count;
    sums.vv = rest * rest * colors.count;
    sums.wc = colors.sum * float(weight);
    sums.vc = colors.sum * float(rest);
    fit.error = bc1_error(colors, sums, fit);
}

SHADER_FUNCTION Bc1Fit bc1_mean_fit(Bc1Colors colors, int steps) {
    Bc1Fit fit;
    fit.steps = steps;
    fit.high = bc1_quantized(colors.sum / float(colors.count));
    fit.low = fit.high;
    bc1_weigh_equally(colors, 0, fit);
    return fit;
}

// The two quanta whose mix, all steps but one from the second towards the first, is nearest to a channel's
// value; of equally near ones the closest, since GPUs differ in how they mix.
SHADER_FUNCTION ivec2 bc1_flat_channel(int value, int bits, int steps) {
    int last = (1 << bits) - 1;
    ivec2 best = ivec2(0, 0);
    int least = 1 << 24;
    for (int low = 0; low <= last; ++low) {
        int rest = steps * value - bc1_widened(low, bits);
        int below = clamp(rest * last / (255 * (steps - 1)), 0, last);
        for (int high = max(below - 1, 0); high <= min(below + 1, last); ++high) {
            int off = abs(rest - (steps - 1) * bc1_widened(high, bits));
            int cost = off * 64 + abs(high - low);
            if (cost < least) {
                least = cost;
                best = ivec2(high, low);
            }
        }
    }
    return best;
}

SHADER_FUNCTION Bc1Fit bc1_flat_fit(Bc1Colors colors, int steps) {
    vec3 mean = floor(colors.sum / float(colors.count) + vec3(0.5f));
    ivec2 red = bc1_flat_channel(int(mean.x), 5, steps);
    ivec2 green = bc1_flat_channel(int(mean.y), 6, steps);
    ivec2 blue = bc1_flat_channel(int(mean.z), 5, steps);
    Bc1Fit fit;
    fit.high = ivec3(red.x, green.x, blue.x);
    fit.low = ivec3(red.y, green.y, blue.y);
    fit.steps = steps;
    bc1_weigh_equally(colors, steps - 1, fit);
    return fit;
}

// --- the block

SHADER_FUNCTION Bc1Fit bc1_better(Bc1Fit a, Bc1Fit b) {
    return b.error * (a.steps * a.steps) < a.error * (b.steps * b.steps) ? b : a;
}

SHADER_FUNCTION uint bc1_packed(ivec3 quanta) {
    return uint(quanta.x) << 11u | uint(quanta.y) << 5u | uint(quanta.z);
}

// The order of the endpoints tells how many colours there are.
SHADER_FUNCTION uvec2 bc1_block(Bc1Colors colors, Bc1Fit fit) {
    uint first = bc1_packed(fit.high), second = bc1_packed(fit.low);
    bool four = fit.steps == kBc1FourColors;
    bool turn = four ? first < second : first > second;
    uint indices = 0u;
    for (int i = 0; i < 16; ++i) {
        uint weight = fit.weights >> uint(2 * i) & 3u;
        if (turn) weight = uint(fit.steps) - weight;
        // The first endpoint, the second, then what lies between.
        uint index = weight == uint(fit.steps) ? 0u : weight == 0u ? 1u : uint(fit.steps) + 1u - weight;
        if (first == second) index = 0u;
        if ((colors.opaque >> uint(i) & 1u) == 0u) index = 3u;
        indices |= index << uint(2 * i);
    }
    return turn ? uvec2(second | first << 16u, indices) : uvec2(first | second << 16u, indices);
}

// Of colours that are not all the same.
SHADER_FUNCTION Bc1Fit bc1_varied_fit(Bc1Colors colors, int steps) {
    Bc1Fit simple = bc1_better(bc1_mean_fit(colors, steps), bc1_box_fit(colors, steps));
    return bc1_better(simple, bc1_axis_fit(colors, steps));
}

// Of colours that are nearly the same: in either mode, where none is transparent.
SHADER_FUNCTION Bc1Fit bc1_faint_fit(Bc1Colors colors) {
    Bc1Fit three = bc1_flat_fit(colors, kBc1ThreeColors);
    if (colors.count < 16) return three;
    return bc1_better(three, bc1_flat_fit(colors, kBc1FourColors));
}

// First endpoint in the low and second in the high half of the first word, then the indices.
SHADER_FUNCTION uvec2 bc1_encoded(Bc1Texels texels) {
    Bc1Colors colors = bc1_colors(texels);
    if (colors.count == 0) return uvec2(0u, 0xffffffffu);
    vec3 range = colors.most - colors.least;
    float widest = max(max(range.x, range.y), range.z);
    if (widest == 0.0f) return bc1_block(colors, bc1_faint_fit(colors));
    Bc1Fit fit = bc1_varied_fit(colors, colors.count == 16 ? kBc1FourColors : kBc1ThreeColors);
    if (widest <= kBc1Flat) fit = bc1_better(fit, bc1_faint_fit(colors));
    return bc1_block(colors, fit);
}

SHADER_END
