// Real ground and made-up mountains, decimated two, four and eight times, and what is made below them held against what was
// there: at the lost lags the mean squared differences of height are within 15 %, and every sample that is left keeps its
// height.
#include <doctest/doctest.h>
#include <gdal_priv.h>

#include <cmath>
#include <random>
#include <vector>

#include "ridgeline/app/bench/lost_lags.h"
#include "ridgeline/jobs/job_system.h"
#include "ridgeline/select/surface_query.h"
#include "ridgeline/synth/synth.h"
#include "support/built_store.h"
#include "support/data.h"
#include "unit/build_fixture.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

struct Raster {
    int width = 0, height = 0;
    GDALDataType type = GDT_Float32;
    std::array<double, 6> transform{};
    std::string crs;
    std::vector<float> heights;

    float at(int column, int row) const {
        return heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                       static_cast<std::size_t>(column)];
    }
};

using Dataset = std::unique_ptr<GDALDataset, decltype(&GDALClose)>;

Raster read_raster(const std::string& path) {
    GDALAllRegister();
    const Dataset dataset(GDALDataset::Open(path.c_str()), &GDALClose);
    REQUIRE(dataset);
    Raster raster;
    raster.width = dataset->GetRasterXSize();
    raster.height = dataset->GetRasterYSize();
    raster.type = dataset->GetRasterBand(1)->GetRasterDataType();
    raster.crs = dataset->GetProjectionRef();
    dataset->GetGeoTransform(raster.transform.data());
    raster.heights.resize(static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height));
    REQUIRE(dataset->RasterIO(GF_Read, 0, 0, raster.width, raster.height, raster.heights.data(), raster.width,
                              raster.height, GDT_Float32, 1, nullptr, 0, 0, 0, nullptr) == CE_None);
    return raster;
}

// Every `step`-th sample, where it was.
void write_decimated(const Raster& raster, int step, const std::string& path) {
    const int width = (raster.width - 1) / step + 1, height = (raster.height - 1) / step + 1;
    std::vector<float> kept;
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) kept.push_back(raster.at(step * column, step * row));
    auto transform = raster.transform;
    // A raster's corner is half a sample beyond the first one's centre.
    transform[0] += 0.5 * (1 - step) * transform[1];
    transform[3] += 0.5 * (1 - step) * transform[5];
    transform[1] *= step;
    transform[5] *= step;
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    const Dataset dataset(driver->Create(path.c_str(), width, height, 1, raster.type, nullptr), &GDALClose);
    REQUIRE(dataset);
    dataset->SetGeoTransform(transform.data());
    dataset->SetProjection(raster.crs.c_str());
    REQUIRE(dataset->RasterIO(GF_Write, 0, 0, width, height, kept.data(), width, height, GDT_Float32, 1,
                              nullptr, 0, 0, 0, nullptr) == CE_None);
}

constexpr int kBlocks = 300, kSide = 48;

void add_block(const Raster& raster, select::SurfaceQuery& query, int step, int left, int top,
               app::LostLags& lags) {
    std::vector<double> real, made;
    for (int row = 0; row < kSide; ++row)
        for (int column = 0; column < kSide; ++column) {
            const double x = left + column, y = top + row;
            const auto height = query.height_at(x / step, y / step);
            REQUIRE(height);
            REQUIRE((height->kind == select::SurfaceHeight::Kind::ground));
            made.push_back(height->height_m);
            real.push_back(raster.at(left + column, top + row));
            if ((left + column) % step == 0 && (top + row) % step == 0)
                REQUIRE(height->height_m ==
                        doctest::Approx(raster.at(left + column, top + row)).epsilon(1e-6));
        }
    lags.add(real, made, kSide);
}

void compare(const Raster& raster, int octaves, const std::string& name) {
    const int step = 1 << octaves;
    const ScratchFolder folder;
    const std::string decimated = folder.path() / "decimated.tif";
    write_decimated(raster, step, decimated);
    const io::Store store = built_store(decimated, folder.path() / "decimated.terrain");
    REQUIRE(store.info().detail);
    select::SurfaceQuery query(store, {.detail_levels = octaves});
    std::mt19937 random(3);
    app::LostLags lags;
    for (int block = 0; block < kBlocks; ++block) {
        const int left = static_cast<int>(random() % static_cast<unsigned>(raster.width - kSide - step));
        const int top = static_cast<int>(random() % static_cast<unsigned>(raster.height - kSide - step));
        add_block(raster, query, step, left, top, lags);
    }
    CAPTURE(name);
    CAPTURE(step);
    for (int lag = 0; lag < octaves; ++lag) {
        const double ratio = lags.ratio(lag);
        MESSAGE(name, " decimated ", step, " times, lag ", 1 << lag, ": ", ratio);
        CAPTURE(lag);
        CHECK(ratio > 0.85);
        CHECK(ratio < 1.15);
    }
}

}  // namespace

TEST_CASE("made-up mountains: what is made below them is as rough as what was lost") {
    const ScratchFolder folder;
    synth::SynthOptions options;
    options.size = 2049;
    options.path = folder.path() / "mountains.tif";
    jobs::JobSystem jobs({.workers = 1});
    REQUIRE(synth::synth(options, jobs));
    const Raster raster = read_raster(options.path);
    for (const int octaves : {1, 2, 3}) compare(raster, octaves, "synth");
}

TEST_CASE("real mountains: what is made below them is as rough as what was lost") {
    const auto source = data_file("taiwan_central_8k.tif");
    if (source.empty()) return;
    const Raster raster = read_raster(source.string());
    for (const int octaves : {1, 2, 3}) compare(raster, octaves, "Taiwan");
}
