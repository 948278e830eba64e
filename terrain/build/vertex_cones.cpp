// Every face is worked out once and kept for the row of vertices below it; faces lie by their quadrant of a
// cell of twice the step, so that all loops run over rows and vectorise. Chords instead of angles: an arc
// cosine a vertex would take longer than the rest of the build.
#include "ridgeline/build/vertex_cones.h"

#include <algorithm>
#include <utility>

#include "ridgeline/base/contract.h"
#include "ridgeline/build/error_code.h"
#include "ridgeline/build/samples.h"
#include "ridgeline/build/vertex_errors.h"

namespace ridgeline::build {
namespace {

constexpr int kMostCells = kErrorCells / 2;

// A quadrant's faces in a row of cells.
struct FaceRow {
    float rise_east[kMostCells], rise_south[kMostCells];
    float east[kMostCells], south[kMostCells], up[kMostCells];
    std::uint8_t valid[kMostCells];  // all bits or none; only where there are flags

    Face at(int i) const { return {rise_east[i], rise_south[i], east[i], south[i], up[i]}; }
    void set(int i, const Face& face) {
        rise_east[i] = face.rise_east;
        rise_south[i] = face.rise_south;
        east[i] = face.east;
        south[i] = face.south;
        up[i] = face.up;
    }
};

// A row of cells' faces by quadrant.
struct CellFaces {
    FaceRow north_west, north_east, south_west, south_east;
};

// What a face's corners are, along a row of cells.
template <class T>
struct CornerRows {
    const T *north_west, *north_east, *south_west, *south_east;
};

void find_faces(const CornerRows<std::int32_t>& corners, int count, const ConeScale& cones, FaceRow& faces) {
    for (int i = 0; i < count; ++i)
        faces.set(i, face_of(corners.north_west[i], corners.north_east[i], corners.south_west[i],
                             corners.south_east[i], cones));
}

void find_valid(const CornerRows<std::uint8_t>& corners, int count, FaceRow& faces) {
    for (int i = 0; i < count; ++i) {
        const int all = corners.north_west[i] & corners.north_east[i] & corners.south_west[i] &
                        corners.south_east[i] & sample::kValid;
        faces.valid[i] = static_cast<std::uint8_t>(-all);
    }
}

// Calls visit(corners, faces) for the four quadrants of a row of cells.
template <class T, class Visit>
void for_each_quadrant(const Phases<T>& points, int row, CellFaces& faces, Visit&& visit) {
    const T *north = &points.even[points.at(0, row)], *south = &points.even[points.at(0, row + 1)];
    const T *north_x = &points.x[points.at(0, row)], *south_x = &points.x[points.at(0, row + 1)];
    const T *sides = &points.y[points.at(0, row)], *centres = &points.centre[points.at(0, row)];
    visit(CornerRows<T>{north, north_x, sides, centres}, faces.north_west);
    visit(CornerRows<T>{north_x, north + 1, centres, sides + 1}, faces.north_east);
    visit(CornerRows<T>{sides, centres, south, south_x}, faces.south_west);
    visit(CornerRows<T>{centres, sides + 1, south_x, south + 1}, faces.south_east);
}

// The four faces about each vertex of a row; the eastern ones may lie one cell on.
struct Surroundings {
    const FaceRow &north_west, &north_east, &south_west, &south_east;
    int east_shift = 0;
    bool flagged = false;
};

void raise_row(const Surroundings& faces, int count, float height_squared, std::uint8_t* codes) {
    const int shift = faces.east_shift;
    float squares[kMostCells];
    for (int i = 0; i < count; ++i)
        squares[i] = height_squared * squared_chord(faces.north_west.at(i), faces.north_east.at(i + shift),
                                                    faces.south_west.at(i), faces.south_east.at(i + shift));
    std::uint8_t cones[kMostCells];
    for (int i = 0; i < count; ++i) cones[i] = error_code_of_square(squares[i]);
    if (faces.flagged)
        for (int i = 0; i < count; ++i)
            cones[i] = static_cast<std::uint8_t>(
                cones[i] & faces.north_west.valid[i] & faces.north_east.valid[i + shift] &
                faces.south_west.valid[i] & faces.south_east.valid[i + shift]);
    for (int i = 0; i < count; ++i) codes[i] = std::max(codes[i], cones[i]);
}

}  // namespace

void raise_by_cones(const Phases<std::int32_t>& heights, const Phases<std::uint8_t>* flags,
                    const ConeScale& cones, Phases<std::uint8_t>& codes) {
    const int cells = heights.cells;
    RIDGELINE_CHECK(cells <= kMostCells);
    const bool flagged = flags != nullptr;
    CellFaces rows[2];
    for (int row = 0; row < cells; ++row) {
        CellFaces& here = rows[row & 1];
        const CellFaces& above = rows[~row & 1];
        for_each_quadrant(heights, row, here,
                          [&](const auto& corners, FaceRow& to) { find_faces(corners, cells, cones, to); });
        if (flagged)
            for_each_quadrant(*flags, row, here,
                              [&](const auto& corners, FaceRow& to) { find_valid(corners, cells, to); });
        const Surroundings centre{here.north_west, here.north_east, here.south_west, here.south_east, 0,
                                  flagged};
        raise_row(centre, cells, cones.height_squared, &codes.centre[codes.at(0, row)]);
        const Surroundings side{here.north_east, here.north_west, here.south_east, here.south_west, 1,
                                flagged};
        raise_row(side, cells - 1, cones.height_squared, &codes.y[codes.at(1, row)]);
        if (row == 0) continue;
        const Surroundings edge{above.south_west, above.south_east, here.north_west, here.north_east, 0,
                                flagged};
        raise_row(edge, cells, cones.height_squared, &codes.x[codes.at(0, row)]);
    }
}

}  // namespace ridgeline::build
