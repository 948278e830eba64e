#include "geotiff_file.h"

#include <cpl_string.h>
#include <fcntl.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <stdio.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "ridgeline/base/units.h"
#include "ridgeline/raster/gdal_session.h"

namespace ridgeline::synth {
namespace {

namespace fs = std::filesystem;
using raster::GdalMessages;

// UTM zone 33N: its meridian at easting 500 km; 47° north, in the Alps, is northing 5205 km.
constexpr int kEpsg = 32633;
constexpr double kCentreEast_m = 500e3;
constexpr double kCentreNorth_m = 5205e3;

CPLStringList creation_options(const GeoTiffShape& shape) {
    const std::string side = std::to_string(shape.tile);
    CPLStringList options;
    options.SetNameValue("TILED", "YES");
    options.SetNameValue("BLOCKXSIZE", side.c_str());
    options.SetNameValue("BLOCKYSIZE", side.c_str());
    options.SetNameValue("COMPRESS", "DEFLATE");
    // The floating-point predictor: bytes of like weight together, a third smaller than horizontal
    // differences, which are what colours get.
    const bool colours = shape.samples == Samples::colours;
    options.SetNameValue("PREDICTOR", colours ? "2" : "3");
    if (colours) {
        options.SetNameValue("INTERLEAVE", "PIXEL");
        options.SetNameValue("PHOTOMETRIC", "RGB");
    }
    options.SetNameValue("ZLEVEL", "4");
    options.SetNameValue("BIGTIFF", "IF_SAFER");
    options.SetNameValue("NUM_THREADS", std::to_string(shape.threads).c_str());
    return options;
}

void place(GDALDataset& dataset, const GeoTiffShape& shape) {
    const double half_m = shape.spacing_m * shape.size / 2.0;
    std::array<double, 6> transform{kCentreEast_m - half_m, shape.spacing_m, 0, kCentreNorth_m + half_m, 0,
                                    -shape.spacing_m};
    dataset.SetGeoTransform(transform.data());
    OGRSpatialReference crs;
    crs.importFromEPSG(kEpsg);
    dataset.SetSpatialRef(&crs);
    if (shape.samples == Samples::heights) dataset.GetRasterBand(1)->SetUnitType("metre");
}

std::string system_error() { return std::strerror(errno); }

Result<void> check_place(const std::string& path, Replace replace) {
    std::error_code ignored;
    const fs::file_status status = fs::symlink_status(path, ignored);
    if (!fs::exists(status)) return {};
    if (replace == Replace::never) return Error{path + ": exists already; --force replaces it"};
    if (!fs::is_regular_file(status)) return Error{path + ": is no file; choose another name"};
    return {};
}

// Where nothing is to be replaced, what has come to stand there in the last moment is not either.
int move_to_place(const std::string& from, const std::string& to, Replace replace) {
    if (replace == Replace::existing) return ::rename(from.c_str(), to.c_str());
    const int moved = ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE);
    // Some file systems do not know the flag; check_place has just looked.
    return moved != 0 && errno == EINVAL ? ::rename(from.c_str(), to.c_str()) : moved;
}

// GDAL writes through buffers; what the disk refuses is known for sure only when it is asked to hold
// everything.
Result<void> flush_to_disk(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    const bool flushed = file >= 0 && ::fsync(file) == 0;
    const std::string why = flushed ? "" : system_error();
    if (file >= 0) ::close(file);
    if (flushed) return {};
    return Error{why};
}

}  // namespace

struct GeoTiffFile::State {
    std::string path;
    Replace replace = Replace::never;
    std::string unfinished_path;
    GDALDatasetUniquePtr dataset;

    Error failure(const std::string& why) const { return Error{path + ": cannot be written: " + why}; }
    ~State() {
        const GdalMessages quiet;
        dataset.reset();
        std::error_code ignored;
        if (!unfinished_path.empty()) fs::remove(unfinished_path, ignored);
    }
};

GeoTiffFile::GeoTiffFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
GeoTiffFile::GeoTiffFile(GeoTiffFile&&) noexcept = default;
GeoTiffFile& GeoTiffFile::operator=(GeoTiffFile&&) noexcept = default;
GeoTiffFile::~GeoTiffFile() = default;

Result<GeoTiffFile> GeoTiffFile::create(const std::string& path, Replace replace, const GeoTiffShape& shape) {
    RIDGELINE_TRY(check_place(path, replace));
    // Rows of tiles in flight; GDAL's own default would be a share of the machine.
    raster::prepare_gdal(64_MiB);
    const GdalMessages messages;
    auto state = std::make_unique<State>();
    state->path = path;
    state->replace = replace;
    std::string name = path + ".XXXXXX";
    const int file = ::mkstemp(name.data());
    if (file < 0) return state->failure(system_error());
    ::fchmod(file, 0644);
    ::close(file);
    state->unfinished_path = name;
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    if (driver == nullptr) return state->failure("this GDAL has no GeoTIFF driver");
    const bool colours = shape.samples == Samples::colours;
    state->dataset.reset(driver->Create(name.c_str(), shape.size, shape.size, colours ? 3 : 1,
                                        colours ? GDT_Byte : GDT_Float32, creation_options(shape).List()));
    if (!state->dataset || messages.failed()) return state->failure(messages.why("GDAL gives no reason"));
    place(*state->dataset, shape);
    return GeoTiffFile(std::move(state));
}

Result<void> GeoTiffFile::write_rows(int row, int rows, std::span<const float> heights_m) {
    const GdalMessages messages;
    GDALRasterBand& band = *state_->dataset->GetRasterBand(1);
    RIDGELINE_CHECK(heights_m.size() ==
                    static_cast<std::size_t>(band.GetXSize()) * static_cast<std::size_t>(rows));
    // GDAL takes what it writes from as mutable, and leaves it.
    auto* samples = const_cast<float*>(heights_m.data());
    const CPLErr status = band.RasterIO(GF_Write, 0, row, band.GetXSize(), rows, samples, band.GetXSize(),
                                        rows, GDT_Float32, 0, 0, nullptr);
    if (status == CE_None && !messages.failed()) return {};
    return state_->failure(messages.why("GDAL gives no reason"));
}

Result<void> GeoTiffFile::write_rows(int row, int rows, std::span<const std::uint8_t> colours) {
    const GdalMessages messages;
    GDALDataset& dataset = *state_->dataset;
    const int width = dataset.GetRasterXSize(), bands = dataset.GetRasterCount();
    RIDGELINE_CHECK(colours.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(rows) *
                                          static_cast<std::size_t>(bands));
    // GDAL takes what it writes from as mutable, and leaves it.
    auto* bytes = const_cast<std::uint8_t*>(colours.data());
    const CPLErr status = dataset.RasterIO(GF_Write, 0, row, width, rows, bytes, width, rows, GDT_Byte, bands,
                                           nullptr, bands, GSpacing{bands} * width, 1, nullptr);
    if (status == CE_None && !messages.failed()) return {};
    return state_->failure(messages.why("GDAL gives no reason"));
}

Result<void> GeoTiffFile::finish() {
    const GdalMessages messages;
    state_->dataset.reset();
    if (messages.failed()) return state_->failure(messages.why(""));
    if (const auto flushed = flush_to_disk(state_->unfinished_path); !flushed)
        return state_->failure(flushed.error().message);
    RIDGELINE_TRY(check_place(state_->path, state_->replace));
    if (move_to_place(state_->unfinished_path, state_->path, state_->replace) != 0)
        return state_->failure(system_error());
    state_->unfinished_path.clear();
    return {};
}

}  // namespace ridgeline::synth
