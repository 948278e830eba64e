// A store on disk, cut and damaged in every way: never a crash, never a wrong height, always one clear line.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "ridgeline/io/store.h"
#include "support/small_store.h"

using namespace ridgeline;
using namespace ridgeline::io;
namespace fs = std::filesystem;

namespace {

std::string content(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
void write(const fs::path& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

Result<void> open_and_verify(const fs::path& directory) {
    auto store = Store::open(directory);
    if (!store) return store.error();
    return verify_store(*store, [](std::int64_t, std::int64_t) {});
}

}  // namespace

TEST_CASE("store: whole, it verifies") {
    const test::SmallStore small(
        test::ReferenceTerrain(Grid(129, 100, 32), test::ReferenceTerrain::random_hills(1, 30, 3)));
    const auto verified = open_and_verify(small.directory());
    if (!verified) FAIL(verified.error().message);
}

TEST_CASE("store: cut at any length, every file's damage is found") {
    const test::SmallStore small(
        test::ReferenceTerrain(Grid(65, 65, 32), test::ReferenceTerrain::random_hills(1, 30, 3)));
    for (const char* name : {"terrain.json", "nodes.bin", "heights.tiles", "mesh.tiles"}) {
        const fs::path file = small.directory() / name;
        const std::string whole = content(file);
        // terrain.json ends in a brace and a line end; without the line end it is still whole.
        for (std::size_t size = 0; size + 1 < whole.size(); ++size) {
            write(file, whole.substr(0, size));
            const auto checked = open_and_verify(small.directory());
            REQUIRE_FALSE(checked);
            CHECK(checked.error().message.find('\n') == std::string::npos);
        }
        write(file, whole);
    }
    CHECK(open_and_verify(small.directory()));
}

TEST_CASE("store: a flipped bit of the table or of a payload is found") {
    const test::SmallStore small(
        test::ReferenceTerrain(Grid(65, 65, 32), test::ReferenceTerrain::random_hills(2, 30, 3)));
    for (const char* name : {"nodes.bin", "heights.tiles", "mesh.tiles"}) {
        const fs::path file = small.directory() / name;
        const std::string whole = content(file);
        for (std::size_t bit = 0; bit < whole.size() * 8; bit += 7) {
            std::string damaged = whole;
            damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
            write(file, damaged);
            CHECK_FALSE(open_and_verify(small.directory()).ok());
        }
        write(file, whole);
    }
}

TEST_CASE("store: what terrain.json sums up wrongly is found, though its checksum fits") {
    const test::SmallStore small(
        test::ReferenceTerrain(Grid(100, 70, 32), test::ReferenceTerrain::random_hills(3, 30, 3)));
    const fs::path file = small.directory() / "terrain.json";
    const auto whole = terrain_info_from_json(content(file));
    REQUIRE(whole);
    const std::vector<std::function<void(TerrainInfo&)>> falsifications = {
        [](TerrainInfo& info) { info.triangles -= 5; },
        [](TerrainInfo& info) { info.invalid_samples = 77; },
        [](TerrainInfo& info) { info.heights_tiles += 1; },
        [](TerrainInfo& info) { info.heights_bytes = 7; },
        [](TerrainInfo& info) { info.mesh_tiles -= 1; },
        [](TerrainInfo& info) { info.mesh_bytes += 1; },
        [](TerrainInfo& info) { info.min_height_m -= 1.0; },
        [](TerrainInfo& info) { info.max_height_m += 1.0; },
    };
    for (std::size_t i = 0; i < falsifications.size(); ++i) {
        TerrainInfo info = *whole;
        falsifications[i](info);
        write(file, to_json(info));
        const auto checked = open_and_verify(small.directory());
        INFO(i);
        REQUIRE_FALSE(checked);
        CHECK(checked.error().message.find("terrain.json") != std::string::npos);
    }
    write(file, to_json(*whole));
    CHECK(open_and_verify(small.directory()));
}

TEST_CASE("store: bytes behind a layer's last tile are found") {
    const test::SmallStore small(
        test::ReferenceTerrain(Grid(100, 70, 32), test::ReferenceTerrain::random_hills(4, 30, 3)));
    for (const char* name : {"heights.tiles", "mesh.tiles"}) {
        const fs::path file = small.directory() / name;
        const std::string whole = content(file);
        write(file, whole + "five.");
        const auto checked = open_and_verify(small.directory());
        REQUIRE_FALSE(checked);
        CHECK(checked.error().message.find(name) != std::string::npos);
        write(file, whole);
    }
}
