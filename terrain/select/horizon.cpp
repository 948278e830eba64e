// Literature: the incremental horizon (horizon paper, 4.1), which keeps heights per image column; horizons
// from below for conservative culling (Lloyd and Egbert, "Horizon occlusion culling for real-time rendering
// of hierarchical terrains", 2002).
//
// How we differ. Columns are azimuths about the eye, not image columns, so pitch, roll and turning change
// nothing. Within a slice they are projective (u = x / z), so a segment is straight in them, its least value
// in a column lies at the column's border or at a joint, and nothing needs trigonometry. A column rises only
// where a whole run of segments crosses it, so joints leave no gaps and ends promise nothing.
#include "ridgeline/select/horizon.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include "ridgeline/base/contract.h"

namespace ridgeline::select {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kCount = HorizonColumns::kCount;

// Plain vectors, as GCC and Clang know them on every machine: loops of a handful of columns do not become
// vectors by themselves.
constexpr int kLanes = HorizonColumns::kAtOnce;
using Floats = float __attribute__((vector_size(sizeof(float) * kLanes)));
using Ints = std::int32_t __attribute__((vector_size(sizeof(std::int32_t) * kLanes)));
constexpr Floats kFloatLanes = {0.0f, 1.0f, 2.0f, 3.0f};
constexpr Ints kIntLanes = {0, 1, 2, 3};

Floats load(const float* from) {
    Floats values;
    std::memcpy(&values, from, sizeof values);
    return values;
}
void store(const Floats& values, float* to) { std::memcpy(to, &values, sizeof values); }
Floats least_of(const Floats& a, const Floats& b) { return a < b ? a : b; }

// Rounded down, kept within a column of the slice on both sides.
int column_below(float place) {
    constexpr int kShift = 2;
    return static_cast<int>(std::clamp(place, -1.0f, kCount + 1.0f) + kShift) - kShift;
}

}  // namespace

// --- columns

// A run of a polyline to the right, segment by segment. Columns that lie within one segment rise at once; one
// with joints in it when its right border is reached.
class HorizonColumns::Run {
  public:
    Run(HorizonColumns& columns, float place, float value)
        : columns_(columns), place_(place), value_(value), next_(first_border(place)) {}

    void go_to(float place, float value) {
        if (place >= static_cast<float>(next_) && next_ <= kCount) cross(place, value);
        // A joint counts in its own column, and in both where it stands at a border.
        if (low_ > value) low_ = value;
        place_ = place;
        value_ = value;
    }

  private:
    // The first column border at or after a place that matters.
    static int first_border(float place) {
        if (!(place > 0.0f)) return 0;
        const int below = column_below(place);
        return static_cast<float>(below) < place ? below + 1 : below;
    }

    // A segment that reaches at least one border.
    void cross(float place, float value) {
        const float slope = place > place_ ? (value - value_) / (place - place_) : 0.0f;
        const Line line{place > place_ ? value_ : std::min(value_, value), place_, slope};
        const int last = std::min(column_below(place), kCount);
        if (open_) columns_.raise(next_ - 1, std::min(low_, line.at(next_)));
        if (next_ < last && !columns_.surely_hides(next_, last - 1, std::max(value_, value)))
            columns_.raise(next_, last, line);
        low_ = line.at(last);
        open_ = true;
        next_ = last + 1;
    }

    HorizonColumns& columns_;
    float place_, value_;
    int next_;           // the next border to be crossed
    bool open_ = false;  // whether the one before it was
    float low_ = 0.0f;   // the least value since then
};

void HorizonColumns::raise(int column, float value) {
    const auto at = static_cast<std::size_t>(column);
    values_[at] = std::max(values_[at], std::min(value, limits_[at]));
}

// Most of a sweep's time goes by here. A line is least in a column at one of its borders.
void HorizonColumns::raise(int first, int last, const Line& line) {
    const int lower = line.slope < 0.0f ? 1 : 0;
    for (int from = first; from < last; from += kLanes) {
        float* const values = values_.data() + from;
        const Floats borders = static_cast<float>(from + lower) + kFloatLanes;
        const Floats least =
            least_of(line.value + (borders - line.place) * line.slope, load(limits_.data() + from));
        const Floats held = kIntLanes < last - from ? least : -kInfinity - Floats{};
        const Floats stand = load(values);
        store(stand < held ? held : stand, values);
    }
    // What is raised from block to block.
    for (int block = first / kBlock; (block + 1) * kBlock <= last; ++block) measure(block);
}

void HorizonColumns::measure(int block) const {
    const float* const values = values_.data() + block * kBlock;
    Floats least = load(values);
    for (int i = kLanes; i < kBlock; i += kLanes) least = least_of(least, load(values + i));
    float floor = least[0];
    for (int i = 1; i < kLanes; ++i) floor = least[i] < floor ? least[i] : floor;
    floors_[static_cast<std::size_t>(block)] = floor;
}

bool HorizonColumns::surely_hides(int first, int last, float value) const {
    for (int block = first / kBlock; block <= last / kBlock; ++block)
        if (!(value < floors_[static_cast<std::size_t>(block)])) return false;
    return true;
}

