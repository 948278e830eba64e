#include "ridgeline/io/terrain_info.h"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "ridgeline/base/json_text.h"

namespace ridgeline::io {
namespace {

using nlohmann::json;

constexpr const char* kChecksum = "checksum";

// Of everything but the checksum itself, whatever the text's layout: keys in alphabetical order, no spaces,
// numbers as short as they read back.
std::string checksum(json j) {
    j.erase(kChecksum);
    const std::string canonical = json_text(j);
    std::array<char, 17> digits{};
    const unsigned long long hash = XXH3_64bits(canonical.data(), canonical.size());
    std::snprintf(digits.data(), digits.size(), "%016llx", hash);
    return digits.data();
}

// nlohmann makes whole numbers of any others, which is undefined where they do not fit. What is larger than
// the result can be becomes the largest, which check() refuses.
std::int64_t whole(const json& j) {
    if (!j.is_number_integer()) throw json::type_error::create(302, "whole number expected", &j);
    constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
    if (j.is_number_unsigned() && std::cmp_greater(j.get<std::uint64_t>(), kMost)) return kMost;
    return j.get<std::int64_t>();
}
int small_whole(const json& j) {
    using Limits = std::numeric_limits<int>;
    return static_cast<int>(std::clamp<std::int64_t>(whole(j), Limits::min(), Limits::max()));
}

DetailInfo parse_detail(const json& j) {
    DetailInfo detail;
    detail.face_residual_m = j.at("face_residual_m");
    detail.edge_residual_m = j.at("edge_residual_m");
    for (const json& gains : j.at("gains"))
        detail.octaves.push_back({small_whole(gains.at(0)), small_whole(gains.at(1)),
                                  small_whole(gains.at(2)), small_whole(gains.at(3))});
    return detail;
}

ImageryInfo parse_imagery(const json& frame, const json& layer) {
    ImageryInfo imagery;
    imagery.west_m = frame.at("west_m");
    imagery.north_m = frame.at("north_m");
    imagery.spacing_x_m = frame.at("spacing_m").at(0);
    imagery.spacing_y_m = frame.at("spacing_m").at(1);
    imagery.width = whole(frame.at("texels").at(0));
    imagery.height = whole(frame.at("texels").at(1));
    imagery.sources = frame.at("sources").get<std::vector<std::string>>();
    imagery.notes = frame.at("notes").get<std::vector<std::string>>();
    imagery.generator = frame.at("generator");
    imagery.tiles = whole(layer.at("tiles"));
    imagery.bytes = whole(layer.at("bytes"));
    return imagery;
}

// Throws what nlohmann throws; the caller turns it into an Error.
TerrainInfo parse(const json& j) {
    TerrainInfo info;
    const json &frame = j.at("frame"), &heights = j.at("heights"), &layers = j.at("layers");
    info.crs_wkt = j.at("crs");
    info.west_m = frame.at("west_m");
    info.north_m = frame.at("north_m");
    info.spacing_x_m = frame.at("spacing_m").at(0);
    info.spacing_y_m = frame.at("spacing_m").at(1);
    info.width = whole(frame.at("samples").at(0));
    info.height = whole(frame.at("samples").at(1));
    info.tile = small_whole(j.at("tile"));
    const json& relief = j.at("relief");
    info.relief = {small_whole(relief.at("bands")), small_whole(relief.at("steps")),
                   small_whole(relief.at("cells"))};
    info.quantum_m = heights.at("quantum_m");
    info.height_offset_m = heights.at("offset_m");
    info.min_height_m = heights.at("range_m").at(0);
    info.max_height_m = heights.at("range_m").at(1);
    info.invalid_samples = whole(heights.at("invalid_samples"));
    info.metric = j.at("metric");
    info.thresholds_m = j.at("thresholds_m").get<std::vector<double>>();
    info.cone_thresholds_m = j.value("cone_thresholds_m", std::vector<double>());
    info.triangles = whole(j.at("triangles"));
    info.heights_tiles = whole(layers.at("heights").at("tiles"));
    info.heights_bytes = whole(layers.at("heights").at("bytes"));
    info.mesh_tiles = whole(layers.at("mesh").at("tiles"));
    info.mesh_bytes = whole(layers.at("mesh").at("bytes"));
    info.sources = j.at("provenance").at("sources").get<std::vector<std::string>>();
    info.notes = j.at("provenance").at("notes").get<std::vector<std::string>>();
    info.generator = j.at("provenance").at("generator");
    if (j.contains("detail")) info.detail = parse_detail(j.at("detail"));
    if (j.contains("imagery")) info.imagery = parse_imagery(j.at("imagery"), layers.at("imagery"));
    return info;
}

bool positive(double x) { return std::isfinite(x) && x > 0.0; }

Result<void> check(const ImageryInfo& info) {
    if (info.width < 1 || info.height < 1 || info.width > ImageryInfo::kMaxTexels ||
        info.height > ImageryInfo::kMaxTexels)
        return Error{"impossible size in texels"};
    if (!positive(info.spacing_x_m) || !positive(info.spacing_y_m))
        return Error{"the imagery's spacing must be positive"};
    if (!std::isfinite(info.west_m) || !std::isfinite(info.north_m))
        return Error{"coordinates must be numbers"};
    if (info.tiles < 0 || info.bytes < 0) return Error{"impossible counts"};
    return {};
}

Result<void> check(const DetailInfo& detail) {
    if (detail.octaves.size() > DetailInfo::kMostOctaves) return Error{"impossible detail"};
    for (const DetailGains& gains : detail.octaves)
        for (const int gain :
             {gains.face_slope, gains.face_roughness, gains.edge_slope, gains.edge_roughness})
            if (gain < 0 || gain > DetailInfo::kMostGain) return Error{"impossible detail"};
    return {};
}

// Small enough to be added to.
bool plausible_counts(const TerrainInfo& info) {
    const bool samples = info.invalid_samples >= 0 && info.invalid_samples <= info.width * info.height;
    const auto counts = {info.triangles, info.heights_tiles, info.heights_bytes, info.mesh_tiles,
                         info.mesh_bytes};
    return samples && std::all_of(counts.begin(), counts.end(), [](std::int64_t count) {
               return count >= 0 && count < std::numeric_limits<std::int64_t>::max();
           });
}

Result<void> check(const TerrainInfo& info) {
    if (info.width < 2 || info.height < 2 || info.width > Grid::kMaxSamples ||
        info.height > Grid::kMaxSamples)
        return Error{"impossible size in samples"};
    if (info.tile != 33 && info.tile != 65 && info.tile != 129) return Error{"impossible tile size"};
    if (!info.relief.fits(info.tile - 1)) return Error{"impossible relief"};
    if (!positive(info.spacing_x_m) || !positive(info.spacing_y_m) || !positive(info.quantum_m))
        return Error{"spacing and quantum must be positive"};
    if (!std::isfinite(info.west_m) || !std::isfinite(info.north_m) || !std::isfinite(info.height_offset_m))
        return Error{"coordinates must be numbers"};
    if (!plausible_counts(info)) return Error{"impossible counts"};
    if (!(info.min_height_m <= info.max_height_m)) return Error{"impossible height range"};
    if (static_cast<int>(info.thresholds_m.size()) != info.grid().levels())
        return Error{"thresholds do not fit levels"};
    if (!info.cone_thresholds_m.empty() && info.cone_thresholds_m.size() != info.thresholds_m.size())
        return Error{"cone thresholds do not fit levels"};
    if (info.detail) RIDGELINE_TRY(check(*info.detail));
    return info.imagery ? check(*info.imagery) : Result<void>();
}

void add_detail(const DetailInfo& detail, json& j) {
    json octaves = json::array();
    for (const DetailGains& gains : detail.octaves)
        octaves.push_back({gains.face_slope, gains.face_roughness, gains.edge_slope, gains.edge_roughness});
    j["detail"] = {{"face_residual_m", detail.face_residual_m},
                   {"edge_residual_m", detail.edge_residual_m},
                   {"gains", octaves}};
}

void add_imagery(const ImageryInfo& imagery, json& j) {
    j["imagery"] = {{"west_m", imagery.west_m},
                    {"north_m", imagery.north_m},
                    {"spacing_m", {imagery.spacing_x_m, imagery.spacing_y_m}},
                    {"texels", {imagery.width, imagery.height}},
                    {"sources", imagery.sources},
                    {"notes", imagery.notes},
                    {"generator", imagery.generator}};
    j["layers"]["imagery"] = {{"tiles", imagery.tiles}, {"bytes", imagery.bytes}};
}

}  // namespace

std::string to_json(const TerrainInfo& info) {
    const Grid grid = info.grid();
    json j;
    j["format"] = "ridgeline-terrain";
    j["version"] = TerrainInfo::kFormatVersion;
    j["crs"] = info.crs_wkt;
    j["frame"] = {{"west_m", info.west_m},
                  {"north_m", info.north_m},
                  {"spacing_m", {info.spacing_x_m, info.spacing_y_m}},
                  {"samples", {info.width, info.height}}};
    j["heights"] = {{"quantum_m", info.quantum_m},
                    {"offset_m", info.height_offset_m},
                    {"range_m", {info.min_height_m, info.max_height_m}},
                    {"invalid_samples", info.invalid_samples}};
    j["tile"] = info.tile;
    j["relief"] = {{"bands", info.relief.bands}, {"steps", info.relief.steps}, {"cells", info.relief.cells}};
    j["levels"] = grid.levels();
    j["roots"] = {grid.nodes_x(0), grid.nodes_y(0)};
    j["metric"] = info.metric;
    j["thresholds_m"] = info.thresholds_m;
    if (!info.cone_thresholds_m.empty()) j["cone_thresholds_m"] = info.cone_thresholds_m;
    j["triangles"] = info.triangles;
    j["layers"] = {{"heights", {{"tiles", info.heights_tiles}, {"bytes", info.heights_bytes}}},
                   {"mesh", {{"tiles", info.mesh_tiles}, {"bytes", info.mesh_bytes}}}};
    j["provenance"] = {{"sources", info.sources}, {"notes", info.notes}, {"generator", info.generator}};
    if (info.detail) add_detail(*info.detail, j);
    if (info.imagery) add_imagery(*info.imagery, j);
    // Through text once, so that the checksum sees what a reader will.
    j = parse_json(json_text(j));
    j[kChecksum] = checksum(j);
    return json_text(j, 2) + "\n";
}

Result<TerrainInfo> terrain_info_from_json(const std::string& text) {
    try {
        const json j = parse_json(text);
        if (j.is_discarded()) return Error{"damaged: not JSON"};
        if (!j.is_object() || j.value("format", "") != "ridgeline-terrain")
            return Error{"not a Ridgeline terrain"};
        const int version = small_whole(j.at("version"));
        if (version > TerrainInfo::kFormatVersion)
            return Error{"store format " + std::to_string(version) + " is newer than this program's " +
                         std::to_string(TerrainInfo::kFormatVersion) + ": use a newer Ridgeline"};
        if (version < TerrainInfo::kFormatVersion)
            return Error{"built by an older Ridgeline (store format " + std::to_string(version) +
                         "): build it again"};
        if (j.value(kChecksum, "") != checksum(j))
            return Error{"damaged or changed: checksum does not match"};
        TerrainInfo info = parse(j);
        RIDGELINE_TRY(check(info));
        return info;
    } catch (const json::exception& e) {
        return Error{std::string("damaged: ") + e.what()};
    }
}

Result<TerrainInfo> read_terrain_info(const std::filesystem::path& store) {
    const std::filesystem::path path = store / kInfoFile;
    std::ifstream file(path, std::ios::binary);
    if (!file) return Error{path.string() + ": not found or not readable: is this a Ridgeline terrain?"};
    const std::string text(std::istreambuf_iterator<char>(file), {});
    auto info = terrain_info_from_json(text);
    if (!info) return Error{path.string() + ": " + info.error().message};
    return info;
}

}  // namespace ridgeline::io
