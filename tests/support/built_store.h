// A store built from a raster, for tests over real terrain.
#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <utility>

#include "ridgeline/build/builder.h"
#include "ridgeline/io/store.h"

namespace ridgeline::test {

inline io::Store built_store(const std::string& source, const std::filesystem::path& place) {
    build::BuildOptions options;
    options.sources = {source};
    options.out = place;
    const auto report = build::build_terrain(options);
    REQUIRE_MESSAGE(report.ok(), (report.ok() ? "" : report.error().message));
    auto store = io::Store::open(place);
    REQUIRE(store.ok());
    return std::move(store).value();
}

}  // namespace ridgeline::test
