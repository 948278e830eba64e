// A square lattice split in four: what bisection treats alike lies together, so that inner loops run over
// rows.
//
// The lattice of step s has (2 * cells + 1)^2 points. Those with both coordinates even are the lattice of
// step 2 s; the others are the vertices of scale s: x with an odd column (their hypotenuse runs west to
// east), y with an odd row (north to south), centre with both (a diagonal, which alternates like a
// chessboard; docs/store.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ridgeline::build {

template <class T>
struct Phases {
    int cells = 0;
    // Rows of stride() in each: even has cells + 1 of each, x an extra row, y an extra column, centre cells a
    // side.
    std::vector<T> even, x, y, centre;

    int stride() const { return cells + 1; }
    std::size_t at(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(stride()) +
               static_cast<std::size_t>(column);
    }
    void resize(int cell_count) {
        cells = cell_count;
        const auto size = static_cast<std::size_t>(stride()) * static_cast<std::size_t>(stride());
        for (auto* phase : {&even, &x, &y, &centre}) phase->resize(size);
    }
};

// Whether a centre's hypotenuse runs from the north-west to the south-east. Cells count from a multiple of 2
// s cells, or from any offset that is the same in both directions.
constexpr bool falls_eastwards(int column, int row) { return ((column ^ row) & 1) == 0; }

template <class T>
void split(const T* points, std::ptrdiff_t stride, int cells, Phases<T>& phases) {
    phases.resize(cells);
    for (int row = 0; row <= cells; ++row) {
        const T* upper = points + 2 * row * stride;
        T *even = &phases.even[phases.at(0, row)], *x = &phases.x[phases.at(0, row)];
        for (int column = 0; column < cells; ++column) {
            even[column] = upper[2 * column];
            x[column] = upper[2 * column + 1];
        }
        even[cells] = upper[2 * cells];
        if (row == cells) break;
        const T* lower = upper + stride;
        T *y = &phases.y[phases.at(0, row)], *centre = &phases.centre[phases.at(0, row)];
        for (int column = 0; column < cells; ++column) {
            y[column] = lower[2 * column];
            centre[column] = lower[2 * column + 1];
        }
        y[cells] = lower[2 * cells];
    }
}

// The inverse, with the even points from elsewhere: `even` and `points` as dense squares.
template <class T>
void merge(const T* even_points, const Phases<T>& phases, T* points) {
    const int cells = phases.cells, stride = 2 * cells + 1;
    for (int row = 0; row <= cells; ++row) {
        const T* even = even_points + row * (cells + 1);
        const T* x = &phases.x[phases.at(0, row)];
        T* upper = points + 2 * row * stride;
        for (int column = 0; column < cells; ++column) {
            upper[2 * column] = even[column];
            upper[2 * column + 1] = x[column];
        }
        upper[2 * cells] = even[cells];
        if (row == cells) break;
        T* lower = upper + stride;
        const T *y = &phases.y[phases.at(0, row)], *centre = &phases.centre[phases.at(0, row)];
        for (int column = 0; column < cells; ++column) {
            lower[2 * column] = y[column];
            lower[2 * column + 1] = centre[column];
        }
        lower[2 * cells] = y[cells];
    }
}

}  // namespace ridgeline::build
