#include "ridgeline/base/whole_file.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
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

TEST_CASE("a link stays a link, and what it leads to is replaced, be it there or not") {
    const auto folder = empty_folder();
    fs::create_directory(folder / "elsewhere");
    REQUIRE(write_whole_file(folder / "elsewhere" / "target", std::string_view("old")));
    fs::create_symlink("elsewhere/target", folder / "link");
    fs::create_symlink("link", folder / "link to it");
    fs::create_symlink("elsewhere/new", folder / "dangling");
    REQUIRE(write_whole_file(folder / "link to it", std::string_view("new")));
    REQUIRE(write_whole_file(folder / "dangling", std::string_view("made")));
    for (const char* name : {"link", "link to it", "dangling"}) CHECK(fs::is_symlink(folder / name));
    CHECK(*read_text_file(folder / "elsewhere" / "target") == "new");
    CHECK(*read_text_file(folder / "elsewhere" / "new") == "made");
    CHECK(std::distance(fs::directory_iterator(folder / "elsewhere"), {}) == 2);
}

TEST_CASE("a pipe or a device is written into and stays what it is") {
    const auto folder = empty_folder();
    const auto pipe = folder / "pipe";
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    // Its other end, so that opening and writing need not wait.
    const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
    REQUIRE(reader >= 0);
    REQUIRE(write_whole_file(pipe, std::string_view("through")));
    CHECK(fs::is_fifo(pipe));
    std::string got(16, '\0');
    got.resize(static_cast<std::size_t>(std::max<ssize_t>(::read(reader, got.data(), got.size()), 0)));
    ::close(reader);
    CHECK(got == "through");
    fs::create_symlink("/dev/null", folder / "null");
    REQUIRE(write_whole_file(folder / "null", std::string_view("away")));
    CHECK(fs::is_character_file(folder / "null"));
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
