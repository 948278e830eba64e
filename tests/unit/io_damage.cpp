// A store on disk, cut and damaged in every way: never a crash, never a wrong height, always one clear line.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

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
            // The header's reserved word says nothing.
            if (std::string_view(name) == "nodes.bin" && bit / 8 >= 12 && bit / 8 < 16) continue;
            std::string damaged = whole;
            damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
            write(file, damaged);
            CHECK_FALSE(open_and_verify(small.directory()).ok());
        }
        write(file, whole);
    }
}
