// The words of the command line mean what INTERFACE promises, and everything else is refused.
#include "ridgeline/app/options.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace ridgeline;
using namespace ridgeline::app;
using namespace std::chrono_literals;

TEST_CASE("a size is two counts of pixels within what GPUs draw") {
    CHECK(parse_size("1024x768").value() == glm::ivec2(1024, 768));
    CHECK(parse_size("1x16384").value() == glm::ivec2(1, 16384));
    for (const char* wrong : {"", "x", "1024", "1024x", "x768", "0x768", "-1x5", "16385x1", "1024X768",
                              "10x10x10", "1024x768 ", "1e3x5", "99999999999x1"})
        CHECK_MESSAGE(!parse_size(wrong), wrong);
}

TEST_CASE("a colour is six hexadecimal digits") {
    CHECK(parse_colour("FF00fe").value() == Colour{255, 0, 254});
    for (const char* wrong : {"", "FF00F", "FF00FF0", "#FF00FF", "GG0000", "0xFF00", "-F00FF", "FF 00F"})
        CHECK_MESSAGE(!parse_colour(wrong), wrong);
}

TEST_CASE("a place is two finite numbers, negative ones too") {
    CHECK(parse_place("-12.5,1e6").value() == glm::dvec2(-12.5, 1e6));
    for (const char* wrong : {"", "1", "1,", ",1", "1,2,3", "a,b", "nan,1", "1,inf", "1, 2", "1;2"})
        CHECK_MESSAGE(!parse_place(wrong), wrong);
}

TEST_CASE("a coordinate system is an EPSG code") {
    CHECK(parse_crs("epsg:3826").value() == "EPSG:3826");
    for (const char* wrong : {"", "3826", "EPSG:", "EPSG:x", "EPSG:-1", "EPSG:1:2", "OGC:84"})
        CHECK_MESSAGE(!parse_crs(wrong), wrong);
}

TEST_CASE("a shot is a frame and a PNG, whose name may hold colons") {
    const auto shot = parse_shot("30:out/a:b.PNG").value();
    CHECK(shot.frame == 30);
    CHECK(shot.file == "out/a:b.PNG");
    for (const char* wrong : {"", "30", "30:", ":a.png", "-1:a.png", "x:a.png", "1:a.jpg", "1:.png.jpg"})
        CHECK_MESSAGE(!parse_shot(wrong), wrong);
}

TEST_CASE("a path is ground, orbit or a file") {
    CHECK(parse_path_choice("ground")->kind == PathChoice::Kind::ground);
    CHECK(parse_path_choice("orbit")->kind == PathChoice::Kind::orbit);
    CHECK(parse_path_choice("./ground")->kind == PathChoice::Kind::file);
    CHECK(!parse_path_choice(""));
}

TEST_CASE("the sun is a direction or a time in UTC") {
    const auto direction = std::get<SunDirection>(parse_sun("225,-3.5").value());
    CHECK(direction.azimuth.degrees() == doctest::Approx(225.0));
    CHECK(direction.elevation.degrees() == doctest::Approx(-3.5));

    using namespace std::chrono;
    const auto expected = sys_days(2026y / June / 21) + 9h;
    CHECK(std::get<sys_seconds>(parse_sun("2026-06-21T09:00Z").value()) == expected);
    CHECK(std::get<sys_seconds>(parse_sun("2026-06-21T09:00:59Z").value()) == expected + 59s);
    for (const char* wrong :
         {"", "225", "225,91", "361,5", "noon", "2026-06-21", "2026-06-21T09:00", "2026-02-30T09:00Z",
          "2026-06-21T24:00Z", "2026-06-21T09:60Z", "2026-06-21 09:00Z", "2026-06-21T09:00:60Z",
          "2026-13-01T00:00Z", "+026-06-21T09:00Z"})
        CHECK_MESSAGE(!parse_sun(wrong), wrong);
}

TEST_CASE("numbers are whole texts, finite and in range") {
    CHECK(parse_number("0.5", {0.0, 1.0}).value() == 0.5);
    CHECK(parse_integer("-3", {-3, 3}).value() == -3);
    CHECK(parse_positive("1e-3").value() == 1e-3);
    CHECK(parse_capacity("1GiB").value() == 1_GiB);
    for (const char* wrong : {"", "x", "1x", "nan", "inf", "2", " 1"})
        CHECK_MESSAGE(!parse_number(wrong, {0.0, 1.0}), wrong);
    for (const char* wrong : {"", "1.5", "4", "99999999999999999999"})
        CHECK_MESSAGE(!parse_integer(wrong, {0, 3}), wrong);
    for (const char* wrong : {"0", "-1", "nan", "inf"}) CHECK_MESSAGE(!parse_positive(wrong), wrong);
    for (const char* wrong : {"0", "-1", "5 parsecs", ""}) CHECK_MESSAGE(!parse_capacity(wrong), wrong);
}

TEST_CASE("what is refused says what was given and what to write, on one line") {
    const std::vector<std::string> messages = {
        parse_size("12").error().message,
        parse_colour("red").error().message,
        parse_place("here").error().message,
        parse_crs("wgs").error().message,
        parse_shot("now").error().message,
        parse_sun("noon").error().message,
        parse_number("x", {0.0, 1.0}).error().message,
        parse_integer("7", {0, 3}).error().message,
        parse_capacity("0").error().message,
    };
    for (const std::string& message : messages) {
        CHECK(message.find('\n') == std::string::npos);
        CHECK(message.size() > 10);
        CHECK(message.back() != '.');
    }
}
