// Imagery and the store around it: added, replaced, damaged, interrupted; and what a store without it is.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>

#include <filesystem>
#include <fstream>

#include "ridgeline/build/imagery/imagery_layer.h"
#include "support/small_imagery.h"
#include "support/small_store.h"
#include "unit/build_fixture.h"

using namespace ridgeline;
using build::Texel;
namespace fs = std::filesystem;

namespace {

test::SmallStore small_store() {
    return test::SmallStore(
        test::ReferenceTerrain(io::Grid(65, 65, 32), test::ReferenceTerrain::random_hills(1, 30, 3)));
}

Texel waves(std::int64_t x, std::int64_t y) {
    return {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), static_cast<std::uint8_t>(x * y),
            (x / 50 + y / 70) % 7 == 1 ? std::uint8_t{0} : build::kOpaque};
}

test::MemoryTexels picture(std::int64_t width, std::int64_t height, std::uint8_t tone = 0) {
    io::ImageryInfo frame;
    frame.width = width;
    frame.height = height;
    return test::MemoryTexels(frame, [tone](std::int64_t x, std::int64_t y) {
        Texel texel = waves(x, y);
        texel.blue = static_cast<std::uint8_t>(texel.blue + tone);
        return texel;
    });
}

Result<void> open_and_verify(const fs::path& directory) {
    auto store = io::Store::open(directory);
    if (!store) return store.error();
    return io::verify_store(*store, [](std::int64_t, std::int64_t) {});
}

