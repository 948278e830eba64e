#include "ridgeline/base/whole_file.h"

#include <doctest/doctest.h>

#include <string>

namespace ridgeline {
namespace {

namespace fs = std::filesystem;

fs::path empty_folder() {
    const auto folder = fs::temp_directory_path() / "ridgeline_whole_file_test";
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
}

TEST_CASE("a whole file replaces what stood there and leaves nothing beside it") {
    const auto folder = empty_folder();
    const auto file = folder / "a.txt";
    const std::string large(3'000'000, 'x');
    REQUIRE(write_whole_file(file, std::string_view("first")));
    REQUIRE(write_whole_file(file, large));
    CHECK(*read_text_file(file) == large);
    CHECK(std::distance(fs::directory_iterator(folder), {}) == 1);
}

TEST_CASE("what cannot be written or read says which file and why") {
    const auto folder = empty_folder();
    const auto written = write_whole_file(folder / "none" / "a.txt", std::string_view("x"));
    REQUIRE_FALSE(written);
    CHECK(written.error().message.find("none/a.txt: No such file") != std::string::npos);
    CHECK_FALSE(read_text_file(folder / "missing"));
    CHECK_FALSE(read_text_file(folder));
    REQUIRE(write_whole_file(folder / "b", std::string_view("12345")));
    CHECK_FALSE(read_text_file(folder / "b", 4));
}

}  // namespace
}  // namespace ridgeline
