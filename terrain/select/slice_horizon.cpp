#include "ridgeline/select/slice_horizon.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ridgeline/base/contract.h"

namespace ridgeline::select {
namespace {

// Lines are cut where they come this near: what is nearer hides next to nothing, and its slope has no bounds.
constexpr double kNearestLine_m = 0.1;
// Cells of maxima on a side of a node, at most.
constexpr std::size_t kMostCells = 128;
// Floats: places and heights are good to some 1e-6 of themselves.
constexpr float kRounding = 4e-6f;
// An angle in slope, at the sector's border (u = 1, so 2) and half as much again.
constexpr float kSlopePerAngle = 1.5f;

// A line's vertices in a slice: x, z = start + i * step + across * across_step.
template <class Real>
struct SliceLine {
    SliceLine(const SliceView& view, const Lattice& lattice, const GroundLine& line) {
        const glm::dvec2 start = lattice.at(line.start.x, line.start.y);
        const auto step_of = [&](const glm::dvec2& cells) {
            return glm::dvec2(cells.x * lattice.cell_m.x, -cells.y * lattice.cell_m.y);
        };
        const glm::dvec2 step = step_of(line.step), across = step_of(line.across_step);
        x = static_cast<Real>(view.x(start)), z = static_cast<Real>(view.z(start));
        x_step = static_cast<Real>(view.x(step)), z_step = static_cast<Real>(view.z(step));
        x_across = static_cast<Real>(view.x(across)), z_across = static_cast<Real>(view.z(across));
    }
    Real x, z, x_step, z_step, x_across, z_across;
};

}  // namespace

void SliceHorizon::begin(const SliceView& view, const HorizonTolerance& tolerance, Use use) {
    view_ = view;
    use_ = use;
    tolerance_ = tolerance;
    sunk_m_ = 0.0;
    if (use == Use::zone) {
        sunk_m_ = static_cast<double>(tolerance.rise_m);
        tolerance_.rise_m = 0.0f;
    }
    // At least so much that rounding cannot put a place on a border into neither slice.
    widened_ = std::max(tolerance.margin * SliceView::kPlacesPerUnit * 2.0f, 0.01f);
    aim_ = {true, true};
    exact_.clear(view.range());
    lowered_.clear(view.range());
}

bool SliceHorizon::touches(const Lattice& lattice, const glm::ivec2& from, int side) const {
    return SeenSquares(view_, lattice, from, side, 1, 1).bounds(0, 0, widened_).where !=
           SeenSquares::Where::outside;
}

// --- lines

namespace {

// Most lines lie behind higher ones and change nothing: to see that costs less than to raise. False: nothing.
bool raise_where_higher(HorizonColumns& columns, const ColumnRange& range, std::span<const float> places,
                        std::span<const float> values) {
    float left = places[0], right = places[0], top = values[0];
    for (std::size_t i = 1; i < places.size(); ++i) {
        left = std::min(left, places[i]);
        right = std::max(right, places[i]);
        top = std::max(top, values[i]);
    }
    // Only columns that it crosses from border to border can rise.
    const auto least = static_cast<float>(range.first), most = static_cast<float>(range.last + 1);
    const int first = static_cast<int>(std::ceil(std::clamp(left, least, most)));
    const int last = static_cast<int>(std::clamp(right, least, most)) - 1;
    if (first > last || columns.hides(first, last, top)) return false;
    columns.raise(places, values);
    return true;
}

}  // namespace

// Collects vertices to runs, cuts them where they come too near.
class SliceHorizon::Feed {
  public:
    explicit Feed(SliceHorizon& slice) : slice_(slice) {}
    ~Feed() { gap(); }

    void add(double x, double z, double height_m) {
        const Vertex vertex{x, z, height_m};
        const bool ahead = z >= kNearestLine_m;
        if (has_last_ && ahead != (last_.z >= kNearestLine_m)) push(cut(last_, vertex));
        if (ahead)
            push(vertex);
        else
            flush();
        last_ = vertex;
        has_last_ = true;
    }
    void gap() {
        flush();
        has_last_ = false;
    }

  private:
    struct Vertex {
        double x = 0.0, z = 0.0, height_m = 0.0;
    };
    static Vertex cut(const Vertex& a, const Vertex& b) {
        const double t = (kNearestLine_m - a.z) / (b.z - a.z);
        return {a.x + t * (b.x - a.x), kNearestLine_m, a.height_m + t * (b.height_m - a.height_m)};
    }
    void push(const Vertex& v) {
        const double nearness = 1.0 / v.z;
        nearness_[count_] = static_cast<float>(nearness);
        places_[count_] = slice_.view_.place(static_cast<float>(v.x * nearness));
        values_[count_] = static_cast<float>(v.height_m * nearness);
        ++count_;
    }
    void flush() {
        slice_.raise_run({places_.data(), count_}, {values_.data(), count_}, nearness_.data());
        count_ = 0;
    }

