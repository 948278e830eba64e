// Rasters whose blocks cannot be read, met by a build: one line that names the file, status 1, nothing that
// opens, and a store that stood stands.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/data.h"
#include "unit/app_process.h"

using namespace ridgeline::test;
namespace fs = std::filesystem;

namespace {

// Overwrites the middle half of a raster, whose blocks are packed, with their beginnings: they no longer unpack.
void damage_blocks(const fs::path& raster, const fs::path& damaged) {
    std::string bytes = file_text(raster);
    for (std::size_t at = bytes.size() / 4; at < bytes.size() / 4 * 3; ++at)
        bytes[at] = static_cast<char>(~bytes[at]);
    std::ofstream(damaged, std::ios::binary) << bytes;
}
void cut_blocks(const fs::path& raster, const fs::path& cut) {
    fs::copy_file(raster, cut);
    fs::resize_file(cut, fs::file_size(cut) / 2);
}

struct Rasters {
    Folder folder;
    std::string dem = folder.file("dem.tif"), rgb = folder.file("rgb.tif");
    std::string store = folder.file("a.terrain");

    Rasters() { run_well({"synth", dem, "--size", "700", "--imagery", rgb, "--quiet"}); }
};

// Broken rasters of the real data: those that GDAL does not open or read.
std::vector<fs::path> broken_rasters(const fs::path& index) {
    std::vector<fs::path> broken;
    std::ifstream table(index);
    std::string line;
    std::getline(table, line);
    while (std::getline(table, line)) {
        std::vector<std::string> cells;
        std::istringstream row(line);
        for (std::string cell; std::getline(row, cell, '\t');) cells.push_back(cell);
        REQUIRE(cells.size() > 9);
        if (cells[2] == "yes" && cells[9] == "ok") continue;
        if (fs::exists(index.parent_path() / cells[0])) broken.push_back(index.parent_path() / cells[0]);
    }
    return broken;
}

}  // namespace

TEST_CASE("a DEM with blocks that do not unpack, or that are cut off, fails by name and leaves nothing") {
    const Rasters rasters;
    const std::string damaged = rasters.folder.file("damaged.tif"), cut = rasters.folder.file("cut.tif");
    damage_blocks(rasters.dem, damaged);
    cut_blocks(rasters.dem, cut);
    const auto before = names_in(rasters.folder.path());
    for (const std::string& bad : {damaged, cut}) {
        check_failure({"build", bad, "--out", rasters.store, "--quiet"}, bad);
        check_failure({"build", rasters.dem, bad, "--out", rasters.store, "--quiet"}, bad);
        check_failure({"build", bad, "--out", rasters.store, "--crs", "EPSG:32632", "--quiet"}, bad);
        CHECK(names_in(rasters.folder.path()) == before);
    }
}

TEST_CASE("a picture with blocks that do not unpack leaves no store, and one that stood as it was") {
    const Rasters rasters;
    const std::string damaged = rasters.folder.file("damaged.tif"), cut = rasters.folder.file("cut.tif");
    damage_blocks(rasters.rgb, damaged);
    cut_blocks(rasters.rgb, cut);
    for (const std::string& bad : {damaged, cut}) {
        const auto before = names_in(rasters.folder.path());
        check_failure({"build", rasters.dem, "--out", rasters.store, "--imagery", bad, "--quiet"}, bad);
        CHECK(names_in(rasters.folder.path()) == before);
    }
    run_well({"build", rasters.dem, "--out", rasters.store, "--imagery", rasters.rgb, "--quiet"});
    const auto names = names_in(rasters.folder.path());
    const auto stood = contents_of(rasters.store);
    for (const std::string& bad : {damaged, cut}) {
        check_failure({"build", "--out", rasters.store, "--imagery", bad, "--force", "--quiet"}, bad);
        CHECK(names_in(rasters.folder.path()) == names);
        CHECK(contents_of(rasters.store) == stood);
    }
}

TEST_CASE("every broken raster of the real data fails by name and leaves nothing") {
    const fs::path index = data_file("odd/INDEX.tsv");
    if (index.empty()) return;
    const auto broken = broken_rasters(index);
    CHECK(broken.size() > 3);
    const Folder folder;
    for (const fs::path& raster : broken) {
        check_failure({"build", raster, "--out", folder.file("a.terrain"), "--quiet"}, raster);
        CHECK(names_in(folder.path()).empty());
    }
}
