// GDAL's raster model (gdal.org, "Raster Data Model") says what bands, masks, scales and units mean.
#include "source_file.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <cmath>

#include "gdal_session.h"
#include "undeclared_nodata.h"

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

// What GDAL is to open for a path as users write it.
Result<std::string> gdal_path(const std::string& path) {
    const bool plain = path.rfind("/vsi", 0) != 0;
    if (plain && ends_with_ignoring_case(path, ".zip")) return inside_zip("/vsizip/" + path);
    if (plain && ends_with_ignoring_case(path, ".gz")) return "/vsigzip/" + path;
    return path;
}

bool is_integer_type(GDALDataType type) {
    return !GDALDataTypeIsFloating(type) && !GDALDataTypeIsComplex(type);
}

// Whether every value of the type is an int32.
bool fits_int32(GDALDataType type) {
    return is_integer_type(type) && type != GDT_UInt32 && GDALGetDataTypeSizeBits(type) <= 32;
}

template <class T>
constexpr GDALDataType kGdalType = GDT_Float64;
template <>
constexpr GDALDataType kGdalType<std::int32_t> = GDT_Int32;

template <class T>
void reverse_rows(std::span<T> samples, const Window& window) {
    for (std::int64_t top = 0, bottom = window.rows - 1; top < bottom; ++top, --bottom) {
        const auto row = samples.begin() + top * window.columns;
        std::swap_ranges(row, row + window.columns, samples.begin() + bottom * window.columns);
    }
}

template <class T>
void reverse_columns(std::span<T> samples, const Window& window) {
    for (std::int64_t row = 0; row < window.rows; ++row) {
        const auto first = samples.begin() + row * window.columns;
        std::reverse(first, first + window.columns);
    }
}

// Reads a window given in the grid's order from a band that may store rows or columns the other way.
template <class T>
CPLErr read_band(GDALRasterBand& band, const Window& window, const Flips& flips, std::span<T> samples,
                 GDALDataType type) {
    const std::int64_t column =
        flips.columns ? band.GetXSize() - window.column - window.columns : window.column;
    const std::int64_t row = flips.rows ? band.GetYSize() - window.row - window.rows : window.row;
    const int columns = static_cast<int>(window.columns);
    const int rows = static_cast<int>(window.rows);
    const CPLErr status = band.RasterIO(GF_Read, static_cast<int>(column), static_cast<int>(row), columns,
                                        rows, samples.data(), columns, rows, type, 0, 0, nullptr);
    if (flips.rows) reverse_rows(samples, window);
    if (flips.columns) reverse_columns(samples, window);
    return status;
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

}  // namespace

void OpenFiles::used(SourceFile* file) {
    if (!files_.empty() && files_.front() == file) return;
    files_.remove(file);
    files_.push_front(file);
    if (files_.size() > kMaxOpen) {
        files_.back()->close();
        files_.pop_back();
    }
}

void OpenFiles::forget(SourceFile* file) { files_.remove(file); }

SourceFile::SourceFile(std::string path, std::shared_ptr<SourceContext> context)
    : path_(std::move(path)), context_(std::move(context)) {}

SourceFile::~SourceFile() { context_->open_files.forget(this); }

Error SourceFile::unreadable(const std::string& why) const {
    // GDAL names the file itself, if it was the file.
    const std::string named = gdal_path_ + ": ";
    return Error{path_ + ": cannot be read: " + (why.starts_with(named) ? why.substr(named.size()) : why)};
}

Result<std::shared_ptr<SourceFile>> SourceFile::open(const std::string& path,
                                                     std::shared_ptr<SourceContext> context) {
    const GdalMessages messages;
    std::shared_ptr<SourceFile> file(new SourceFile(path, std::move(context)));
    auto found = gdal_path(path);
    if (!found) return Error{path + ": " + found.error().message};
    file->gdal_path_ = *found;
    RIDGELINE_TRY(file->reopen());
    RIDGELINE_TRY(file->judge());
    return file;
}

Result<void> SourceFile::reopen() {
    context_->open_files.used(this);
    if (dataset_) return {};
    const GdalMessages messages;
    // The option is read at opening, from the thread's own settings.
    const std::string threads = std::to_string(context_->options.threads);
    CPLSetThreadLocalConfigOption("GDAL_NUM_THREADS", threads.c_str());
    dataset_.reset(GDALDataset::Open(gdal_path_.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR));
    CPLSetThreadLocalConfigOption("GDAL_NUM_THREADS", nullptr);
    if (dataset_) return {};
    return unreadable(messages.why("not a raster that GDAL knows"));
}

