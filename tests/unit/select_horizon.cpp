// Columns and squares of the horizon against slow exact references.
#include "ridgeline/select/horizon.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ridgeline/select/slice_horizon.h"
#include "unit/select_scene.h"

namespace ridgeline::test {
namespace {

using select::HorizonColumns;
using select::Lattice;
using select::SeenSquares;
using select::SliceView;

constexpr int kSamples = 7;  // in a column

struct Polyline {
    std::vector<float> places, values;
};

// Mostly to one side, sometimes back, with short and very long steps.
Polyline random_polyline(Random& random) {
    Polyline line;
    double place = uniform(random, -100.0, 600.0), value = uniform(random, -1.0, 1.0);
    const double step = std::exp(uniform(random, -3.0, 5.0)) * (whole(random, 0, 1) == 0 ? -1.0 : 1.0);
    for (int i = whole(random, 1, 17); i >= 0; --i) {
        line.places.push_back(static_cast<float>(place));
        line.values.push_back(static_cast<float>(value));
        place += step * uniform(random, -0.2, 1.0);
        if (whole(random, 0, 9) == 0) place = std::round(place);
        value += uniform(random, -0.3, 0.3);
    }
    return line;
}

// The highest that the polylines reach at one place.
double silhouette(const std::vector<Polyline>& lines, double place) {
    double highest = -std::numeric_limits<double>::infinity();
    for (const Polyline& line : lines)
        for (std::size_t i = 0; i + 1 < line.places.size(); ++i) {
            const double a = line.places[i], b = line.places[i + 1];
            if (place < std::min(a, b) || place > std::max(a, b)) continue;
            const double t = a == b ? 0.0 : (place - a) / (b - a);
            highest = std::max(highest, line.values[i] + t * (line.values[i + 1] - line.values[i]));
        }
    return highest;
}

// Samples at which columns stand above the polylines.
int count_above(const HorizonColumns& columns, const std::vector<Polyline>& lines) {
    int above = 0;
    for (int c = 0; c < HorizonColumns::kCount; ++c)
        for (int i = 0; i <= kSamples; ++i) {
            const double place = c + i / static_cast<double>(kSamples);
            const double value = static_cast<double>(columns.values()[static_cast<std::size_t>(c)]);
            above += value > silhouette(lines, place) + 1e-4;
        }
    return above;
}

HorizonColumns raised_by(const std::vector<Polyline>& lines, float by) {
    HorizonColumns columns;
    for (Polyline line : lines) {
        for (float& value : line.values) value += by;
        columns.raise(line.places, line.values);
    }
    return columns;
}

// What HorizonColumns does, border by border and column by column.
class PlainColumns {
  public:
    void raise(const Polyline& line) {
        for (std::size_t begin = 0, end = 0; end + 1 < line.places.size(); begin = end) {
            const bool rightwards = line.places[begin + 1] >= line.places[begin];
            for (end = begin + 1; end + 1 < line.places.size(); ++end)
                if ((line.places[end + 1] >= line.places[end]) != rightwards) break;
            Polyline run;
            for (std::size_t i = begin; i <= end; ++i) {
                const std::size_t from = rightwards ? i : begin + end - i;
                run.places.push_back(line.places[from]);
                run.values.push_back(line.values[from]);
            }
            raise_run(run);
        }
    }
    void close(int first, int last, float value) {
        for (auto c = static_cast<std::size_t>(first); c <= static_cast<std::size_t>(last); ++c)
            if (!(value < values[c])) limits_[c] = values[c];
    }
    bool hides(int first, int last, float value) const {
        return std::all_of(values.begin() + first, values.begin() + last + 1,
                           [&](float stands) { return value < stands; });
    }

    std::vector<float> values = std::vector<float>(kCount, -kInfinity);

  private:
    static constexpr std::size_t kCount = HorizonColumns::kCount;
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    void raise_run(const Polyline& run) {
        std::vector<float> at(kCount + 1, -kInfinity), low(kCount + 1, kInfinity);
        const auto first = static_cast<std::size_t>(std::max(std::ceil(run.places.front()), 0.0f));
        std::size_t next = first;
        for (std::size_t i = 1; i < run.places.size(); ++i) {
            const float from = run.places[i - 1], to = run.places[i];
            const float a = run.values[i - 1], b = run.values[i];
            const float slope = to > from ? (b - a) / (to - from) : 0.0f;
            for (; next <= kCount && static_cast<float>(next) <= to; ++next)
                at[next] = (to > from ? a : std::min(a, b)) + (static_cast<float>(next) - from) * slope;
            if (next > first) low[next - 1] = std::min(low[next - 1], b);
        }
        for (std::size_t c = first; c + 1 < next; ++c)
            values[c] = std::max(values[c], std::min({at[c], at[c + 1], low[c], limits_[c]}));
    }