std::string content(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
void write(const fs::path& file, const std::string& bytes) {
    // What a store shares with another by a link must not change with it.
    fs::remove(file);
    std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace

TEST_CASE("imagery: a store keeps everything else byte by byte, and may change its imagery") {
    const auto small = small_store();
    const auto before = test::file_contents(small.directory());
    auto first = picture(300, 280);
    test::add_imagery(small.directory(), first);
    auto with = test::file_contents(small.directory());
    CHECK(with.size() == before.size() + 2);
    for (const char* name : {"nodes.bin", "heights.tiles", "mesh.tiles"})
        CHECK(with[name] == before.at(name));
    auto second = picture(511, 97, 40);
    test::add_imagery(small.directory(), second);
    const auto store = io::Store::open(small.directory());
    REQUIRE(store);
    CHECK(store->info().imagery->width == 511);
    CHECK(open_and_verify(small.directory()));
    // Nothing lies beside it.
    for (const auto& entry : fs::directory_iterator(small.directory().parent_path()))
        CHECK(entry.path().filename().string().find(small.directory().filename().string() + ".") ==
              std::string::npos);
    CHECK_FALSE(io::StoreUpdate::begin(small.directory(), io::Replace::never).ok());
}

TEST_CASE("imagery: who has the old store open goes on reading it") {
    const auto small = small_store();
    auto first = picture(300, 280), second = picture(300, 280, 90);
    test::add_imagery(small.directory(), first);
    const auto old = io::Store::open(small.directory());
    REQUIRE(old);
    const auto before = test::read_tile(*old, {0, 0, 0});
    test::add_imagery(small.directory(), second);
    CHECK(test::read_tile(*old, {0, 0, 0}) == before);
    std::vector<std::uint8_t> bytes;
    io::HeightsTile tile;
    CHECK(old->read_heights({0, 0, 0}, bytes, tile));
    const auto fresh = io::Store::open(small.directory());
    REQUIRE(fresh);
    CHECK(test::read_tile(*fresh, {0, 0, 0}) != before);
}

TEST_CASE("imagery: killed at any moment, the old store stands or the new one does") {
    const auto small = small_store();
    auto first = picture(300, 280);
    test::add_imagery(small.directory(), first);
    const auto old = test::file_contents(small.directory());
    // System calls until it is over are counted by trial: killed after so many steps of a writer that stops
    // at each.
    for (int steps = 0; steps < 12; ++steps) {
        const pid_t child = ::fork();
        REQUIRE(child >= 0);
        if (child == 0) {
            int left = steps;
            const auto step = [&left] {
                if (left-- == 0) ::kill(::getpid(), SIGKILL);
            };
            // One thread of a forked program: the tiles are made before, here only written.
            auto update = io::StoreUpdate::begin(small.directory(), io::Replace::existing);
            step();
            io::ImageryInfo info = update->info().imagery.value();
            auto writer = io::ImageryWriter::create(update->directory(), update->scratch(), info.grid());
            step();
            const std::vector<io::Bc1Block> blocks(io::kImageryBlockCount, {40000, 20000, 7});
            io::ImageryScratch scratch;
            std::vector<std::uint8_t> payload;
            io::encode_imagery(blocks, scratch, payload);
            for (std::int64_t i = 0; i < info.grid().node_count(); ++i) {
                static_cast<void>(writer->put(info.grid().node_at(i), payload, io::Holes::none));
                if (i < 5) step();
            }
            static_cast<void>(writer->finish(info, [&](std::int64_t, std::int64_t) {
                step();
                return true;
            }));
            step();
            static_cast<void>(update->finish(info));
            step();
            ::_exit(0);
        }
        int status = 0;
        REQUIRE(::waitpid(child, &status, 0) == child);
        const auto now = test::file_contents(small.directory());
        const bool changed = now != old;
        CHECK(open_and_verify(small.directory()));
        if (WIFSIGNALED(status) && changed) CHECK(steps >= 8);
        if (!WIFSIGNALED(status)) CHECK(changed);
        if (changed) break;
    }
    // What was left behind goes with the next update.
    test::add_imagery(small.directory(), first);
    CHECK(test::file_contents(small.directory()) == old);
    const std::string prefix = small.directory().filename().string() + ".partial";
    for (const auto& entry : fs::directory_iterator(small.directory().parent_path()))
        CHECK(entry.path().filename().string().rfind(prefix, 0) != 0);
}

TEST_CASE("imagery: a store that another took the place of meanwhile is left alone") {
    const auto small = small_store();
    auto update = io::StoreUpdate::begin(small.directory(), io::Replace::existing);
    REQUIRE(update);
    auto rows = picture(300, 280);
    test::add_imagery(small.directory(), rows);
    const auto standing = test::file_contents(small.directory());
    auto writer = io::ImageryWriter::create(update->directory(), update->scratch(), rows.info().grid());
    REQUIRE(writer);
    io::ImageryInfo info = rows.info();
    REQUIRE(writer->finish(info));
    const auto finished = update->finish(info);
    REQUIRE_FALSE(finished);
    CHECK(finished.error().message.find("changed meanwhile") != std::string::npos);
    CHECK(test::file_contents(small.directory()) == standing);
}

TEST_CASE("imagery: with the heights or after them, the store is the same") {
    const test::ScratchFolder folder;
    const test::Case c{140, 77, 65, false, 3};
    auto rows = test::rows_of(c);
    auto texels = picture(700, 400);
    const auto together =
        build::build_from_rows(rows, test::options_for(c, folder.path() / "a.terrain"), &texels);
    if (!together) FAIL(together.error().message);
    CHECK(together->info.imagery.has_value());
    REQUIRE(build::build_from_rows(rows, test::options_for(c, folder.path() / "b.terrain")));
    test::add_imagery(folder.path() / "b.terrain", texels);
    CHECK(test::file_contents(folder.path() / "a.terrain") ==
          test::file_contents(folder.path() / "b.terrain"));
    CHECK(folder.entries() == std::vector<std::string>{"a.terrain", "b.terrain"});
}

TEST_CASE(
    "imagery: what cannot be read, is stopped or finds no memory leaves nothing and says so in a line") {
    const test::ScratchFolder folder;
    const test::Case c{140, 77, 65, false, 3};
    auto rows = test::rows_of(c);
    auto options = test::options_for(c, folder.path() / "a.terrain");
    for (const std::int64_t at : {0, 260, 516}) {
        auto texels = picture(300, 700);
        texels.on_read = [at](std::int64_t row) {
            return row < at ? Result<void>() : Result<void>(Error{"picture.tif: cannot be read"});
        };
        const auto failed = build::build_from_rows(rows, options, &texels);
        REQUIRE_FALSE(failed);
        CHECK(failed.error().message == "picture.tif: cannot be read");
        CHECK(folder.entries().empty());
    }
    std::atomic<bool> stop = false;
    options.stop = &stop;
    auto stopped = picture(300, 700);
    stopped.on_read = [&](std::int64_t row) {
        stop = row > 300;
        return Result<void>();
    };
    const auto early = build::build_from_rows(rows, options, &stopped);
    REQUIRE_FALSE(early);
    CHECK(early.error().message.find("stopped before it was complete") != std::string::npos);
    CHECK(folder.entries().empty());

    stop = false;
    options.memory_bytes = 80_MiB;
    auto wide = picture(40000, 10);
    const auto poor = build::build_from_rows(rows, options, &wide);
    REQUIRE_FALSE(poor);
    CHECK(poor.error().message.find("use --memory ") != std::string::npos);
    auto nothing = test::MemoryTexels(picture(300, 300).info(), [](auto, auto) { return Texel{}; });
    options.memory_bytes = 1_GiB;
    const auto empty = build::build_from_rows(rows, options, &nothing);
    REQUIRE_FALSE(empty);
    CHECK(empty.error().message == "memory: no imagery at all within the terrain");
    CHECK(folder.entries().empty());
}

TEST_CASE("imagery: cut at any length, its table's and a payload's damage is found in one line") {
    const auto small = small_store();
    auto rows = picture(40, 30);
    test::add_imagery(small.directory(), rows);
    for (const char* name : {"imagery.bin", "imagery.tiles"}) {
        const fs::path file = small.directory() / name;
        const std::string whole = content(file);
        for (std::size_t size = 0; size < whole.size(); ++size) {
            write(file, whole.substr(0, size));
            const auto checked = open_and_verify(small.directory());
            REQUIRE_FALSE(checked);
            CHECK(checked.error().message.find('\n') == std::string::npos);
        }
        fs::remove(file);
        CHECK_FALSE(open_and_verify(small.directory()).ok());
        write(file, whole + "five.");
        CHECK_FALSE(open_and_verify(small.directory()).ok());
        write(file, whole);
    }
    CHECK(open_and_verify(small.directory()));
}

TEST_CASE("a store that lacks a file, or holds a folder in its place, says what to build again") {
    const auto small = small_store();
    auto rows = picture(40, 30);
    test::add_imagery(small.directory(), rows);
    for (const std::string name :
         {"nodes.bin", "heights.tiles", "mesh.tiles", "imagery.bin", "imagery.tiles"}) {
        const fs::path file = small.directory() / name;
        const std::string whole = content(file);
        const std::string mend =
            ": build the " + std::string(name.starts_with("imagery") ? "imagery" : "terrain") + " again";
        const auto check = [&](const std::string& why) {
            const auto opened = io::Store::open(small.directory());
            REQUIRE_FALSE(opened);
            CHECK(opened.error().message.starts_with(file.string() + ": " + why));
            CHECK(opened.error().message.ends_with(mend));
        };
        fs::remove(file);
        check("No such file or directory");
        fs::create_directory(file);
        check("");
        fs::remove(file);
        write(file, whole);
    }
    CHECK(open_and_verify(small.directory()));
}

TEST_CASE("imagery: a flipped bit of its table or of a payload is found") {
    const auto small = small_store();
    auto rows = picture(400, 300);
    test::add_imagery(small.directory(), rows);
    for (const char* name : {"imagery.bin", "imagery.tiles"}) {
        const fs::path file = small.directory() / name;
        const std::string whole = content(file);
        const std::size_t stride = whole.size() > 1000 ? 977 : 1;
        for (std::size_t bit = 0; bit < whole.size() * 8; bit += stride) {
            std::string damaged = whole;
            damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
            write(file, damaged);
            CHECK_FALSE(open_and_verify(small.directory()).ok());
        }
        write(file, whole);
    }
}

TEST_CASE(
    "imagery: a store whose terrain is damaged is refused before any work, one whose imagery is, mended") {
    const auto small = small_store();
    auto rows = picture(400, 300);
    test::add_imagery(small.directory(), rows);
    for (const char* name : {"nodes.bin", "heights.tiles", "mesh.tiles"}) {
        const fs::path file = small.directory() / name;
        const std::string whole = content(file);
        write(file, whole.substr(0, whole.size() / 2));
        const auto update = io::StoreUpdate::begin(small.directory(), io::Replace::existing);
        REQUIRE(!update);
        CHECK(update.error().message.find("build the terrain again") != std::string::npos);
        write(file, whole);
    }
    write(small.directory() / "imagery.bin", "damaged");
    CHECK(io::StoreUpdate::begin(small.directory(), io::Replace::existing).ok());
}

TEST_CASE("imagery: what terrain.json or a record says wrongly is found, though checksums fit") {
    const auto small = small_store();
    auto rows = picture(400, 300);
    test::add_imagery(small.directory(), rows);
    const fs::path info_file = small.directory() / "terrain.json", table = small.directory() / "imagery.bin";
    const std::string whole_info = content(info_file), whole_table = content(table);
    const auto info = io::terrain_info_from_json(whole_info);
    REQUIRE(info);
    const std::vector<std::function<void(io::ImageryInfo&)>> falsifications = {
        [](io::ImageryInfo& imagery) { imagery.tiles += 1; },
        [](io::ImageryInfo& imagery) { imagery.bytes -= 1; },
        [](io::ImageryInfo& imagery) { imagery.width = 900; },
        [](io::ImageryInfo& imagery) { imagery.height = 0; },
        [](io::ImageryInfo& imagery) { imagery.spacing_x_m = -1; }};
    for (const auto& falsify : falsifications) {
        io::TerrainInfo changed = *info;
        falsify(*changed.imagery);
        write(info_file, io::to_json(changed));
        CHECK_FALSE(open_and_verify(small.directory()).ok());
    }
    write(info_file, whole_info);

    const std::vector<std::function<void(io::ImageryRecord&)>> bad_records = {
        [](io::ImageryRecord& record) { record.flags ^= io::ImageryRecord::kHasHoles; },
        [](io::ImageryRecord& record) { record.flags = 0; },
        [](io::ImageryRecord& record) { record.flags |= 4; },
        [](io::ImageryRecord& record) { record.size += 1; },
        [](io::ImageryRecord& record) { record.offset += 1u << 30; },
        [](io::ImageryRecord& record) { record.checksum += 1; }};
    const auto count = static_cast<std::size_t>(info->imagery->grid().node_count());
    for (std::size_t node = 0; node < count; ++node)
        for (const auto& damage : bad_records) {
            std::vector<io::ImageryRecord> records(count);
            std::memcpy(records.data(), whole_table.data() + sizeof(io::ImageryHeader),
                        count * sizeof records[0]);
            damage(records[node]);
            io::ImageryHeader header;
            header.record_count = count;
            const std::size_t bytes = count * sizeof records[0];
            header.checksum =
                io::payload_checksum({reinterpret_cast<const std::uint8_t*>(records.data()), bytes});
            std::string damaged(reinterpret_cast<const char*>(&header), sizeof header);
            damaged.append(reinterpret_cast<const char*>(records.data()), bytes);
            write(table, damaged);
            CHECK_FALSE(open_and_verify(small.directory()).ok());
        }
    write(table, whole_table);
    CHECK(open_and_verify(small.directory()));
}