    SliceHorizon& slice_;
    Vertex last_;
    bool has_last_ = false;
    std::size_t count_ = 0;
    // Two more for where a line is cut.
    std::array<float, kMostVertices + 2> places_, values_, nearness_;
};

void SliceHorizon::raise(const GroundLine& line, const Lattice& lattice, const CodedHeights& heights,
                         Reach reach) {
    if (reach == Reach::far) return raise_far(line, lattice, heights);
    const SliceLine<double> in(view_, lattice, line);
    Feed feed(*this);
    for (int i = 0; i < line.count; ++i) {
        if (line.codes[i] == 0) {
            feed.gap();
            continue;
        }
        const double across = line.across[i];
        feed.add(in.x + i * in.x_step + across * in.x_across, in.z + i * in.z_step + across * in.z_across,
                 heights.at(line.codes[i]) - sunk_m_);
    }
}

void SliceHorizon::raise(const GroundLine& line, const Lattice& lattice, std::span<const float> heights_m) {
    const SliceLine<double> in(view_, lattice, line);
    const auto x = static_cast<float>(in.x), z = static_cast<float>(in.z);
    const auto end_x = static_cast<float>(in.x + (line.count - 1) * in.x_step);
    const auto end_z = static_cast<float>(in.z + (line.count - 1) * in.z_step);
    if ((view_.over_left(x, z) < 0.0f && view_.over_left(end_x, end_z) < 0.0f) ||
        (view_.over_right(x, z) < 0.0f && view_.over_right(end_x, end_z) < 0.0f))
        return;
    Feed feed(*this);
    for (int i = 0; i < line.count; ++i)
        feed.add(in.x + i * in.x_step, in.z + i * in.z_step,
                 static_cast<double>(heights_m[static_cast<std::size_t>(i)]) - sunk_m_);
}

void SliceHorizon::raise_far(const GroundLine& line, const Lattice& lattice, const CodedHeights& heights) {
    RIDGELINE_CHECK(line.count <= kMostVertices);
    const SliceLine<float> in(view_, lattice, line);
    const auto base = static_cast<float>(heights.base_m - sunk_m_), step = static_cast<float>(heights.step_m);
    std::array<float, kMostVertices> places, values, nearness;
    const auto count = static_cast<std::size_t>(line.count);
    const auto usable = [&](std::size_t i, float nearness_there) {
        constexpr auto kMost = static_cast<float>(1.0 / kNearestLine_m);
        return line.codes[i] != 0 && nearness_there > 0.0f && nearness_there <= kMost;
    };
    bool whole = true;
    for (std::size_t i = 0; i < count; ++i) {
        const auto along = static_cast<float>(i), across = static_cast<float>(line.across[i]);
        const float z = in.z + along * in.z_step + across * in.z_across;
        const float x = in.x + along * in.x_step + across * in.x_across;
        nearness[i] = 1.0f / z;
        whole &= usable(i, nearness[i]);
        places[i] = view_.place(x * nearness[i]);
        values[i] = (base + static_cast<float>(line.codes[i]) * step) * nearness[i];
    }
    if (whole) return raise_run({places.data(), count}, {values.data(), count}, nearness.data());
    for (std::size_t begin = 0; begin < count; ++begin) {
        std::size_t end = begin;
        while (end < count && usable(end, nearness[end])) ++end;
        raise_run({places.data() + begin, end - begin}, {values.data() + begin, end - begin},
                  nearness.data() + begin);
        begin = end;
    }
}

void SliceHorizon::raise_run(std::span<const float> places, std::span<const float> values,
                             const float* nearness) {
    if (places.size() < 2) return;
    // A line that changes nothing now would change little soon.
    if (aim_.now && !raise_where_higher(exact_, view_.range(), places, values)) return;
    if (!aim_.soon || !(tolerance_.rise_m > 0.0f)) return;
    std::array<float, kMostVertices + 2> sunk;
    for (std::size_t i = 0; i < values.size(); ++i) sunk[i] = values[i] - tolerance_.rise_m * nearness[i];
    raise_where_higher(lowered_, view_.range(), places, {sunk.data(), values.size()});
}

void SliceHorizon::close(const Lattice& lattice, const glm::ivec2& from, int side, double top_m) {
    const auto bounds = SeenSquares(view_, lattice, from, side, 1, 1).bounds(0, 0, widened_);
    if (bounds.where == SeenSquares::Where::outside) return;
    const bool about = bounds.where == SeenSquares::Where::about;
    const int first = about ? view_.range().first : bounds.first;
    const int last = about ? view_.range().last : bounds.last;
    const float value =
        about ? std::numeric_limits<float>::infinity() : bounds.value(static_cast<float>(top_m));
    exact_.close(first, last, value);
    lowered_.close(first, last, value);
}

// --- squares

bool SliceHorizon::sees(const HorizonColumns& columns, const SeenSquares::Bounds& bounds,
                        float height_m) const {
    if (bounds.where != SeenSquares::Where::ahead) return bounds.where == SeenSquares::Where::about;
    const float value = bounds.value(height_m);
    const float margin =
        tolerance_.margin * kSlopePerAngle * (1.0f + value * value) + kRounding * (1.0f + std::abs(value));
    return !columns.hides(bounds.first, bounds.last, value + margin);
}

SliceHorizon::Sight SliceHorizon::look(const Lattice& lattice, const glm::ivec2& from, int side,
                                       double top_m) const {
    const auto bounds = SeenSquares(view_, lattice, from, side, 1, 1).bounds(0, 0, widened_);
    if (bounds.where == SeenSquares::Where::outside) return {.outside = true};
    const auto top = static_cast<float>(top_m);
    const bool now = sees(exact_, bounds, top);
    return {now, now || (tolerance_.rise_m > 0.0f && sees(lowered_, bounds, top))};
}

SliceHorizon::Sight SliceHorizon::look(const GroundMaxima& ground, const CellRange& range) const {
    const bool now = sees(exact_, ground, range);
    return {now, now || (tolerance_.rise_m > 0.0f && sees(lowered_, ground, range))};
}

namespace {

using BlockTops = std::array<std::uint8_t, SeenSquares::kMostSide * SeenSquares::kMostSide>;

// most: by column. So many columns at once that compilers make vectors of them.
void raise_to(std::uint8_t* most, const std::uint8_t* codes, int count) {
    constexpr int kAtOnce = 8;
    int x = 0;
    for (; x + kAtOnce <= count; x += kAtOnce)
        for (int i = 0; i < kAtOnce; ++i) most[x + i] = std::max(most[x + i], codes[x + i]);
    for (; x < count; ++x) most[x] = std::max(most[x], codes[x]);
}

// The greatest code in each square block of a range.
BlockTops block_tops(const GroundMaxima& ground, const CellRange& range, int block) {
    BlockTops tops;
    std::array<std::uint8_t, kMostCells> columns;
    std::uint8_t* top = tops.data();
    for (int from = 0; from < range.size.y; from += block) {
        const int rows = std::min(block, range.size.y - from);
        const std::uint8_t* codes = ground.codes + (range.from.y + from) * ground.stride + range.from.x;
        std::copy_n(codes, range.size.x, columns.begin());
        for (int row = 1; row < rows; ++row)
            raise_to(columns.data(), codes + row * ground.stride, range.size.x);
        for (int first = 0; first < range.size.x; first += block)
            *top++ = *std::max_element(columns.begin() + first,
                                       columns.begin() + std::min(first + block, range.size.x));
    }
    return tops;
}

}  // namespace

// The whole range as one square, then blocks of it, then cells.
bool SliceHorizon::sees(const HorizonColumns& columns, const GroundMaxima& ground,
                        const CellRange& range) const {
    constexpr int kMostSide = SeenSquares::kMostSide;
    const int side = std::max(range.size.x, range.size.y);
    RIDGELINE_CHECK(side <= static_cast<int>(kMostCells));
    const int block = side <= 4 ? side : std::max((side + 3) / 4, (side + kMostSide - 1) / kMostSide);
    const int blocks_x = (range.size.x + block - 1) / block, blocks_y = (range.size.y + block - 1) / block;
    const auto tops = block_tops(ground, range, block);
    const std::uint8_t top = *std::max_element(tops.begin(), tops.begin() + blocks_x * blocks_y);
    const auto height_m = [&](int code) { return static_cast<float>(ground.heights.at(code)); };
    const auto whole = SeenSquares(view_, ground.lattice, range.from, side, 1, 1).bounds(0, 0, widened_);
    if (!sees(columns, whole, height_m(top))) return false;
    const SeenSquares squares(view_, ground.lattice, range.from, block, blocks_x, blocks_y);
    for (int y = 0; y < blocks_y; ++y)
        for (int x = 0; x < blocks_x; ++x) {
            const auto bounds = squares.bounds(x, y, widened_);
            if (!sees(columns, bounds, height_m(tops[static_cast<std::size_t>(y * blocks_x + x)]))) continue;
            const glm::ivec2 from = range.from + glm::ivec2(x, y) * block;
            const glm::ivec2 to = glm::min(from + block, range.from + range.size);
            if (block == 1 || sees_cells(columns, ground, {from, to - from})) return true;
        }
    return false;
}

bool SliceHorizon::sees_cells(const HorizonColumns& columns, const GroundMaxima& ground,
                              const CellRange& range) const {
    const SeenSquares squares(view_, ground.lattice, range.from, 1, range.size.x, range.size.y);
    for (int y = 0; y < range.size.y; ++y)
        for (int x = 0; x < range.size.x; ++x) {
            const int code = ground.codes[(range.from.y + y) * ground.stride + range.from.x + x];
            if (sees(columns, squares.bounds(x, y, widened_), static_cast<float>(ground.heights.at(code))))
                return true;
        }
    return false;
}

}  // namespace ridgeline::select
