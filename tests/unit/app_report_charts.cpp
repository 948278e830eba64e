// The report's drawing: long series in few columns, axes, paths, pictures in a row, numbers and escapes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include "ridgeline/app/report/axis.h"
#include "ridgeline/app/report/curve_path.h"
#include "ridgeline/app/report/decimation.h"
#include "ridgeline/app/report/film_strip.h"
#include "ridgeline/app/report/html_text.h"
#include "ridgeline/app/report/quantity.h"

using namespace ridgeline::app::report;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Series {
    std::vector<double> x, y;
};

// Times that go on unevenly, values with spikes, some of either not measured.
Series random_series(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    Series series;
    double time = 100.0 * unit(random) - 50.0;
    const auto length = random() % 3000;
    for (std::size_t i = 0; i < length; ++i) {
        time += random() % 50 == 0 ? 5.0 * unit(random) : 0.01 * unit(random);
        series.x.push_back(random() % 100 == 0 ? kNaN : time);
        series.y.push_back(random() % 20 == 0   ? kNaN
                           : random() % 90 == 0 ? 1e4 * unit(random)
                                                : unit(random) - 0.2);
    }
    return series;
}

// Column by column, each looking at the whole series.
std::vector<Column> slowly_decimated(const Series& series, const ColumnGrid& grid) {
    std::vector<Column> columns;
    for (int index = 0; index < grid.columns; ++index) {
        std::multiset<double> values;
        for (std::size_t i = 0; i < series.x.size(); ++i) {
            if (std::isnan(series.x[i]) || std::isnan(series.y[i])) continue;
            const double share = (series.x[i] - grid.first) / (grid.last - grid.first) * grid.columns;
            const bool first = index == 0 && share < 0.0,
                       last = index + 1 == grid.columns && share >= grid.columns;
            if (first || last || (share >= index && share < index + 1)) values.insert(series.y[i]);
        }
        if (values.empty()) continue;
        const auto median = std::next(values.begin(), static_cast<std::ptrdiff_t>((values.size() - 1) / 2));
        columns.push_back({index, values.size(), *values.begin(), *median, *values.rbegin()});
    }
    return columns;
}

// The points of a path as the page's script reads them.
std::vector<std::pair<int, int>> points_of(std::string path) {
    for (char& c : path)
        if (c == 'M' || c == 'l' || c == 'z') c = ' ';
    // A sign separates too.
    for (std::size_t at = 1; at < path.size(); ++at)
        if (path[at] == '-' && path[at - 1] != ' ') path.insert(at++, " ");
    std::istringstream numbers(path);
    std::vector<std::pair<int, int>> points;
    int x = 0, y = 0;
    for (int dx = 0, dy = 0; numbers >> dx >> dy;) points.emplace_back(x += dx, y += dy);
    return points;
}

int height_of(double value, const Axis& y) {
    return static_cast<int>(std::lround((1.0 - y.share(value)) * kHeight));
}

}  // namespace

TEST_CASE("decimation: least, median and greatest of every column, as a slow reference finds them") {
    std::mt19937 random(11);
    for (int trial = 0; trial < 60; ++trial) {
        const Series series = random_series(random);
        ColumnGrid grid{-50.0, 60.0, 1 + static_cast<int>(random() % 400)};
        if (trial % 2 == 0 && !series.x.empty() && !std::isnan(series.x.back()))
            grid.last = std::max(series.x.back(), -49.0);
        CHECK(decimated(series.x, series.y, grid) == slowly_decimated(series, grid));
    }
}

