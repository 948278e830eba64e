// How pictures become one lattice over the terrain: which lie on it as they are, and which must be warped.
#include "image_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "gdal_session.h"
#include "image_file.h"
#include "image_range.h"
#include "ridgeline/base/log.h"
#include "warped_image.h"

namespace ridgeline::raster {
namespace {

// A lattice is another's while no texel is off by more than this share of a spacing.
constexpr double kLatticeTolerance = 0.02;
// A picture must be finer by more than this for its lattice to be taken instead of an earlier one's.
constexpr double kFiner = 0.99;
// A layer of more texels than this many times those that the pictures hold is not what one expects.
constexpr double kMuchMore = 4.0;
// Pictures have some of the heights' samples a texel, or a few texels a sample; not this many samples.
constexpr double kCoarseTexel = 64.0;

// A picture, where it lies, and how its texels lie in the terrain's plane.
struct Picture {
    std::shared_ptr<ImageFile> file;
    Placement placement;    // its own
    Placement on_plane;     // north-up in the terrain's plane: its own, or what warping would give
    bool as_it_is = false;  // they are the same
    const std::string& name() const { return file->path(); }
};

// A part of the lattice and where it lies in it.
struct Part {
    std::shared_ptr<ImageGrid> grid;
    std::int64_t column = 0, row = 0;  // of the grid's first texel, in the lattice
};

struct Extent {
    double west = 0.0, south = 0.0, east = 0.0, north = 0.0;

