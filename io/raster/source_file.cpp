// GDAL's raster model (gdal.org, "Raster Data Model") says what bands, masks, scales and units mean.
#include "source_file.h"

#include <algorithm>
#include <cmath>

#include "gdal_session.h"
#include "undeclared_nodata.h"

namespace ridgeline::raster {
namespace {

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

}  // namespace

SourceFile::SourceFile(std::string path, std::shared_ptr<SourceContext> context)
    : path_(std::move(path)), context_(std::move(context)) {}

SourceFile::~SourceFile() { context_->open_files.forget(this); }

Error SourceFile::unreadable(const std::string& why) const { return unreadable_file(path_, gdal_path_, why); }

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
    dataset_ = open_dataset(gdal_path_, context_->options.threads);
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
    int block_columns = 1, block_rows = 1;
    band.GetBlockSize(&block_columns, &block_rows);
    natural_rows_ = std::clamp(block_rows, 1, band.GetYSize());
    if (const auto checked = check_blocks(*dataset_, gdal_path_); !checked)
        return Error{path_ + ": " + checked.error().message};
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
    if (status != CE_None || messages.failed()) return unreadable(messages.why(kUnexplained));
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
    if (status != CE_None || messages.failed()) return unreadable("its mask: " + messages.why(kUnexplained));
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
