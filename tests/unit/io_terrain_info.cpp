#include <doctest/doctest.h>

#include "ridgeline/io/terrain_info.h"
#include "support/sealed_json.h"

using namespace ridgeline::io;

namespace {

TerrainInfo example() {
    TerrainInfo info;
    info.crs_wkt = "PROJCS[\"somewhere\"]";
    info.west_m = 500000.25;
    info.north_m = 4500000.75;
    info.spacing_x_m = 20.140625;
    info.spacing_y_m = 27.25;
    info.width = 513;
    info.height = 400;
    info.quantum_m = 0.03125;
    info.thresholds_m = {8.0, 4.0, 2.0, 0.5};
    info.max_height_m = 4000.0;
    info.sources = {"a.tif", "b \"quoted\".tif"};
    return info;
}

}  // namespace

TEST_CASE("terrain.json: what is written is read back") {
    const TerrainInfo info = example();
    const auto back = terrain_info_from_json(to_json(info));
    REQUIRE(back);
    CHECK(to_json(*back) == to_json(info));
    CHECK(back->world(3, 5) == info.world(3, 5));
    CHECK(back->cone_thresholds_m.empty());
}

TEST_CASE("terrain.json: metric cone says both thresholds of every level") {
    TerrainInfo info = example();
    info.metric = "cone";
    info.cone_thresholds_m = {8.5, 4.25, 2.0, 0.625};
    const auto back = terrain_info_from_json(to_json(info));
    REQUIRE(back);
    CHECK(back->metric == "cone");
    CHECK(back->cone_thresholds_m == info.cone_thresholds_m);
    info.cone_thresholds_m.pop_back();
    CHECK_FALSE(terrain_info_from_json(to_json(info)).ok());
}

TEST_CASE("terrain.json: what is foretold of finer ground comes back, and impossible gains are refused") {
    TerrainInfo info = example();
    CHECK_FALSE(terrain_info_from_json(to_json(info))->detail);
    info.detail =
        DetailInfo{{1.5, 3.25, 7.0}, {1.25, 2.5, 5.0}, {{1, 2, 3, 4}, {5, 6, 7, DetailInfo::kMostGain}}};
    const auto back = terrain_info_from_json(to_json(info));
    REQUIRE(back);
    CHECK((back->detail == info.detail));
    info.detail->octaves[0].edge_slope = DetailInfo::kMostGain + 1;
    CHECK_FALSE(terrain_info_from_json(to_json(info)).ok());
    info.detail->octaves.assign(DetailInfo::kMostOctaves + 1, {});
    CHECK_FALSE(terrain_info_from_json(to_json(info)).ok());
}

TEST_CASE("terrain.json: every cut is refused, and a newer format by its number") {
    const std::string text = to_json(example());
    for (std::size_t size = 0; size + 2 < text.size(); ++size)
        CHECK_FALSE(terrain_info_from_json(text.substr(0, size)).ok());
    std::string newer = text;
    newer.replace(newer.find("\"version\": 2"), 12, "\"version\": 9");
    const auto refused = terrain_info_from_json(newer);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message.find("newer") != std::string::npos);
    std::string older = text;
    older.replace(older.find("\"version\": 2"), 12, "\"version\": 1");
    const auto outdated = terrain_info_from_json(older);
    REQUIRE_FALSE(outdated);
    CHECK(outdated.error().message.find("build it again") != std::string::npos);
}

TEST_CASE("terrain.json: numbers that no such number can be are refused, though the checksum fits") {
    const std::string text = to_json(example());
    REQUIRE(terrain_info_from_json(*ridgeline::test::sealed(text)));
    const std::pair<std::string, std::string> kFalse[] = {
        {"\"version\": 2", "\"version\": 1e300"},
        {"\"version\": 2", "\"version\": -1e300"},
        {"\"version\": 2", "\"version\": 2.5"},
        {"\"tile\": 65", "\"tile\": 65.5"},
        {"\"tile\": 65", "\"tile\": 4294967361"},
        {"\"triangles\": 0", "\"triangles\": 1e300"},
        {"\"triangles\": 0", "\"triangles\": -1"},
        {"\"triangles\": 0", "\"triangles\": 18446744073709551615"},
        {"\"invalid_samples\": 0", "\"invalid_samples\": 9223372036854775807"},
        {"\"invalid_samples\": 0", "\"invalid_samples\": 205201"},
        {"\"bytes\": 0", "\"bytes\": -7"},
        {"\"tiles\": 0", "\"tiles\": 0.5"},
    };
    for (const auto& [said, falsified] : kFalse) {
        CAPTURE(falsified);
        std::string changed = text;
        REQUIRE(changed.find(said) != std::string::npos);
        changed.replace(changed.find(said), said.size(), falsified);
        CHECK_FALSE(terrain_info_from_json(*ridgeline::test::sealed(changed)).ok());
    }
}

TEST_CASE("terrain.json: lists in lists without end are refused, not followed") {
    for (const std::size_t depth : {100u, 300'000u}) {
        const std::string nested = std::string(depth, '[') + std::string(depth, ']');
        const std::string text = "{\"format\": \"ridgeline-terrain\", \"version\": 2, \"x\": " + nested + "}";
        const auto refused = terrain_info_from_json(text);
        REQUIRE_FALSE(refused);
        CHECK(refused.error().message == "damaged: not JSON");
    }
}

TEST_CASE("terrain.json: every change of what it says is refused, none of how it is laid out") {
    const std::string text = to_json(example());
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] < '0' || text[at] > '9') continue;
        std::string changed = text;
        changed[at] = changed[at] == '7' ? '3' : '7';
        CHECK_FALSE(terrain_info_from_json(changed).ok());
    }
    std::string without = text;
    without.replace(without.find("\"checksum\""), 10, "\"checkmate\"");
    CHECK_FALSE(terrain_info_from_json(without).ok());
    std::string airy;
    for (const char c : text) airy += c == ':' ? std::string(" : \n") : std::string(1, c);
    CHECK(terrain_info_from_json(airy).ok());
}

TEST_CASE("terrain.json: nonsense is refused") {
    for (const char* nonsense :
         {"", "[]", "{}", "null", "{\"format\": \"ridgeline-terrain\", \"version\": 2}"})
        CHECK_FALSE(terrain_info_from_json(nonsense).ok());
    TerrainInfo info = example();
    info.spacing_x_m = 0.0;
    CHECK_FALSE(terrain_info_from_json(to_json(info)).ok());
}