TEST_CASE(
    "paths: every column's least and greatest value are points of the band, its median one of the line") {
    std::mt19937 random(12);
    for (int trial = 0; trial < 40; ++trial) {
        const Series series = random_series(random);
        const std::vector<Column> columns = decimated(series.x, series.y, {-50.0, 60.0, 300});
        if (columns.size() < 2) continue;
        // Many values lie off this axis, above and below.
        const Axis y = linear_axis(0.0, 3.0, Unit::milliseconds, 4);
        const auto line = points_of(line_path(columns, y)), band = points_of(band_path(columns, y));
        REQUIRE(line.size() == columns.size());
        REQUIRE(band.size() == 2 * columns.size());
        for (std::size_t i = 0; i < columns.size(); ++i) {
            CHECK(line[i] == std::pair(columns[i].index, height_of(columns[i].median, y)));
            CHECK(band[i] == std::pair(columns[i].index, height_of(columns[i].most, y)));
            CHECK(band[band.size() - 1 - i] == std::pair(columns[i].index, height_of(columns[i].least, y)));
        }
    }
}

TEST_CASE("paths: one frame is a dash, none is nothing, and no band where no column holds two values") {
    const Axis y = linear_axis(0.0, 8.0, Unit::count, 4);
    const std::vector<Column> one = {{5, 1, 2.0, 2.0, 2.0}};
    CHECK(line_path(one, y) == "M5 3000l1 0");
    CHECK(band_path(one, y).empty());
    CHECK(line_path({}, y).empty());
    CHECK(band_path({}, y).empty());
    const std::vector<Column> two = {{0, 1, 2.0, 2.0, 2.0}, {3, 2, 4.0, 4.0, 6.0}};
    CHECK(line_path(two, y) == "M0 3000l3-1000");
    CHECK(band_path(two, y) == "M0 3000l3-2000 0 1000-3 1000z");
}

TEST_CASE("axes: ticks are round, in order and on the axis, whatever the ends") {
    std::mt19937 random(13);
    std::uniform_real_distribution<double> exponent(-12.0, 18.0);
    for (int trial = 0; trial < 2000; ++trial) {
        const double a = (random() % 4 == 0 ? -1.0 : 1.0) * std::pow(10.0, exponent(random)),
                     b = std::pow(10.0, exponent(random));
        for (const Unit unit : {Unit::milliseconds, Unit::bytes, Unit::count}) {
            const Axis axis = linear_axis(std::min(a, b), std::max(a, b), unit, 5);
            CHECK(axis.first < axis.last);
            CHECK(axis.ticks.size() <= 7);
            CHECK(std::is_sorted(axis.ticks.begin(), axis.ticks.end()));
            for (const double tick : axis.ticks) {
                CHECK(axis.share(tick) >= -1e-9);
                CHECK(axis.share(tick) <= 1.0 + 1e-9);
            }
        }
        const double least = std::pow(10.0, exponent(random)),
                     most = least * std::pow(10.0, 0.1 * (random() % 80));
        const Axis axis = logarithmic_axis(least, most);
        CHECK(axis.share(std::max(least, 1e-6 * most)) >= -1e-9);
        CHECK(axis.share(most) <= 1.0 + 1e-9);
        CHECK(axis.ticks.size() >= 1);
        CHECK(axis.ticks.size() <= 13);
    }
    CHECK(linear_axis(0.0, 512.0 * 1024 * 1024, Unit::bytes, 4).ticks ==
          std::vector<double>{0.0, 134217728.0, 268435456.0, 402653184.0, 536870912.0});
    CHECK(linear_axis(0.0, 3.3, Unit::seconds, 4).ticks == std::vector<double>{0.0, 1.0, 2.0, 3.0});
    CHECK(linear_axis(0.0, 1.0, Unit::count, 4).ticks == std::vector<double>{0.0, 1.0});
    CHECK(linear_axis(7.0, 7.0, Unit::seconds, 4).last > 7.0);
    CHECK(logarithmic_axis(3.0, 30.0).ticks == std::vector<double>{2.0, 5.0, 10.0, 20.0, 50.0});
}

