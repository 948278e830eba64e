#include "raster_file.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>

#include <vector>

#include "gdal_session.h"

namespace ridgeline::raster {
namespace {

// A raster this many times larger than its file is compressed beyond any terrain: look whether its blocks
// exist.
constexpr double kImplausibleRatio = 400.0;
constexpr double kAlwaysPlausible_bytes = 4e6;

bool ends_with_ignoring_case(const std::string& text, const std::string& end) {
    return text.size() >= end.size() && EQUAL(text.c_str() + text.size() - end.size(), end.c_str());
}

bool is_raster(const std::string& path) {
    return GDALIdentifyDriverEx(path.c_str(), GDAL_OF_RASTER, nullptr, nullptr) != nullptr;
}

// The one raster inside a zip archive.
Result<std::string> inside_zip(const std::string& zip) {
    const CPLStringList names(VSIReadDirRecursive(zip.c_str()));
    std::vector<std::string> rasters;
    for (int i = 0; i < names.size(); ++i) {
        const std::string inner = zip + "/" + names[i];
        if (inner.back() != '/' && is_raster(inner)) rasters.push_back(inner);
    }
    if (rasters.size() == 1) return rasters.front();
    if (rasters.empty()) return Error{"holds no raster that GDAL can read"};
    return Error{"holds " + std::to_string(rasters.size()) + " rasters; name them singly, as " +
                 rasters.front()};
}

// The index that lies part/parts of the way from the first to the last of `count`.
int share_of(int count, int part, int parts) {
    return static_cast<int>((count - std::int64_t{1}) * part / parts);
}

bool holds_some_block(GDALRasterBand& band) {
    constexpr int kParts = 24;
    for (int j = 0; j <= kParts; ++j) {
        for (int i = 0; i <= kParts; ++i) {
            const int status = band.GetDataCoverageStatus(share_of(band.GetXSize(), i, kParts),
                                                          share_of(band.GetYSize(), j, kParts), 1, 1,
                                                          GDAL_DATA_COVERAGE_STATUS_DATA, nullptr);
            if (status & GDAL_DATA_COVERAGE_STATUS_DATA) return true;
        }
    }
    return false;
}

bool size_is_plausible(GDALDataset& dataset, const std::string& path) {
    double declared_bytes = 0.0;
    for (int band = 1; band <= dataset.GetRasterCount(); ++band)
        declared_bytes += static_cast<double>(dataset.GetRasterXSize()) * dataset.GetRasterYSize() *
                          GDALGetDataTypeSizeBytes(dataset.GetRasterBand(band)->GetRasterDataType());
    VSIStatBufL stat;
    // Other drivers compare the file's size themselves.
    if (!EQUAL(dataset.GetDriverName(), "GTiff") || VSIStatL(path.c_str(), &stat) != 0) return true;
    return declared_bytes < kAlwaysPlausible_bytes ||
           declared_bytes < kImplausibleRatio * static_cast<double>(stat.st_size);
}

}  // namespace

void OpenFiles::used(ReopenableFile* file) {
    if (!files_.empty() && files_.front() == file) return;
    files_.remove(file);
    files_.push_front(file);
    if (files_.size() > kMaxOpen) {
        files_.back()->close();
        files_.pop_back();
    }
}

void OpenFiles::forget(ReopenableFile* file) { files_.remove(file); }

Result<std::string> gdal_path(const std::string& path) {
    const bool plain = path.rfind("/vsi", 0) != 0;
    if (plain && ends_with_ignoring_case(path, ".zip")) return inside_zip("/vsizip/" + path);
    if (plain && ends_with_ignoring_case(path, ".gz")) return "/vsigzip/" + path;
    return path;
}

GDALDatasetUniquePtr open_dataset(const std::string& gdal_path, int threads) {
    // The option is read at opening, from the thread's own settings.
    CPLSetThreadLocalConfigOption("GDAL_NUM_THREADS", std::to_string(threads).c_str());
    GDALDatasetUniquePtr dataset(
        GDALDataset::Open(gdal_path.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR));
    CPLSetThreadLocalConfigOption("GDAL_NUM_THREADS", nullptr);
    return dataset;
}

// A few bytes may declare a raster of terabytes. Where the size is beyond what compression explains, some of
// its blocks must exist and the first, middle and last be readable; files with holes (sparse TIFFs) pass.
Result<void> check_blocks(GDALDataset& dataset, const std::string& gdal_path) {
    if (size_is_plausible(dataset, gdal_path)) return {};
    GDALRasterBand& band = *dataset.GetRasterBand(1);
    if (!holds_some_block(band))
        return Error{"declares " + std::to_string(band.GetXSize()) + " x " + std::to_string(band.GetYSize()) +
                     " samples, but the file does not hold them"};
    for (const int part : {0, 1, 2}) {
        const GdalMessages messages;
        double sample = 0.0;
        const CPLErr status =
            band.RasterIO(GF_Read, share_of(band.GetXSize(), part, 2), share_of(band.GetYSize(), part, 2), 1,
                          1, &sample, 1, 1, GDT_Float64, 0, 0, nullptr);
        if (status != CE_None || messages.failed())
            return Error{"cannot be read: " + messages.why("a block is damaged")};
    }
    return {};
}

Error unreadable_file(const std::string& path, const std::string& gdal_path, const std::string& why) {
    // GDAL names the file itself, if it was the file.
    const std::string named = gdal_path + ": ";
    return Error{path + ": cannot be read: " + (why.starts_with(named) ? why.substr(named.size()) : why)};
}

StoredWindow stored_window(const Window& window, const Flips& flips, GDALRasterBand& band) {
    const std::int64_t column =
        flips.columns ? band.GetXSize() - window.column - window.columns : window.column;
    const std::int64_t row = flips.rows ? band.GetYSize() - window.row - window.rows : window.row;
    return {static_cast<int>(column), static_cast<int>(row), static_cast<int>(window.columns),
            static_cast<int>(window.rows)};
}

}  // namespace ridgeline::raster
