// How fast a raster becomes a store, beside how fast GDAL alone reads it: bench_build RASTER OUT.terrain
// [RUNS].
//
// Prints the median of RUNS (default 3) builds with the warm page cache, the stages of that run, peak memory,
// and the size of the store over that of the raster's file.
#include <gdal_priv.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <vector>

#include "ridgeline/build/builder.h"

namespace {

using namespace ridgeline;

double mpixel(const io::TerrainInfo& info) {
    return static_cast<double>(info.width) * static_cast<double>(info.height) * 1e-6;
}

// Seconds to read every pixel, in rows of blocks, as the file's own type on one thread.
double gdal_read_seconds(const char* path) {
    const auto start = std::chrono::steady_clock::now();
    const std::unique_ptr<GDALDataset> dataset(GDALDataset::Open(path, GDAL_OF_RASTER));
    if (!dataset) std::exit(1);
    GDALRasterBand* band = dataset->GetRasterBand(1);
    int block_width = 0, block_height = 0;
    band->GetBlockSize(&block_width, &block_height);
    const GDALDataType type = band->GetRasterDataType();
    const auto sample_bytes = static_cast<std::size_t>(GDALGetDataTypeSizeBytes(type));
    std::vector<std::byte> rows(sample_bytes * static_cast<std::size_t>(band->GetXSize()) *
                                static_cast<std::size_t>(block_height));
    for (int row = 0; row < band->GetYSize(); row += block_height) {
        const int count = std::min(block_height, band->GetYSize() - row);
        if (band->RasterIO(GF_Read, 0, row, band->GetXSize(), count, rows.data(), band->GetXSize(), count,
                           type, 0, 0, nullptr) != CE_None)
            std::exit(1);
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double peak_rss_mib() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fprintf(stderr, "usage: bench_build RASTER OUT.terrain [RUNS]\n");
        return 2;
    }
    GDALAllRegister();
    std::vector<double> reads;
    std::vector<build::BuildReport> reports;
    for (int run = 0; run < (argc > 3 ? std::atoi(argv[3]) : 3); ++run) {
        reads.push_back(gdal_read_seconds(argv[1]));
        build::BuildOptions options;
        options.sources = {argv[1]};
        options.out = argv[2];
        options.replace = io::Replace::existing;
        auto report = build::build_terrain(options);
        if (!report) {
            std::fprintf(stderr, "%s\n", report.error().message.c_str());
            return 1;
        }
        reports.push_back(std::move(*report));
    }
    std::sort(reads.begin(), reads.end());
    std::sort(reports.begin(), reports.end(),
              [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
    const build::BuildReport& median = reports[reports.size() / 2];
    const double read_seconds = reads[reads.size() / 2], size = mpixel(median.info);
    std::printf("GDAL reads     %7.2f Mpixel/s\n", size / read_seconds);
    std::printf("build          %7.2f Mpixel/s, %.2f times the read's time\n", size / median.seconds,
                median.seconds / read_seconds);
    for (int stage = 0; stage < build::kStages; ++stage)
        std::printf("  %-12s %7.3f s\n", build::stage_name(static_cast<build::Stage>(stage)),
                    median.stage_seconds[stage]);
    const auto bytes = static_cast<double>(median.info.heights_bytes + median.info.mesh_bytes);
    std::printf("store          %7.2f MB heights and meshes, %.2f times the raster's file\n", bytes * 1e-6,
                bytes / static_cast<double>(std::filesystem::file_size(argv[1])));
    std::printf("peak memory    %7.1f MiB\n", peak_rss_mib());
    return 0;
}
