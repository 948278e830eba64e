// ridgeline info: what a store holds, for people or as JSON.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "ridgeline/app/command.h"
#include "ridgeline/base/json_text.h"
#include "ridgeline/base/units.h"
#include "ridgeline/io/store.h"
#include "ridgeline/raster/crs_name.h"

namespace ridgeline::app {
namespace {

struct InfoOptions {
    std::filesystem::path directory;
    bool json = false;
};

nlohmann::json layer_json(const io::TerrainInfo& info, std::int64_t tiles, std::int64_t bytes) {
    return {{"tiles", tiles},
            {"bytes", bytes},
            {"levels", info.grid().levels()},
            {"spacing_m", {info.spacing_x_m, info.spacing_y_m}}};
}

nlohmann::json imagery_layer_json(const io::ImageryInfo& imagery) {
    return {{"tiles", imagery.tiles},
            {"bytes", imagery.bytes},
            {"levels", imagery.grid().levels()},
            {"spacing_m", {imagery.spacing_x_m, imagery.spacing_y_m}},
            {"texels", {imagery.width, imagery.height}},
            {"bounds", {imagery.west_m, imagery.south_m(), imagery.east_m(), imagery.north_m}}};
}

nlohmann::json layers_json(const io::TerrainInfo& info) {
    nlohmann::json layers = {{"heights", layer_json(info, info.heights_tiles, info.heights_bytes)},
                             {"mesh", layer_json(info, info.mesh_tiles, info.mesh_bytes)}};
    if (info.imagery) layers["imagery"] = imagery_layer_json(*info.imagery);
    return layers;
}

nlohmann::json provenance_json(const io::TerrainInfo& info) {
    nlohmann::json provenance = {
        {"sources", info.sources}, {"notes", info.notes}, {"generator", info.generator}};
    if (info.imagery)
        provenance["imagery"] = {{"sources", info.imagery->sources},
                                 {"notes", info.imagery->notes},
                                 {"generator", info.imagery->generator}};
    return provenance;
}

nlohmann::json detail_json(const io::DetailInfo& detail) {
    nlohmann::json gains = nlohmann::json::array();
    for (const io::DetailGains& octave : detail.octaves)
        gains.push_back({octave.face_slope, octave.face_roughness, octave.edge_slope, octave.edge_roughness});
    return {{"face_residual_m", detail.face_residual_m},
            {"edge_residual_m", detail.edge_residual_m},
            {"gains", gains}};
}

nlohmann::json info_json(const io::TerrainInfo& info) {
    const io::Grid grid = info.grid();
    const raster::CrsName crs = raster::name_of_crs(info.crs_wkt);
    nlohmann::json json = {
        {"crs", info.crs_wkt},
        {"crs_name", crs.name},
        {"crs_authority", crs.authority},
        {"bounds", {info.min_east_m(), info.min_north_m(), info.max_east_m(), info.max_north_m()}},
        {"samples", {info.width, info.height}},
        {"levels", grid.levels()},
        {"roots", {grid.nodes_x(0), grid.nodes_y(0)}},
        {"tile", info.tile},
        {"spacing_m", {info.spacing_x_m, info.spacing_y_m}},
        {"quantum_m", info.quantum_m},
        {"height_range_m", {info.min_height_m, info.max_height_m}},
        {"layers", layers_json(info)},
        {"triangles", info.triangles},
        {"metric", info.metric},
        {"thresholds_m", info.thresholds_m},
        {"invalid_samples", info.invalid_samples},
        {"provenance", provenance_json(info)}};
    if (info.detail) json["detail"] = detail_json(*info.detail);
    return json;
}

// WGS 84 / UTM zone 33N (EPSG:32633).
std::string shown_crs(const std::string& wkt) {
    const raster::CrsName crs = raster::name_of_crs(wkt);
    return crs.authority.empty() ? crs.name : crs.name + " (" + crs.authority + ")";
}

// How rough the source is at its three finest spacings, and what is foretold of finer ground.
void print_detail(const io::DetailInfo& detail, const io::TerrainInfo& info) {
    const auto& residual_m = detail.face_residual_m;
    std::printf("  %-10s residual %.3g m at %.4g m, %.3g m at %.4g m, %.3g m at %.4g m; %s foretold\n",
                "detail", residual_m[0], info.spacing_x_m, residual_m[1], 2.0 * info.spacing_x_m,
                residual_m[2], 4.0 * info.spacing_x_m,
                counted(static_cast<std::int64_t>(detail.octaves.size()), "octave").c_str());
}

void print_layer(const char* name, const io::TerrainInfo& info, std::int64_t tiles, std::int64_t bytes) {
    std::printf("  %-10s %s, %s, %s\n", name, counted(tiles, "tile").c_str(),
                format_bytes(static_cast<std::uint64_t>(bytes)).c_str(),
                counted(info.grid().levels(), "level").c_str());
}

void print_imagery(const io::ImageryInfo& imagery) {
    std::printf("  %-10s %s, %s, %s, %lld x %lld texels, %g x %g m apart\n", "imagery",
                counted(imagery.tiles, "tile").c_str(),
                format_bytes(static_cast<std::uint64_t>(imagery.bytes)).c_str(),
                counted(imagery.grid().levels(), "level").c_str(), static_cast<long long>(imagery.width),
                static_cast<long long>(imagery.height), imagery.spacing_x_m, imagery.spacing_y_m);
}

void print_info(const std::string& name, const io::TerrainInfo& info) {
    const io::Grid grid = info.grid();
    std::printf("%s\n", name.c_str());
    std::printf("  %-10s %lld x %lld, %g x %g m apart, heights in steps of %g m\n", "samples",
                static_cast<long long>(info.width), static_cast<long long>(info.height), info.spacing_x_m,
                info.spacing_y_m, info.quantum_m);
    std::printf("  %-10s %s\n", "crs", shown_crs(info.crs_wkt).c_str());
    std::printf("  %-10s east %.3f to %.3f, north %.3f to %.3f\n", "bounds", info.min_east_m(),
                info.max_east_m(), info.min_north_m(), info.max_north_m());
    std::printf("  %-10s %.2f to %.2f m, %lld samples without\n", "heights", info.min_height_m,
                info.max_height_m, static_cast<long long>(info.invalid_samples));
    std::printf("  %-10s %s over %d x %d roots, tiles of %d x %d samples\n", "quadtree",
                counted(grid.levels(), "level").c_str(), grid.nodes_x(0), grid.nodes_y(0), info.tile,
                info.tile);
    print_layer("heights", info, info.heights_tiles, info.heights_bytes);
    print_layer("mesh", info, info.mesh_tiles, info.mesh_bytes);
    if (info.imagery) print_imagery(*info.imagery);
    if (info.detail) print_detail(*info.detail, info);
    std::printf("  %-10s %lld, metric %s\n", "triangles", static_cast<long long>(info.triangles),
                info.metric.c_str());
    for (const std::string& source : info.sources) std::printf("  %-10s %s\n", "source", source.c_str());
    for (const std::string& note : info.notes) std::printf("  %-10s %s\n", "note", note.c_str());
    if (!info.imagery) return;
    for (const std::string& source : info.imagery->sources)
        std::printf("  %-10s %s\n", "picture", source.c_str());
    for (const std::string& note : info.imagery->notes) std::printf("  %-10s %s\n", "note", note.c_str());
}

Result<void> show_info(const InfoOptions& options) {
    const auto store = io::Store::open(options.directory);
    if (!store) return store.error();
    if (options.json)
        std::printf("%s\n", json_text(info_json(store->info()), 2).c_str());
    else
        print_info(options.directory.string(), store->info());
    return {};
}

}  // namespace

void add_info(Program& program) {
    auto options = std::make_shared<InfoOptions>();
    const Syntax syntax = program.add("info", "Say what a store holds", "ridgeline info alps.terrain --json");
    add_store(syntax, options->directory);
    syntax.flag("--json", options->json, "As JSON");
    program.runs("info", [options](const RunContext&) { return show_info(*options); });
}

}  // namespace ridgeline::app