Result<void> SourceFile::judge() {
    if (dataset_->GetRasterCount() == 0)
        return Error{path_ +
                     ": holds no raster band; if it has subdatasets (gdalinfo lists them), name one of them"};
    GDALRasterBand& band = *dataset_->GetRasterBand(1);
    driver_ = dataset_->GetDriverName();
    type_ = band.GetRasterDataType();
    if (GDALDataTypeIsComplex(type_))
        return Error{path_ + ": holds complex numbers (" + data_type() + "), not heights"};
    RIDGELINE_TRY(judge_blocks(band));
    auto placed = place(*dataset_, context_->options.crs);
    if (!placed) return Error{path_ + ": " + placed.error().message};
    placed_ = std::move(*placed);
    if (dataset_->GetRasterCount() - (GDALGetMaskFlags(&band) & GMF_ALPHA ? 1 : 0) > 1)
        placed_.notes.push_back("has " + std::to_string(dataset_->GetRasterCount()) +
                                " bands: heights are read from the first");
    judge_heights(band);
    judge_nodata(band);
    return {};
}

// A few bytes may declare a raster of terabytes. Where the size is beyond what compression explains, some of
// its blocks must exist and the first, middle and last be readable; files with holes (sparse TIFFs) pass.
Result<void> SourceFile::judge_blocks(GDALRasterBand& band) {
    int block_columns = 1;
    int block_rows = 1;
    band.GetBlockSize(&block_columns, &block_rows);
    natural_rows_ = std::clamp(block_rows, 1, band.GetYSize());
    if (size_is_plausible(band)) return {};
    if (!holds_some_block(band))
        return Error{path_ + ": declares " + std::to_string(band.GetXSize()) + " x " +
                     std::to_string(band.GetYSize()) + " samples, but the file does not hold them"};
    for (const int part : {0, 1, 2}) {
        const GdalMessages messages;
        double sample = 0.0;
        const CPLErr status =
            band.RasterIO(GF_Read, share_of(band.GetXSize(), part, 2), share_of(band.GetYSize(), part, 2), 1,
                          1, &sample, 1, 1, GDT_Float64, 0, 0, nullptr);
        if (status != CE_None || messages.failed()) return unreadable(messages.why("a block is damaged"));
    }
    return {};
}

bool SourceFile::size_is_plausible(GDALRasterBand& band) const {
    const double declared_bytes =
        static_cast<double>(band.GetXSize()) * band.GetYSize() * GDALGetDataTypeSizeBytes(type_);
    VSIStatBufL stat;
    // Other drivers compare the file's size themselves.
    if (driver_ != "GTiff" || VSIStatL(gdal_path_.c_str(), &stat) != 0) return true;
    return declared_bytes < kAlwaysPlausible_bytes ||
           declared_bytes < kImplausibleRatio * static_cast<double>(stat.st_size);
}

void SourceFile::judge_heights(GDALRasterBand& band) {
    double unit_m = placed_.height_unit_m;
    const std::string unit = band.GetUnitType();
    if (const double metres = metres_per_unit(unit); metres > 0)
        unit_m = std::copysign(metres, unit_m);
    else if (!unit.empty())
        placed_.notes.push_back("unit \"" + unit + "\" is not known: heights are taken as metres");
    double scale = band.GetScale();
    double offset = band.GetOffset();
    if (!std::isfinite(scale) || scale == 0.0 || !std::isfinite(offset)) {
        placed_.notes.push_back("its scale and offset make no sense and are left aside");
        scale = 1.0;
        offset = 0.0;
    }
    scale_m_ = scale * unit_m;
    offset_m_ = offset * unit_m;
    if (std::abs(unit_m) != 1.0)
        placed_.notes.push_back("heights are turned to metres (1 unit = " + std::to_string(unit_m) + " m)");

    const char* pixel_type = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
    signed_byte_ = type_ == GDT_Byte && pixel_type != nullptr && EQUAL(pixel_type, "SIGNEDBYTE");
    format_.step_m = std::abs(scale_m_);
    format_.offset_m = offset_m_;
    // Every height in range must have an int32 step.
    const double most_steps = (kMaxHeight_m + std::abs(offset_m_)) / format_.step_m;
    format_.integer = is_integer_type(type_) && most_steps < std::numeric_limits<std::int32_t>::max();
}

