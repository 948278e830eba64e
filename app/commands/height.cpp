// ridgeline height: the height of the finest level at places that the user names.
#include <cstdio>
#include <memory>
#include <vector>

#include "ridgeline/app/command.h"
#include "ridgeline/app/options.h"
#include "ridgeline/io/store.h"
#include "ridgeline/raster/transform.h"
#include "ridgeline/select/surface_query.h"

namespace ridgeline::app {
namespace {

struct HeightOptions {
    std::filesystem::path directory;
    std::vector<glm::dvec2> places;
    std::string crs;  // of the places; empty: the store's
    int detail_levels = 0;
};

Result<std::vector<glm::dvec2>> places_in_store(const HeightOptions& options, const io::TerrainInfo& info) {
    if (options.crs.empty()) return options.places;
    if (info.crs_wkt.empty())
        return Error{options.directory.string() + ": has no coordinate system, so --crs cannot be used"};
    return raster::transform_places(options.crs, info.crs_wkt, options.places);
}

Error outside(const HeightOptions& options, glm::dvec2 place, const io::TerrainInfo& info) {
    char text[200];
    std::snprintf(text, sizeof text, "%.3f,%.3f lies outside: east %.3f to %.3f, north %.3f to %.3f", place.x,
                  place.y, info.min_east_m(), info.max_east_m(), info.min_north_m(), info.max_north_m());
    return Error{options.directory.string() + ": " + text};
}

Result<int> parse_detail_levels(const std::string& text) {
    const auto levels = parse_integer(text, {0, io::DetailInfo::kMostOctaves});
    if (!levels) return levels.error();
    return static_cast<int>(*levels);
}

Result<void> check_detail(const HeightOptions& options, const io::TerrainInfo& info) {
    if (options.detail_levels == 0 ||
        (info.detail && options.detail_levels <= static_cast<int>(info.detail->octaves.size())))
        return {};
    return Error{options.directory.string() +
                 ": says nothing of ground finer than its source, for --detail: build it again"};
}

// All heights before any is printed: a place outside is a failure with nothing printed.
Result<void> print_heights(const HeightOptions& options) {
    const auto store = io::Store::open_terrain(options.directory);
    if (!store) return store.error();
    const auto places = places_in_store(options, store->info());
    if (!places) return places.error();

    RIDGELINE_TRY(check_detail(options, store->info()));
    select::SurfaceQuery query(*store, {.detail_levels = options.detail_levels});
    std::vector<select::SurfaceHeight> heights;
    for (const glm::dvec2& place : *places) {
        const auto height = query.height(place.x, place.y);
        if (!height) return height.error();
        if (height->kind == select::SurfaceHeight::Kind::outside)
            return outside(options, place, store->info());
        heights.push_back(*height);
    }
    for (const select::SurfaceHeight& height : heights) {
        if (height.kind == select::SurfaceHeight::Kind::nodata)
            std::puts("nodata");
        else
            std::printf("%.3f\n", height.height_m);
    }
    return {};
}

}  // namespace

void add_height(Program& program) {
    auto options = std::make_shared<HeightOptions>();
    const Syntax syntax =
        program.add("height", "Print the height at places, in metres, one a line",
                    "ridgeline height alps.terrain --at 500000,5205000 --at 500100,5205000");
    add_store(syntax, options->directory);
    add_values(syntax, "--at", options->places, "EAST,NORTH", "A place; may be repeated, and take several",
               parse_place)
        .required();
    add_value(syntax, "--crs", options->crs, "EPSG:n", "The places' coordinate system; none: the store's",
              parse_crs);
    add_value(syntax, "--detail", options->detail_levels, "LEVELS",
              "Of the ground made below the source, at up to so many times twice its samples",
              parse_detail_levels)
        .shown_default("0");
    program.runs("height", [options](const RunContext&) { return print_heights(*options); });
}

}  // namespace ridgeline::app
