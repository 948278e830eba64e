// Where the real terrain for tests lies: the folder named by RIDGELINE_DATA, else ../shared/data beside the
// checkout. Tests that need it call data_file() and return when it is empty, which prints that they were
// skipped.
#pragma once

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace ridgeline::test {

inline std::filesystem::path data_file(const std::string& name) {
    const char* root = std::getenv("RIDGELINE_DATA");
    const auto base =
        root ? std::filesystem::path(root) : std::filesystem::path(RIDGELINE_SOURCE_DIR) / "../shared/data";
    const auto file = base / name;
    if (std::filesystem::exists(file)) return std::filesystem::canonical(file);
    MESSAGE("skipped: no ", name, " (set RIDGELINE_DATA)");
    return {};
}

}  // namespace ridgeline::test