void SourceFile::judge_nodata(GDALRasterBand& band) {
    int declared = FALSE;
    if (type_ == GDT_Int64) {
        const auto value = band.GetNoDataValueAsInt64(&declared);
        if (declared) nodata_ = static_cast<double>(value);
    } else if (type_ == GDT_UInt64) {
        const auto value = band.GetNoDataValueAsUInt64(&declared);
        if (declared) nodata_ = static_cast<double>(value);
    } else {
        const double value = band.GetNoDataValue(&declared);
        if (declared) nodata_ = value;
    }
    if (context_->options.nodata) nodata_ = context_->options.nodata;
    // Floats are compared as stored: a declared -3.402823e+38 means the float next to it.
    if (nodata_ && type_ == GDT_Float32 && std::abs(*nodata_) <= std::numeric_limits<float>::max())
        nodata_ = static_cast<double>(static_cast<float>(*nodata_));
    const int flags = band.GetMaskFlags();
    if (!nodata_ && flags == GMF_ALL_VALID) judge_undeclared_nodata(band);
    has_mask_ = !(flags & GMF_ALL_VALID) && flags != GMF_NODATA;
    const bool small_heights =
        fits_int32(type_) && std::abs(scale_m_) * 2147483648.0 + std::abs(offset_m_) <= kMaxHeight_m;
    const bool small_type = GDALGetDataTypeSizeBits(type_) <= 16 &&
                            std::abs(scale_m_) * 65536.0 + std::abs(offset_m_) <= kMaxHeight_m;
    format_.may_have_nodata =
        nodata_ || has_mask_ || !is_integer_type(type_) || !(small_heights || small_type);
}

void SourceFile::judge_undeclared_nodata(GDALRasterBand& band) {
    const GdalMessages unheard;  // what cannot be read is told where it is missed
    nodata_ = undeclared_nodata(band);
    if (nodata_)
        placed_.notes.push_back(
            std::to_string(static_cast<int>(*nodata_)) +
            " lies far below every other value: taken as undeclared nodata (--nodata nan keeps it)");
}

template <class T>
Result<void> SourceFile::read_stored(const Window& window, std::span<T> stored) {
    RIDGELINE_TRY(reopen());
    const GdalMessages messages;
    const CPLErr status = read_band(*dataset_->GetRasterBand(1), window, placed_.flips, stored, kGdalType<T>);
    if (status != CE_None || messages.failed()) return unreadable(messages.why("GDAL gives no reason"));
    if (!signed_byte_) return {};
    for (T& value : stored)
        if (value > 127) value -= 256;
    return {};
}

Result<void> SourceFile::read_mask(const Window& window) {
    if (!has_mask_) return {};
    const GdalMessages messages;
    mask_.resize(static_cast<std::size_t>(window.samples()));
    GDALRasterBand& mask = *dataset_->GetRasterBand(1)->GetMaskBand();
    const CPLErr status = read_band(mask, window, placed_.flips, std::span(mask_), GDT_Byte);
    if (status != CE_None || messages.failed())
        return unreadable("its mask: " + messages.why("GDAL gives no reason"));
    return {};
}

bool SourceFile::in_range(double height_m) {
    if (std::abs(height_m) <= kMaxHeight_m) return true;
    ++context_->counts.out_of_range;
    return false;
}

double SourceFile::height_of(double stored) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (nodata_ && (stored == *nodata_ || (std::isnan(stored) && std::isnan(*nodata_)))) return kNone;
    if (!std::isfinite(stored)) {
        ++context_->counts.not_finite;
        return kNone;
    }
    const double height_m = stored * scale_m_ + offset_m_;
    if (!in_range(height_m)) return kNone;
    if (is_customary_nodata(stored))
        ++context_->counts.suspect;
    else
        context_->lowest_unsuspected_m = std::min(context_->lowest_unsuspected_m, height_m);
    return height_m;
}

std::int32_t SourceFile::step_of(double stored) {
    if (std::isnan(height_of(stored))) return kNoStep;
    return static_cast<std::int32_t>(scale_m_ < 0 ? -stored : stored);
}

Result<void> SourceFile::read_heights(const Window& window, std::span<double> heights_m) {
    RIDGELINE_CHECK(static_cast<std::int64_t>(heights_m.size()) == window.samples());
    RIDGELINE_TRY(read_stored(window, heights_m));
    RIDGELINE_TRY(read_mask(window));
    for (std::size_t i = 0; i < heights_m.size(); ++i)
        heights_m[i] = masked_out(i) ? std::numeric_limits<double>::quiet_NaN() : height_of(heights_m[i]);
    return {};
}

Result<void> SourceFile::read_steps(const Window& window, std::span<std::int32_t> steps) {
    RIDGELINE_CHECK(format_.integer && static_cast<std::int64_t>(steps.size()) == window.samples());
    if (fits_int32(type_)) {
        RIDGELINE_TRY(read_stored(window, steps));
        RIDGELINE_TRY(read_mask(window));
        for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = masked_out(i) ? kNoStep : step_of(steps[i]);
        return {};
    }
    wide_.resize(steps.size());
    RIDGELINE_TRY(read_stored(window, std::span(wide_)));
    RIDGELINE_TRY(read_mask(window));
    for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = masked_out(i) ? kNoStep : step_of(wide_[i]);
    return {};
}

}  // namespace ridgeline::raster