    std::vector<float> limits_ = std::vector<float>(kCount, kInfinity);
};

// Metres from the eye, near and far, in any direction.
glm::dvec2 random_place(Random& random) {
    const double azimuth = uniform(random, 0.0, 6.3), away = std::exp(uniform(random, 0.0, 11.0));
    return {away * std::sin(azimuth), away * std::cos(azimuth)};
}

}  // namespace

TEST_CASE("no column ever stands above what was added, and sabotaged ones do") {
    Random random(1);
    int sabotage_caught = 0;
    for (int round = 0; round < 150; ++round) {
        std::vector<Polyline> lines;
        for (int i = whole(random, 1, 12); i > 0; --i) lines.push_back(random_polyline(random));
        CHECK(count_above(raised_by(lines, 0.0f), lines) == 0);
        sabotage_caught += count_above(raised_by(lines, 0.01f), lines) > 0;
    }
    CHECK(sabotage_caught > 100);
}

TEST_CASE("a run that crosses columns raises each to its least value there, across joints, either way") {
    Random random(2);
    for (int round = 0; round < 300; ++round) {
        Polyline line;
        double place = uniform(random, -20.0, 20.0);
        while (place < 540.0) {
            line.places.push_back(static_cast<float>(place));
            line.values.push_back(static_cast<float>(uniform(random, -1.0, 1.0)));
            place += uniform(random, 0.0, 20.0);
        }
        if (line.places.size() < 2) continue;
        const double begin = line.places.front(), end = line.places.back();
        const std::vector<Polyline> lines = {line};
        if (whole(random, 0, 1) == 0) {
            std::reverse(line.places.begin(), line.places.end());
            std::reverse(line.values.begin(), line.values.end());
        }
        HorizonColumns columns;
        columns.raise(line.places, line.values);
        for (int c = 0; c < HorizonColumns::kCount; ++c) {
            const float value = columns.values()[static_cast<std::size_t>(c)];
            if (begin > c || end < c + 1) {
                CHECK(std::isinf(value));
                continue;
            }
            double least = std::min(silhouette(lines, c), silhouette(lines, c + 1));
            for (std::size_t i = 0; i < line.places.size(); ++i)
                if (line.places[i] >= static_cast<float>(c) && line.places[i] <= static_cast<float>(c + 1))
                    least = std::min(least, static_cast<double>(line.values[i]));
            CHECK(static_cast<double>(value) == doctest::Approx(least).epsilon(0.0001));
        }
    }
}

TEST_CASE("columns raised many at once stand and hide as those of a plain loop, bit for bit") {
    Random random(5);
    int hidden = 0;
    for (int round = 0; round < 300; ++round) {
        HorizonColumns columns;
        PlainColumns plain;
        for (int i = whole(random, 1, 40); i > 0; --i) {
            const Polyline line = random_polyline(random);
            columns.raise(line.places, line.values);
            plain.raise(line);
            const int first = whole(random, 0, HorizonColumns::kCount - 1);
            const int last = std::min(first + whole(random, 0, 60), HorizonColumns::kCount - 1);
            const auto value = static_cast<float>(uniform(random, -1.5, 1.0));
            const bool hides = columns.hides(first, last, value);
            REQUIRE(hides == plain.hides(first, last, value));
            hidden += hides ? 1 : 0;
            if (whole(random, 0, 9) != 0) continue;
            columns.close(first, last, value);
            plain.close(first, last, value);
        }
        REQUIRE(std::ranges::equal(columns.values(), plain.values));
    }
    CHECK(hidden > 500);
}

TEST_CASE("columns in which a hole is seen take nothing more; those in which it is hidden go on") {
    HorizonColumns columns;
    const std::vector<float> places = {0.0f, 512.0f}, low = {0.1f, 0.1f}, high = {0.3f, 0.3f};
    columns.raise(places, low);
    columns.close(10, 19, 0.2f);   // seen over the horizon
    columns.close(30, 39, 0.05f);  // hidden under it
    columns.raise(places, high);
    for (int c = 0; c < HorizonColumns::kCount; ++c) {
        const bool closed = c >= 10 && c <= 19;
        CHECK(columns.values()[static_cast<std::size_t>(c)] == (closed ? 0.1f : 0.3f));
        CHECK(columns.hides(c, c, 0.2f) == !closed);
    }
    CHECK(!columns.hides(5, 12, 0.2f));
    CHECK(columns.hides(20, 511, 0.29f));
}

TEST_CASE("every place about the eye lies in a slice, and in its columns") {
    Random random(3);
    for (int round = 0; round < 2000; ++round) {
        const double heading = uniform(random, 0.0, 6.3);
        const glm::dvec2 direction(std::sin(heading), std::cos(heading));
        const glm::dvec2 place = random_place(random);
        int found = 0;
        for (int slice = 0; slice < SliceView::kSlices; ++slice) {
            const SliceView view(direction, slice);
            const auto x = static_cast<float>(view.x(place)), z = static_cast<float>(view.z(place));
            if (view.over_left(x, z) < 0.0f || view.over_right(x, z) < 0.0f) continue;
            ++found;
            CHECK(view.place(x / z) >= -0.01f);
            CHECK(view.place(x / z) <= HorizonColumns::kCount + 0.01f);
        }
        CHECK(found >= 1);
        CHECK(found <= 2);
    }
}

TEST_CASE("a square's bounds hold every one of its places, in every slice that sees it") {
    Random random(4);
    constexpr float kWidened = 0.01f;
    int ahead = 0;
    for (int round = 0; round < 4000; ++round) {
        const double heading = uniform(random, 0.0, 6.3);
        const double side = std::exp(uniform(random, 0.0, 6.0));
        const Lattice lattice{random_place(random), {side, side * uniform(random, 0.7, 1.4)}};
        const int slice = whole(random, 0, SliceView::kSlices - 1);
        const SliceView view({std::sin(heading), std::cos(heading)}, slice);
        const SeenSquares squares(view, lattice, {2, 3}, 2, 4, 3);
        const int column = whole(random, 0, 3), row = whole(random, 0, 2);
        const auto bounds = squares.bounds(column, row, kWidened);
        const auto height = static_cast<float>(uniform(random, -500.0, 500.0));
        for (int i = 0; i < 40; ++i) {
            const glm::dvec2 at = lattice.at(2 + 2 * (column + uniform(random, 0.0, 1.0)),
                                             3 + 2 * (row + uniform(random, 0.0, 1.0)));
            const auto x = static_cast<float>(view.x(at)), z = static_cast<float>(view.z(at));
            if (view.over_left(x, z) < 0.0f || view.over_right(x, z) < 0.0f) continue;
            CHECK(bounds.where != SeenSquares::Where::outside);
            if (bounds.where != SeenSquares::Where::ahead) continue;
            ++ahead;
            const float at_column = view.place(x / z);
            CHECK(at_column >= static_cast<float>(bounds.first) - 1e-3f);
            CHECK(at_column <= static_cast<float>(bounds.last + 1) + 1e-3f);
            CHECK(height / z <= bounds.value(height) + 1e-4f * std::abs(bounds.value(height)));
        }
    }
    CHECK(ahead > 1000);
}

TEST_CASE("a line with a vertex exactly beside the eye hides no more than its own height, near and far") {
    using select::SliceHorizon;
    const std::vector<std::uint8_t> across = {0, 1, 1};
    const std::vector<std::uint16_t> codes = {10, 10, 10};
    for (const auto reach : {SliceHorizon::Reach::near, SliceHorizon::Reach::far})
        for (const double aside_m : {0.0, 1e-9, 1e-4, -1e-4}) {
            SliceHorizon slice;
            slice.begin(select::SliceView({0.0, 1.0}, 0), {.margin = 1e-5f, .rise_m = 1.0f},
                        SliceHorizon::Use::picture);
            // From ahead on the left to beside the eye, where z is 0, and on along it.
            const select::Lattice lattice{{-30.0, 40.0 + aside_m}, {50.0, 40.0}};
            select::GroundLine line;
            line.across_step = {0.0, 1.0};
            line.across = across.data();
            line.codes = codes.data();
            line.count = 3;
            slice.raise(line, lattice, {.base_m = 0.0, .step_m = 1.0}, reach);
            // Ten metres over the eye at 40 m and less: a column as far to the right as the slice goes sees
            // the line at 16 m.
            for (const float value : slice.exact().values()) CHECK(value <= 10.0f / 16.0f + 1e-3f);
        }
}

}  // namespace ridgeline::test