void HorizonColumns::clear() {
    values_.fill(-kInfinity);
    floors_.fill(-kInfinity);
    limits_.fill(kInfinity);
}

void HorizonColumns::raise(std::span<const float> places, std::span<const float> values) {
    const std::size_t count = places.size();
    for (std::size_t begin = 0; begin + 1 < count;) {
        const bool rightwards = places[begin + 1] >= places[begin];
        std::size_t end = begin + 1;
        while (end + 1 < count && (places[end + 1] >= places[end]) == rightwards) ++end;
        const std::size_t start = rightwards ? begin : end;
        Run run(*this, places[start], values[start]);
        if (rightwards)
            for (std::size_t i = begin + 1; i <= end; ++i) run.go_to(places[i], values[i]);
        else
            for (std::size_t i = end; i-- > begin;) run.go_to(places[i], values[i]);
        begin = end;
    }
}

// Block by block; columns are only looked at where what is known of their block does not say it.
bool HorizonColumns::hides(int first, int last, float value) const {
    for (int from = first; from <= last;) {
        const int block = from / kBlock, end = std::min(last + 1, (block + 1) * kBlock);
        if (!surely_hides(from, from, value)) {
            measure(block);
            if (!surely_hides(from, from, value))
                for (int c = from; c < end; ++c)
                    if (!(value < values_[static_cast<std::size_t>(c)])) return false;
        }
        from = end;
    }
    return true;
}

void HorizonColumns::close(int first, int last, float value) {
    for (int c = first; c <= last; ++c) {
        const auto at = static_cast<std::size_t>(c);
        if (!(value < values_[at])) limits_[at] = values_[at];
    }
}

// --- slices

SliceView::SliceView(const glm::dvec2& heading, int slice) {
    RIDGELINE_CHECK(slice >= 0 && slice < kSlices);
    const glm::dvec2 right(heading.y, -heading.x);
    const glm::dvec2 aheads[4] = {heading, right, -heading, -right};
    ahead_ = aheads[slice / 2];
    across_ = {ahead_.y, -ahead_.x};
    const bool right_half = slice % 2 != 0;
    left_u_ = right_half ? 0.0f : -1.0f;
    right_u_ = right_half ? 1.0f : 0.0f;
    offset_ = right_half ? 0.0f : kPlacesPerUnit;
}

// --- squares

SeenSquares::SeenSquares(const SliceView& view, const Lattice& lattice, const glm::ivec2& from, int side,
                         int columns, int rows)
    : view_(view), stride_(columns + 1) {
    RIDGELINE_CHECK(columns <= kMostSide && rows <= kMostSide);
    const glm::dvec2 corner = lattice.at(from.x, from.y);
    const glm::dvec2 east(side * lattice.cell_m.x, 0.0), south(0.0, -side * lattice.cell_m.y);
    // Nearer than a quarter of a square, rounding would tell in the places.
    nearest_m_ = static_cast<float>(0.25 * std::min(east.x, -south.y));
    const auto x = static_cast<float>(view.x(corner)), z = static_cast<float>(view.z(corner));
    const auto x_east = static_cast<float>(view.x(east)), z_east = static_cast<float>(view.z(east));
    const auto x_south = static_cast<float>(view.x(south)), z_south = static_cast<float>(view.z(south));
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            const auto at = static_cast<std::size_t>(j * stride_ + i);
            const auto fi = static_cast<float>(i), fj = static_cast<float>(j);
            x_[at] = x + fi * x_east + fj * x_south;
            z_[at] = z + fi * z_east + fj * z_south;
            nearness_[at] = 1.0f / z_[at];
            place_[at] = view.place(x_[at] * nearness_[at]);
        }
}

SeenSquares::Bounds SeenSquares::bounds(int column, int row, float widened) const {
    const auto a = static_cast<std::size_t>(row * stride_ + column), b = a + 1,
               c = a + static_cast<std::size_t>(stride_), d = c + 1;
    Bounds bounds;
    const auto least = [&](const auto& v) { return std::min(std::min(v[a], v[b]), std::min(v[c], v[d])); };
    const auto most = [&](const auto& v) { return std::max(std::max(v[a], v[b]), std::max(v[c], v[d])); };
    if (least(z_) < nearest_m_) {
        const auto all_negative = [&](auto&& over) {
            return over(x_[a], z_[a]) < 0.0f && over(x_[b], z_[b]) < 0.0f && over(x_[c], z_[c]) < 0.0f &&
                   over(x_[d], z_[d]) < 0.0f;
        };
        const bool outside = all_negative([&](float x, float z) { return view_.over_left(x, z); }) ||
                             all_negative([&](float x, float z) { return view_.over_right(x, z); });
        bounds.where = outside ? Where::outside : Where::about;
        return bounds;
    }
    const int first = column_below(least(place_) - widened), last = column_below(most(place_) + widened);
    if (last < 0 || first >= kCount) return bounds;
    bounds.where = Where::ahead;
    bounds.first = std::max(first, 0);
    bounds.last = std::min(last, kCount - 1);
    bounds.least_nearness = least(nearness_);
    bounds.most_nearness = most(nearness_);
    return bounds;
}

}  // namespace ridgeline::select