    bool is_empty() const { return !(west < east && south < north); }
};

Extent extent_of(const Placement& p) {
    const auto& t = p.world_from_pixel;
    return {t[0], t[3] + t[5] * static_cast<double>(p.height), t[0] + t[1] * static_cast<double>(p.width),
            t[3]};
}
Extent common(const Extent& a, const Extent& b) {
    return {std::max(a.west, b.west), std::max(a.south, b.south), std::min(a.east, b.east),
            std::min(a.north, b.north)};
}
Extent around(const Extent& a, const Extent& b) {
    return {std::min(a.west, b.west), std::min(a.south, b.south), std::max(a.east, b.east),
            std::max(a.north, b.north)};
}
Extent extent_of(const TerrainPlace& terrain) {
    return {terrain.west_m, terrain.south_m, terrain.east_m, terrain.north_m};
}

// A terrain without a georeference counts samples from its south-western one.
bool is_in_pixels(const TerrainPlace& terrain) {
    return terrain.crs_wkt.empty() && terrain.west_m == 0.0 && terrain.south_m == 0.0 &&
           terrain.spacing_x_m == 1.0 && terrain.spacing_y_m == 1.0;
}

// Over the areas of all samples: the picture of as many pixels as the raster has samples fits it one to one.
void spread_over(const TerrainPlace& terrain, Placement& placement) {
    const double width = terrain.east_m + 1.0, height = terrain.north_m + 1.0;
    placement.world_from_pixel = {-0.5, width / static_cast<double>(placement.width),
                                  0,    terrain.north_m + 0.5,
                                  0,    -height / static_cast<double>(placement.height)};
    placement.georeferenced = true;
}

// Gives the picture a place in a CRS, or says why it has none.
Result<void> settle_place(const ImageFile& file, const TerrainPlace& terrain,
                          const OGRSpatialReference& plane, Placement& placement,
                          std::vector<std::string>& notes) {
    if (!placement.georeferenced) {
        if (!is_in_pixels(terrain))
            return Error{"has no georeference, so its place on the terrain is unknown"};
        spread_over(terrain, placement);
        notes.push_back(file.path() + ": no georeference: spread over the whole terrain");
        return {};
    }
    if (placement.crs.IsEmpty()) {
        if (!plane.IsEmpty())
            notes.push_back(file.path() + ": names no CRS; its coordinates are taken to be in the terrain's");
        placement.crs = plane;
        return {};
    }
    if (plane.IsEmpty())
        return Error{"names a CRS, the terrain has none: build the terrain with --crs first"};
    for (const std::string& note : file.placed().notes) notes.push_back(file.path() + ": " + note);
    return {};
}

Result<Picture> place_picture(std::shared_ptr<ImageFile> file, const TerrainPlace& terrain,
                              const OGRSpatialReference& plane, std::vector<std::string>& notes) {
    Picture picture;
    picture.file = file;
    picture.placement = file->placed().placement;
    const auto named = [&](const Error& error) { return Error{file->path() + ": " + error.message}; };
    if (const auto settled = settle_place(*file, terrain, plane, picture.placement, notes); !settled)
        return named(settled.error());
    picture.as_it_is = picture.placement.is_north_up() && same_plane(picture.placement.crs, plane);
    picture.on_plane = picture.placement;
    if (picture.as_it_is) return picture;
    auto suggested = suggested_placement(file, picture.placement, plane);
    if (!suggested) return named(suggested.error());
    picture.on_plane = *suggested;
    return picture;
}

double texel_area(const Placement& placement) { return placement.spacing_x() * placement.spacing_y(); }

double area(const Extent& e) { return e.is_empty() ? 0.0 : (e.east - e.west) * (e.north - e.south); }

// One small fine picture among large coarse ones makes all of them as fine.
void note_fineness(const std::vector<Picture>& pictures, const Picture& finest, const Placement& lattice,
                   std::vector<std::string>& notes) {
    double held = 0.0;
    for (const Picture& picture : pictures)
        held += area(common(extent_of(picture.on_plane), extent_of(lattice))) / texel_area(picture.on_plane);
    const double texels = static_cast<double>(lattice.width) * static_cast<double>(lattice.height);
    if (texels <= kMuchMore * held) return;
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  ": is so much finer than the others that the imagery has %.0f times the texels that they "
                  "hold: %lld x %lld",
                  texels / held, static_cast<long long>(lattice.width),
                  static_cast<long long>(lattice.height));
    notes.push_back(finest.name() + text.data());
    log_line(LogLevel::warn, notes.back());
}

void note_coarseness(const Picture& picture, const TerrainPlace& terrain, std::vector<std::string>& notes) {
    const double samples = std::max(picture.on_plane.spacing_x() / terrain.spacing_x_m,
                                    picture.on_plane.spacing_y() / terrain.spacing_y_m);
    if (samples < kCoarseTexel) return;
    std::array<char, 80> text{};
    std::snprintf(text.data(), text.size(), ": a texel of it covers %.0f samples of the heights each way",
                  samples);
    notes.push_back(picture.name() + text.data());
}

bool is_near_whole(double value) { return std::abs(value - std::round(value)) <= kLatticeTolerance; }

bool lies_on(const Placement& lattice, const Placement& own) {
    const double stretch_x =
        std::abs(own.spacing_x() / lattice.spacing_x() - 1) * static_cast<double>(own.width);
    const double stretch_y =
        std::abs(own.spacing_y() / lattice.spacing_y() - 1) * static_cast<double>(own.height);
    return stretch_x <= kLatticeTolerance && stretch_y <= kLatticeTolerance &&
           is_near_whole((own.world_from_pixel[0] - lattice.world_from_pixel[0]) / lattice.spacing_x()) &&
           is_near_whole((lattice.world_from_pixel[3] - own.world_from_pixel[3]) / lattice.spacing_y());
}

// The texels of the lattice that an extent touches, as a placement of their own. Slivers that rounding makes
// at an edge do not count.
Placement covering(const Placement& lattice, const Extent& extent) {
    const double dx = lattice.spacing_x(), dy = lattice.spacing_y();
    const double left = lattice.world_from_pixel[0], top = lattice.world_from_pixel[3];
    const auto first = [](double at) { return std::floor(at + kLatticeTolerance); };
    const auto last = [](double at) { return std::ceil(at - kLatticeTolerance); };
    const double column = first((extent.west - left) / dx), row = first((top - extent.north) / dy);
    Placement placement = lattice;
    placement.width = std::max<std::int64_t>(1, std::llround(last((extent.east - left) / dx) - column));
    placement.height = std::max<std::int64_t>(1, std::llround(last((top - extent.south) / dy) - row));
    placement.world_from_pixel = {left + column * dx, dx, 0, top - row * dy, 0, -dy};
    return placement;
}

std::int64_t columns_from(const Placement& lattice, const Placement& own) {
    return std::llround((own.world_from_pixel[0] - lattice.world_from_pixel[0]) / lattice.spacing_x());
}
std::int64_t rows_from(const Placement& lattice, const Placement& own) {
    return std::llround((lattice.world_from_pixel[3] - own.world_from_pixel[3]) / lattice.spacing_y());
}

Result<Part> part_of(const Picture& picture, const Placement& lattice, int threads,
                     std::vector<std::string>& notes) {
    if (picture.as_it_is && lies_on(lattice, picture.placement))
        return Part{picture.file, columns_from(lattice, picture.placement),
                    rows_from(lattice, picture.placement)};
    notes.push_back(picture.name() + (picture.as_it_is ? ": is resampled onto a finer picture's lattice"
                                      : picture.placement.is_north_up()
                                          ? ": is resampled to the terrain's CRS"
                                          : ": is rotated and resampled to north-up"));
    const Extent seen = common(extent_of(picture.on_plane), extent_of(lattice));
    const Placement target = covering(lattice, seen);
    auto warped = WarpedImage::create(picture.file, picture.placement, target, threads);
    if (!warped) return Error{picture.name() + ": " + warped.error().message};
    return Part{*warped, columns_from(lattice, target), rows_from(lattice, target)};
}

bool is_opaque(const std::uint8_t* colour) { return colour[3] != 0; }

}  // namespace