TEST_CASE(
    "pictures in a row: in order, none over another, none over the edge, where they belong if there is "
    "room") {
    std::mt19937 random(14);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int trial = 0; trial < 500; ++trial) {
        std::vector<double> moments(1 + random() % 10);
        for (double& moment : moments) moment = trial % 3 == 0 ? 0.1 * unit(random) : unit(random);
        std::sort(moments.begin(), moments.end());
        const double width = (trial % 2 == 0 ? 1.0 : unit(random)) / static_cast<double>(moments.size());
        const std::vector<double> lefts = places_in_row(moments, width);
        REQUIRE(lefts.size() == moments.size());
        CHECK(lefts.front() >= -1e-9);
        CHECK(lefts.back() + width <= 1.0 + 1e-9);
        for (std::size_t i = 1; i < lefts.size(); ++i) CHECK(lefts[i] - lefts[i - 1] >= width - 1e-9);
    }
    const std::vector<double> apart = {0.2, 0.5, 0.8};
    CHECK(places_in_row(apart, 0.1)[1] == doctest::Approx(0.45));
}

TEST_CASE("numbers: three digits, groups of three, units; ratios to the first") {
    CHECK(quantity(171.834, Unit::milliseconds) == "172\u202Fms");
    CHECK(quantity(1.0, Unit::milliseconds) == "1\u202Fms");
    CHECK(quantity(0.01234, Unit::milliseconds) == "0.012\u202Fms");
    CHECK(quantity(0.0, Unit::metres) == "0\u202Fm");
    CHECK(quantity(113879.0, Unit::count) == "113\u202F879");
    CHECK(quantity(-1234567.0, Unit::count) == "-1\u202F234\u202F567");
    CHECK(quantity(999.7, Unit::count) == "1\u202F000");
    CHECK(quantity(kNaN, Unit::count) == "–");
    CHECK(quantity(268435456.0, Unit::bytes) == "256.0 MiB");
    CHECK(tick_text(268435456.0, Unit::bytes) == "256 MiB");
    CHECK(tick_text(150000.0, Unit::count) == "150k");
    CHECK(tick_text(2e6, Unit::count) == "2M");
    CHECK(tick_text(kNaN, Unit::count) == "–");
    CHECK(tick_text(kNaN, Unit::bytes) == "–");
    CHECK(tick_text(0.5, Unit::seconds) == "0.5");
    CHECK(ratio_text(3.0, 2.0) == "×1.50");
    CHECK(ratio_text(2.0, 2.0) == "=");
    CHECK(ratio_text(0.0, 0.0) == "=");
    CHECK(ratio_text(2.0, 0.0) == "–");
    CHECK(ratio_text(kNaN, 1.0) == "–");
}

TEST_CASE("escapes: what HTML reads as markup becomes entities, what is no text U+FFFD, all else stays") {
    CHECK(escaped("</title><script>alert('x' & \"y\")</script>") ==
          "&lt;/title&gt;&lt;script&gt;alert(&#39;x&#39; &amp; &quot;y&quot;)&lt;/script&gt;");
    CHECK(escaped("Dhaulāgirī ⛰ 臺灣 🏔") == "Dhaulāgirī ⛰ 臺灣 🏔");
    const std::string gone = "\uFFFD";
    for (const std::string& bytes : {std::string("\x00", 1), std::string("\x1B"), std::string("\xFF"),
                                     std::string("\x80"), std::string("\x7F")})
        CHECK(escaped("a" + bytes + "b") == "a" + gone + "b");
    // Longer than need be, half of a surrogate pair, beyond Unicode, cut short: each byte for itself.
    for (const std::string& bytes :
         {std::string("\xC0\xBC"), std::string("\xE0\x80\xBC"), std::string("\xED\xA0\x80"),
          std::string("\xF4\x90\x80\x80"), std::string("\xE2\x82")}) {
        std::string all;
        for (std::size_t i = 0; i < bytes.size(); ++i) all += gone;
        CHECK(escaped(bytes) == all);
    }
    CHECK(isolated("<b>") == "<bdi>&lt;b&gt;</bdi>");
}

TEST_CASE("base64: as RFC 4648 gives it") {
    const std::map<std::string, std::string> examples = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"},
                                                         {"\xFF\xFE\xFD", "//79"}};
    for (const auto& [bytes, text] : examples) CHECK(base64(std::as_bytes(std::span(bytes))) == text);
}
