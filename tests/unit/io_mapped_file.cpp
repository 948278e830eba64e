// A mapped file: what was looked at can be given back, and reads the same afterwards.
#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "ridgeline/io/mapped_file.h"

using namespace ridgeline;

namespace {

// Resident bytes of the mapping that begins at an address, as the system tells.
std::size_t resident_bytes(const void* address) {
    std::ifstream maps("/proc/self/smaps");
    std::string line;
    char start[32] = {};
    std::snprintf(start, sizeof start, "%lx-", reinterpret_cast<unsigned long>(address));
    while (std::getline(maps, line) && !line.starts_with(start)) {
    }
    while (std::getline(maps, line))
        if (line.starts_with("Rss:")) return std::stoul(line.substr(4)) * 1024;
    return 0;
}

}  // namespace

TEST_CASE("mapped file: pages that were looked at are given back, and come again unchanged") {
    constexpr std::size_t kBytes = std::size_t{4} << 20;
    const auto path =
        std::filesystem::temp_directory_path() / ("ridgeline-mapped-" + std::to_string(::getpid()));
    {
        const std::string text(kBytes, 'r');
        std::ofstream(path) << text;
    }
    {
        const auto file = io::MappedFile::open(path);
        REQUIRE(file);
        const auto all_r = [&] {
            return std::ranges::count(file->bytes(), std::byte{'r'}) == static_cast<std::ptrdiff_t>(kBytes);
        };
        CHECK(all_r());
        CHECK(resident_bytes(file->bytes().data()) >= kBytes);
        file->forget_pages();
        CHECK(resident_bytes(file->bytes().data()) == 0);
        CHECK(all_r());
    }
    std::filesystem::remove(path);
    io::MappedFile().forget_pages();
}