struct ImageSource::State {
    std::shared_ptr<ImageContext> context = std::make_shared<ImageContext>();
    std::vector<Part> parts;
    ImageSourceInfo info;
    std::vector<std::uint8_t> scratch;

    Result<void> set_range(const std::vector<std::shared_ptr<ImageFile>>& files);
    Result<void> join(std::vector<Picture> pictures, const TerrainPlace& terrain);
    Result<void> paint(const Part& part, const Window& window, std::span<std::uint8_t> rgba);
};

Result<void> ImageSource::State::set_range(const std::vector<std::shared_ptr<ImageFile>>& files) {
    std::vector<double> values;
    std::string names;
    GDALDataType type = GDT_Byte;
    for (const auto& file : files) {
        if (!file->needs_range()) continue;
        names += (names.empty() ? "" : ", ") + file->path();
        type = GDALDataTypeUnion(type, file->data_type());
        RIDGELINE_TRY(file->sample_values(values));
    }
    if (type == GDT_Byte) return {};
    context->range = choose_range(std::move(values), type);
    info.notes.push_back(names + ": " + GDALGetDataTypeName(type) + ": " + described(context->range));
    return {};
}

Result<void> ImageSource::State::join(std::vector<Picture> pictures, const TerrainPlace& terrain) {
    const Extent ground = extent_of(terrain);
    const std::string first = pictures.front().name();
    std::erase_if(pictures, [&](const Picture& picture) {
        const bool apart = common(extent_of(picture.on_plane), ground).is_empty();
        if (apart) info.notes.push_back(picture.name() + ": does not touch the terrain");
        return apart;
    });
    if (pictures.empty()) return Error{first + ": does not touch the terrain"};
    const Picture* finest = &pictures.front();
    Extent seen = extent_of(finest->on_plane);
    for (const Picture& picture : pictures) {
        if (texel_area(picture.on_plane) < kFiner * kFiner * texel_area(finest->on_plane)) finest = &picture;
        seen = around(seen, extent_of(picture.on_plane));
    }
    const Placement lattice = covering(finest->on_plane, common(seen, ground));
    note_fineness(pictures, *finest, lattice, info.notes);
    for (const Picture& picture : pictures) {
        note_coarseness(picture, terrain, info.notes);
        auto part = part_of(picture, lattice, context->options.threads, info.notes);
        if (!part) return part.error();
        parts.push_back(std::move(*part));
    }
    info.width = lattice.width;
    info.height = lattice.height;
    info.spacing_x_m = lattice.spacing_x();
    info.spacing_y_m = lattice.spacing_y();
    info.west_m = lattice.world_from_pixel[0];
    info.north_m = lattice.world_from_pixel[3];
    return {};
}

