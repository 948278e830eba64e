// Literature: the propagated error of restricted quadtrees is that of Lindstrom et al., "Real-time,
// continuous level of detail rendering of height fields" (1996), and Pajarola, "Large scale terrain
// visualization using the restricted quadtree triangulation" (1998); the horizon paper (3.1) builds chunks
// from it. They walk the dependency graph vertex by vertex; here each scale is two passes over rows of bytes,
// which vectorise.
#include "ridgeline/build/vertex_errors.h"

#include <algorithm>

#include "ridgeline/build/error_code.h"
#include "ridgeline/build/samples.h"
#include "ridgeline/build/vertex_cones.h"

namespace ridgeline::build {
namespace {

using Heights = Phases<std::int32_t>;
using Codes = Phases<std::uint8_t>;

// The middle rows of hypotenuses whose ends lie in rows a and b.
void code_row(const std::int32_t* middle, const std::int32_t* a, const std::int32_t* b, int count,
              std::uint8_t* codes) {
    for (int i = 0; i < count; ++i) codes[i] = error_code(middle[i], a[i], b[i]);
}

// Centres between two rows of corners: diagonals alternate, the first falling eastwards or not.
void code_centre_row(const std::int32_t* middle, const std::int32_t* upper, const std::int32_t* lower,
                     bool falls, int count, std::uint8_t* codes) {
    const std::int32_t first = falls ? -1 : 0;
    for (int i = 0; i < count; ++i) {
        const std::int32_t falling = (i & 1) != 0 ? ~first : first;
        const std::int32_t a = (upper[i] & falling) | (upper[i + 1] & ~falling);
        const std::int32_t b = (lower[i + 1] & falling) | (lower[i] & ~falling);
        codes[i] = error_code(middle[i], a, b);
    }
}

void find_own_codes(const Heights& h, Codes& codes) {
    codes.resize(h.cells);
    for (int row = 0; row <= h.cells; ++row) {
        const std::int32_t* upper = &h.even[h.at(0, row)];
        code_row(&h.x[h.at(0, row)], upper, upper + 1, h.cells, &codes.x[h.at(0, row)]);
        if (row == h.cells) break;
        const std::int32_t* lower = &h.even[h.at(0, row + 1)];
        code_row(&h.y[h.at(0, row)], upper, lower, h.cells + 1, &codes.y[h.at(0, row)]);
        code_centre_row(&h.centre[h.at(0, row)], upper, lower, falls_eastwards(0, row), h.cells,
                        &codes.centre[h.at(0, row)]);
    }
}

void strike_invalid(const std::vector<std::uint8_t>& flags, std::vector<std::uint8_t>& codes) {
    for (std::size_t i = 0; i < codes.size(); ++i) {
        const auto valid = static_cast<std::uint8_t>(-(flags[i] & sample::kValid));
        codes[i] = static_cast<std::uint8_t>(codes[i] & valid);
    }
}

void raise(std::uint8_t& code, std::uint8_t to) { code = std::max(code, to); }

// Edge vertices take the errors of the up to four finer centres around them.
void raise_edges(const Codes& finer, Codes& codes) {
    const int cells = codes.cells;
    for (int row = 0; row < finer.cells; ++row) {
        const std::uint8_t* centre = &finer.centre[finer.at(0, row)];
        // Centres of row 2 j lie below the x vertices of row j, those of 2 j - 1 above.
        std::uint8_t* x = &codes.x[codes.at(0, (row + 1) / 2)];
        for (int i = 0; i < cells; ++i) raise(x[i], std::max(centre[2 * i], centre[2 * i + 1]));
        std::uint8_t* y = &codes.y[codes.at(0, row / 2)];
        for (int i = 0; i < cells; ++i) raise(y[i], centre[2 * i]);
        for (int i = 0; i < cells; ++i) raise(y[i + 1], centre[2 * i + 1]);
    }
}

// Centres take the errors of the four edge vertices around them.
void raise_centres(Codes& codes) {
    for (int row = 0; row < codes.cells; ++row) {
        const std::uint8_t *north = &codes.x[codes.at(0, row)], *south = &codes.x[codes.at(0, row + 1)];
        const std::uint8_t* sides = &codes.y[codes.at(0, row)];
        std::uint8_t* centre = &codes.centre[codes.at(0, row)];
        for (int i = 0; i < codes.cells; ++i)
            raise(centre[i], std::max(std::max(north[i], south[i]), std::max(sides[i], sides[i + 1])));
    }
}

template <class T>
void split_scales(std::span<const T> window, Phases<T>* phases) {
    constexpr int kFirst = kWindowApron - kErrorApron;
    split(&window[kFirst * kWindow + kFirst], kWindow, kErrorCells / 2, phases[0]);
    for (int scale = 1; scale < kFineScales; ++scale) {
        const Phases<T>& finer = phases[scale - 1];
        split(finer.even.data(), finer.stride(), finer.cells / 2, phases[scale]);
    }
}

}  // namespace

void find_vertex_errors(std::span<const std::int32_t> quanta, std::span<const std::uint8_t> flags,
                        const VertexMetric& metric, VertexErrors& errors) {
    split_scales(quanta, errors.heights);
    if (!flags.empty()) split_scales(flags, errors.flags);
    for (int scale = 0; scale < kFineScales; ++scale) {
        Codes& codes = errors.codes[scale];
        find_own_codes(errors.heights[scale], codes);
        if (!flags.empty()) {
            strike_invalid(errors.flags[scale].x, codes.x);
            strike_invalid(errors.flags[scale].y, codes.y);
            strike_invalid(errors.flags[scale].centre, codes.centre);
        }
        if (metric.has_cones())
            raise_by_cones(errors.heights[scale], flags.empty() ? nullptr : &errors.flags[scale],
                           metric.cones(scale), codes);
        if (scale > 0) raise_edges(errors.codes[scale - 1], codes);
        raise_centres(codes);
    }
}

}  // namespace ridgeline::build
