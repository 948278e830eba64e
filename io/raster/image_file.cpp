// GDAL's raster model (gdal.org, "Raster Data Model") says what bands, colour interpretations, tables and
// masks mean.
#include "image_file.h"

#include <algorithm>
#include <cmath>

#include "gdal_session.h"

namespace ridgeline::raster {
namespace {

// Rows looked at to see which values a picture has.
constexpr int kSampledRows = 32;

bool is_cmyk_band(GDALColorInterp interpretation) {
    return interpretation >= GCI_CyanBand && interpretation <= GCI_BlackBand;
}
// Colours that none of our rules turns into red, green and blue.
bool is_foreign(GDALColorInterp interpretation) {
    return (interpretation >= GCI_HueBand && interpretation <= GCI_LightnessBand) ||
           (interpretation >= GCI_YCbCr_YBand && interpretation <= GCI_YCbCr_CrBand);
}

std::uint8_t without_ink(int ink, int black) {
    return static_cast<std::uint8_t>(((255 - ink) * (255 - black) + 127) / 255);
}

std::uint8_t byte_of(double value, const ValueRange& range) {
    const double unit = (value - range.black) / (range.white - range.black);
    return static_cast<std::uint8_t>(std::clamp(unit, 0.0, 1.0) * 255.0 + 0.5);
}

// The least alpha that counts as opaque.
double half_of(GDALDataType type) {
    if (type == GDT_Byte) return 128.0;
    if (type == GDT_UInt16) return 32768.0;
    return 0.5;
}

}  // namespace

ImageFile::ImageFile(std::string path, std::shared_ptr<ImageContext> context)
    : path_(std::move(path)), context_(std::move(context)) {}

ImageFile::~ImageFile() { context_->open_files.forget(this); }

Result<std::shared_ptr<ImageFile>> ImageFile::open(const std::string& path,
                                                   std::shared_ptr<ImageContext> context) {
    const GdalMessages messages;
    std::shared_ptr<ImageFile> file(new ImageFile(path, std::move(context)));
    auto found = gdal_path(path);
    if (!found) return Error{path + ": " + found.error().message};
    file->gdal_path_ = *found;
    RIDGELINE_TRY(file->reopen());
    if (const auto judged = file->judge(); !judged) return Error{path + ": " + judged.error().message};
    return file;
}

Result<void> ImageFile::reopen() {
    context_->open_files.used(this);
    if (dataset_) return {};
    const GdalMessages messages;
    dataset_ = open_dataset(gdal_path_, context_->options.threads);
    if (dataset_) return {};
    return unreadable(messages.why("not a raster that GDAL knows"));
}

Result<void> ImageFile::judge() {
    if (dataset_->GetRasterCount() == 0)
        return Error{"holds no raster band; if it has subdatasets (gdalinfo lists them), name one of them"};
    RIDGELINE_TRY(check_blocks(*dataset_, gdal_path_));
    auto placed = place(*dataset_, {});
    if (!placed) return placed.error();
    placed_ = std::move(*placed);
    RIDGELINE_TRY(judge_bands());
    judge_visible();
    return {};
}

int ImageFile::band_of(GDALColorInterp interpretation) const {
    for (int number = 1; number <= dataset_->GetRasterCount(); ++number)
        if (dataset_->GetRasterBand(number)->GetColorInterpretation() == interpretation) return number;
    return 0;
}

Result<void> ImageFile::judge_bands() {
    alpha_band_ = band_of(GCI_AlphaBand);
    const int colours = dataset_->GetRasterCount() - (alpha_band_ > 0 ? 1 : 0);
    const GDALColorInterp first = band(1).GetColorInterpretation();
    const std::vector<int> named = {band_of(GCI_RedBand), band_of(GCI_GreenBand), band_of(GCI_BlueBand)};
    if (is_foreign(first))
        return Error{std::string("holds ") + GDALGetColorInterpretationName(first) +
                     " colours, which are not understood: convert it to red, green and blue"};
    if (first == GCI_PaletteIndex) {
        bands_ = {1};
        RIDGELINE_TRY(judge_palette());
    } else if (std::none_of(named.begin(), named.end(), [](int number) { return number == 0; })) {
        bands_ = named;
    } else if (is_cmyk_band(first) && colours >= 4) {
        colours_ = Colours::cmyk;
        bands_ = {band_of(GCI_CyanBand), band_of(GCI_MagentaBand), band_of(GCI_YellowBand),
                  band_of(GCI_BlackBand)};
        if (std::count(bands_.begin(), bands_.end(), 0) > 0)
            return Error{"names some inks of a print but not all four"};
        notes_.push_back("inks (CMYK) are turned to red, green and blue");
    } else if (colours >= 3) {
        bands_ = {1, 2, 3};
        notes_.push_back("has " + std::to_string(dataset_->GetRasterCount()) +
                         " bands: the first three are taken as red, green and blue");
    } else if (colours == 1) {
        colours_ = Colours::grey;
        bands_ = {alpha_band_ == 1 ? 2 : 1};
    } else {
        return Error{"has " + std::to_string(colours) +
                     " bands, which are no colours: one (grey or palette) or three are"};
    }
    type_ = band(bands_.front()).GetRasterDataType();
    for (const int number : bands_) {
        const GDALDataType type = band(number).GetRasterDataType();
        if (GDALDataTypeIsComplex(type)) return Error{"holds complex numbers, not colours"};
        bytes_ &= type == GDT_Byte;
    }
    // A DEM taken for a picture has this.
    if (!bytes_ && colours_ == Colours::grey)
        notes_.push_back(std::string("has one band of ") + GDALGetDataTypeName(type_) + ": shown in grey");
    if (!bytes_ && (colours_ == Colours::cmyk || colours_ == Colours::palette))
        return Error{std::string("holds ") + (colours_ == Colours::cmyk ? "inks" : "a palette") +
                     " of more than 8 bits: convert it to red, green and blue"};
    return {};
}

Result<void> ImageFile::judge_palette() {
    colours_ = Colours::palette;
    const GDALColorTable* table = band(1).GetColorTable();
    if (table == nullptr) return Error{"has a palette's indices but no palette"};
    const GDALPaletteInterp kind = table->GetPaletteInterpretation();
    if (kind != GPI_RGB && kind != GPI_Gray)
        return Error{"has a palette of inks or hues: convert it to red, green and blue"};
    const int entries = std::min(table->GetColorEntryCount(), 256);
    for (int i = 0; i < entries; ++i) {
        const GDALColorEntry& entry = *table->GetColorEntry(i);
        const auto byte = [](short value) {
            return static_cast<std::uint8_t>(std::clamp<int>(value, 0, 255));
        };
        const bool grey = kind == GPI_Gray;
        palette_[static_cast<std::size_t>(i)] = {byte(entry.c1), byte(grey ? entry.c1 : entry.c2),
                                                 byte(grey ? entry.c1 : entry.c3),
                                                 grey || entry.c4 >= 128 ? kOpaqueAlpha : std::uint8_t{0}};
    }
    return {};
}

void ImageFile::judge_visible() {
    if (alpha_band_ > 0) alpha_half_ = half_of(band(alpha_band_).GetRasterDataType());
    for (const int number : bands_) {
        int declared = FALSE;
        const double value = band(number).GetNoDataValue(&declared);
        nodata_.push_back(declared ? std::optional(value) : std::nullopt);
    }
    const int flags = band(bands_.front()).GetMaskFlags();
    has_mask_ = alpha_band_ == 0 && (flags & GMF_PER_DATASET) != 0 && (flags & GMF_NODATA) == 0;
}

bool ImageFile::is_nodata(const std::uint8_t* stored) const {
    for (std::size_t i = 0; i < bands_.size(); ++i)
        if (!nodata_[i] || static_cast<double>(stored[i]) != *nodata_[i]) return false;
    return true;
}

bool ImageFile::is_nodata(std::span<const double> stored) const {
    for (std::size_t i = 0; i < stored.size(); ++i) {
        if (std::isnan(stored[i])) continue;
        if (!nodata_[i] || stored[i] != *nodata_[i]) return false;
    }
    return true;
}

Result<void> ImageFile::read_visible(const Window& window) {
    visible_.assign(static_cast<std::size_t>(window.samples()), 1);
    const GdalMessages messages;
    CPLErr status = CE_None;
    if (alpha_band_ > 0) {
        values_.resize(visible_.size());
        status = read_band(band(alpha_band_), window, placed_.flips, std::span(values_), GDT_Float64);
        for (std::size_t i = 0; i < visible_.size(); ++i) visible_[i] = values_[i] >= alpha_half_ ? 1 : 0;
    } else if (has_mask_) {
        GDALRasterBand& mask = *band(bands_.front()).GetMaskBand();
        status = read_band(mask, window, placed_.flips, std::span(visible_), GDT_Byte);
    }
    if (status != CE_None || messages.failed()) return unreadable("its mask: " + messages.why(kUnexplained));
    return {};
}

void ImageFile::expand(std::uint8_t* rgba) const {
    switch (colours_) {
        case Colours::red_green_blue:
            rgba[3] = kOpaqueAlpha;
            break;
        case Colours::grey:
            rgba[1] = rgba[2] = rgba[0];
            rgba[3] = kOpaqueAlpha;
            break;
        case Colours::palette:
            std::copy_n(palette_[rgba[0]].begin(), 4, rgba);
            break;
        case Colours::cmyk:
            for (std::size_t i = 0; i < 3; ++i) rgba[i] = without_ink(rgba[i], rgba[3]);
            rgba[3] = kOpaqueAlpha;
            break;
    }
}

Result<void> ImageFile::read_bytes(const Window& window, std::span<std::uint8_t> rgba) {
    const GdalMessages messages;
    const StoredWindow at = stored_window(window, placed_.flips, band(1));
    const CPLErr status = dataset_->RasterIO(
        GF_Read, at.column, at.row, at.columns, at.rows, rgba.data(), at.columns, at.rows, GDT_Byte,
        static_cast<int>(bands_.size()), bands_.data(), kColourBytes, kColourBytes * at.columns, 1, nullptr);
    if (status != CE_None || messages.failed()) return unreadable(messages.why(kUnexplained));
    turn_back(window, placed_.flips, rgba, kColourBytes);
    const bool may_lack = std::any_of(nodata_.begin(), nodata_.end(), [](auto& v) { return v.has_value(); });
    for (std::size_t i = 0; i < rgba.size(); i += kColourBytes) {
        const bool lacking = may_lack && is_nodata(&rgba[i]);
        expand(&rgba[i]);
        if (lacking || rgba[i + 3] == 0) std::fill_n(&rgba[i], kColourBytes, std::uint8_t{0});
    }
    return {};
}

Result<void> ImageFile::read_values(const Window& window, std::span<std::uint8_t> rgba) {
    const GdalMessages messages;
    const auto count = static_cast<std::size_t>(window.samples());
    stored_.resize(bands_.size());
    for (std::size_t i = 0; i < bands_.size(); ++i) {
        stored_[i].resize(count);
        const CPLErr status =
            read_band(band(bands_[i]), window, placed_.flips, std::span(stored_[i]), GDT_Float64);
        if (status != CE_None || messages.failed()) return unreadable(messages.why(kUnexplained));
    }
    for (std::size_t i = 0; i < count; ++i) {
        std::array<double, 3> values{};
        for (std::size_t c = 0; c < bands_.size(); ++c) values[c] = stored_[c][i];
        std::uint8_t* out = &rgba[i * kColourBytes];
        std::fill_n(out, kColourBytes, std::uint8_t{0});
        if (is_nodata(std::span(values).first(bands_.size()))) continue;
        for (std::size_t c = 0; c < bands_.size(); ++c)
            out[c] = std::isnan(values[c]) ? std::uint8_t{0} : byte_of(values[c], context_->range);
        expand(out);
    }
    return {};
}

Result<void> ImageFile::read(const Window& window, std::span<std::uint8_t> rgba) {
    RIDGELINE_CHECK(static_cast<std::int64_t>(rgba.size()) == window.samples() * kColourBytes);
    RIDGELINE_TRY(reopen());
    if (bytes_)
        RIDGELINE_TRY(read_bytes(window, rgba));
    else
        RIDGELINE_TRY(read_values(window, rgba));
    if (alpha_band_ == 0 && !has_mask_) return {};
    RIDGELINE_TRY(read_visible(window));
    for (std::size_t i = 0; i < visible_.size(); ++i)
        if (visible_[i] == 0) std::fill_n(&rgba[i * kColourBytes], kColourBytes, std::uint8_t{0});
    return {};
}

Result<void> ImageFile::sample_values(std::vector<double>& values) {
    RIDGELINE_TRY(reopen());
    const std::int64_t rows = std::min<std::int64_t>(height(), kSampledRows);
    std::vector<double> row(static_cast<std::size_t>(width()));
    for (std::int64_t i = 0; i < rows; ++i) {
        const Window window{0, (2 * i + 1) * height() / (2 * rows), width(), 1};
        RIDGELINE_TRY(read_visible(window));
        for (std::size_t c = 0; c < bands_.size(); ++c) {
            const GdalMessages messages;
            const CPLErr status =
                read_band(band(bands_[c]), window, placed_.flips, std::span(row), GDT_Float64);
            if (status != CE_None || messages.failed()) return unreadable(messages.why(kUnexplained));
            for (std::size_t x = 0; x < row.size(); ++x)
                if (visible_[x] != 0 && std::isfinite(row[x]) && !(nodata_[c] && row[x] == *nodata_[c]))
                    values.push_back(row[x]);
        }
    }
    return {};
}

}  // namespace ridgeline::raster