ImageSource::ImageSource(std::unique_ptr<State> state) : state_(std::move(state)) {}
ImageSource::ImageSource(ImageSource&&) noexcept = default;
ImageSource& ImageSource::operator=(ImageSource&&) noexcept = default;
ImageSource::~ImageSource() = default;

Result<ImageSource> ImageSource::open(const std::vector<std::string>& paths, const TerrainPlace& terrain,
                                      const ImageOptions& options) {
    if (paths.empty()) return Error{"no picture is given"};
    prepare_gdal(options.cache_bytes);
    const GdalMessages quiet;
    OGRSpatialReference plane;
    if (!terrain.crs_wkt.empty()) {
        if (plane.importFromWkt(terrain.crs_wkt.c_str()) != OGRERR_NONE)
            return Error{"the terrain's CRS is not one that PROJ knows"};
        plane.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    }
    auto state = std::make_unique<State>();
    state->context->options = options;
    std::vector<std::shared_ptr<ImageFile>> files;
    std::vector<Picture> pictures;
    for (const std::string& path : paths) {
        auto file = ImageFile::open(path, state->context);
        if (!file) return file.error();
        for (const std::string& note : (*file)->notes()) state->info.notes.push_back(path + ": " + note);
        auto picture = place_picture(*file, terrain, plane, state->info.notes);
        if (!picture) return picture.error();
        files.push_back(*file);
        pictures.push_back(std::move(*picture));
    }
    RIDGELINE_TRY(state->set_range(files));
    RIDGELINE_TRY(state->join(std::move(pictures), terrain));
    return ImageSource(std::move(state));
}

const ImageSourceInfo& ImageSource::info() const { return state_->info; }

// Parts may reach beyond the lattice: what they have of the window is read.
Result<void> ImageSource::State::paint(const Part& part, const Window& window, std::span<std::uint8_t> rgba) {
    const std::int64_t west = std::max(part.column, window.column), north = std::max(part.row, window.row);
    const std::int64_t columns =
        std::min(part.column + part.grid->width(), window.column + window.columns) - west;
    const std::int64_t rows = std::min(part.row + part.grid->height(), window.row + window.rows) - north;
    if (columns <= 0 || rows <= 0) return {};
    const Window inner{west - part.column, north - part.row, columns, rows};
    const bool whole = parts.size() == 1 && inner.samples() == window.samples();
    if (whole) return part.grid->read(inner, rgba);
    scratch.resize(static_cast<std::size_t>(inner.samples() * kColourBytes));
    RIDGELINE_TRY(part.grid->read(inner, scratch));
    for (std::int64_t y = 0; y < rows; ++y) {
        const std::uint8_t* from = &scratch[static_cast<std::size_t>(y * columns * kColourBytes)];
        std::uint8_t* to = &rgba[static_cast<std::size_t>(
            ((north + y - window.row) * window.columns + west - window.column) * kColourBytes)];
        for (std::int64_t x = 0; x < columns * kColourBytes; x += kColourBytes)
            if (is_opaque(from + x)) std::copy_n(from + x, kColourBytes, to + x);
    }
    return {};
}

Result<void> ImageSource::read_rows(std::int64_t row, std::int64_t rows, std::span<std::uint8_t> rgba) {
    const ImageSourceInfo& info = state_->info;
    RIDGELINE_CHECK(row >= 0 && rows >= 0 && row + rows <= info.height);
    RIDGELINE_CHECK(static_cast<std::int64_t>(rgba.size()) == rows * info.width * kColourBytes);
    std::fill(rgba.begin(), rgba.end(), std::uint8_t{0});
    for (const Part& part : state_->parts)
        RIDGELINE_TRY(state_->paint(part, {0, row, info.width, rows}, rgba));
    return {};
}

}  // namespace ridgeline::raster
