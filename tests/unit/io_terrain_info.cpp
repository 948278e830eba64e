#include <doctest/doctest.h>

#include "ridgeline/io/terrain_info.h"

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

TEST_CASE("terrain.json: nonsense is refused") {
    for (const char* nonsense :
         {"", "[]", "{}", "null", "{\"format\": \"ridgeline-terrain\", \"version\": 2}"})
        CHECK_FALSE(terrain_info_from_json(nonsense).ok());
    TerrainInfo info = example();
    info.spacing_x_m = 0.0;
    CHECK_FALSE(terrain_info_from_json(to_json(info)).ok());
}
