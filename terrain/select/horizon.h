// The horizon about an eye, as columns of azimuth: what the ground in front hides behind it (horizon paper,
// 4.1).
//
// The world about the eye is cut into eight slices of azimuth, half sectors of 90 degrees turned to the
// camera's heading. A slice looks along its sector's axis: z ahead, x to the right, both level. A column is a
// range of u = x / z, and its value is h / z, height over the eye. In these coordinates straight segments
// stay straight, and a pitched or rolled camera changes nothing. A column's value is never above the ground
// that was added, anywhere in the column; so what is below it everywhere is hidden.
//
// Slices know nothing of each other: one thread each, any number at a time. Nothing allocates.
#pragma once

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <span>

namespace ridgeline::select {

// What a column stands at where nothing was looked at. Minus infinity: nothing hides.
constexpr float kNotLookedAt = -2.0e38f;

// Columns of a slice, both ends included.
struct ColumnRange {
    int first = 0, last = 0;
    bool empty() const { return first > last; }
};

// The columns of one slice. Places are in columns: 0 is the slice's left border, kCount its right one.
class HorizonColumns {
  public:
    static constexpr int kCount = 512;
    // So many are raised at once, some of them perhaps past the last that is meant.
    static constexpr int kAtOnce = 4;
    static constexpr ColumnRange kAll{0, kCount - 1};

    HorizonColumns() { clear(kAll); }
    // Hides nothing. Only columns in range will rise, or may be asked of.
    void clear(const ColumnRange& range);
    // Raises the columns that a polyline crosses from border to border to its least value in each. It may run
    // to the left, to the right, and back; each such run counts by itself.
    void raise(std::span<const float> places, std::span<const float> values);
    // Columns in which ground up to `value` would be seen take nothing from now on.
    void close(int first, int last, float value);
    // Whether `value` is under the horizon from column first to column last.
    bool hides(int first, int last, float value) const;

    std::span<const float, kCount> values() const { return std::span(values_).first<kCount>(); }

  private:
    class Run;
    struct Line {
        float value = 0.0f;  // at a place
        float place = 0.0f;
        float slope = 0.0f;
        float at(int border) const { return value + (static_cast<float>(border) - place) * slope; }
    };
    void raise(int column, float value);
    void raise(int first, int last, const Line& line);
    // Finds how high a block stands.
    void measure(int block) const;
    // The same as hides(), but may say no where a yes takes a closer look.
    bool surely_hides(int first, int last, float value) const;

    ColumnRange range_;
    std::array<float, kCount + kAtOnce> values_;
    // What a column may rise to: infinity, or where it stood when it was closed.
    std::array<float, kCount + kAtOnce> limits_;
    // At most the least value in each block, so that what is hidden is found so at few looks.
    static constexpr int kBlock = 16;
    mutable std::array<float, kCount / kBlock> floors_;
};

// How a slice looks at level places: metres east and north of the eye.
class SliceView {
  public:
    static constexpr int kSlices = 8;
    // Columns per unit of u: a sector of 90 degrees spans u from -1 to 1.
    static constexpr float kPlacesPerUnit = HorizonColumns::kCount;

    SliceView() = default;
    // heading: unit vector, east and north. Slices 0 and 1 are left and right of it, the next two to its
    // right, and so on clockwise. It looks at the columns in range alone.
    SliceView(const glm::dvec2& heading, int slice, const ColumnRange& range = HorizonColumns::kAll);

    double x(const glm::dvec2& east_north) const { return glm::dot(across_, east_north); }
    double z(const glm::dvec2& east_north) const { return glm::dot(ahead_, east_north); }
    // Column place of x / z.
    float place(float u) const { return u * kPlacesPerUnit + offset_; }
    const ColumnRange& range() const { return range_; }
    // What it looks at is where both are positive; negative for x / z beyond the left and the right border.
    float over_left(float x, float z) const { return x - left_u_ * z; }
    float over_right(float x, float z) const { return right_u_ * z - x; }

  private:
    glm::dvec2 across_{1.0, 0.0};
    glm::dvec2 ahead_{0.0, 1.0};
    float left_u_ = -1.0f;
    float right_u_ = 0.0f;
    float offset_ = kPlacesPerUnit;
    ColumnRange range_ = HorizonColumns::kAll;
};

// A level lattice over the ground: node cells, cells of maxima. Metres from the eye.
struct Lattice {
    glm::dvec2 corner_m{0.0};  // north-western: east, north
    glm::dvec2 cell_m{1.0};    // to the east, to the south

    glm::dvec2 at(double column, double row) const {
        return {corner_m.x + column * cell_m.x, corner_m.y - row * cell_m.y};
    }
};

// A grid of squares as a slice sees it.
class SeenSquares {
  public:
    static constexpr int kMostSide = 8;

    // columns x rows squares of `side` lattice cells from a lattice place on.
    SeenSquares(const SliceView& view, const Lattice& lattice, const glm::ivec2& from, int side, int columns,
                int rows);

    enum class Where {
        outside,  // of the slice
        ahead,    // between the columns and distances below
        about,    // so near that it has no bounds
    };
    struct Bounds {
        Where where = Where::outside;
        int first = 0, last = -1;                     // columns
        float least_nearness = 0, most_nearness = 0;  // 1 / z
        // The largest h / z that a height over the eye can have in the square.
        float value(float height_m) const {
            return height_m * (height_m > 0.0f ? most_nearness : least_nearness);
        }
    };
    // widened: places by which the square is taken to be broader to either side.
    Bounds bounds(int column, int row, float widened) const;

  private:
    static constexpr int kMostCorners = (kMostSide + 1) * (kMostSide + 1);

    const SliceView& view_;
    int stride_;
    // Corners with z below this have no useful place.
    float nearest_m_;
    std::array<float, kMostCorners> x_, z_, place_, nearness_;
};

}  // namespace ridgeline::select
