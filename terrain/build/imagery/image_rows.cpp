#include "ridgeline/build/imagery/image_rows.h"

#include <utility>

#include "ridgeline/raster/image_source.h"

namespace ridgeline::build {
namespace {

class ImageRows final : public TexelRows {
  public:
    ImageRows(raster::ImageSource source, const std::vector<std::string>& paths)
        : source_(std::move(source)) {
        const raster::ImageSourceInfo& from = source_.info();
        info_.west_m = from.west_m;
        info_.north_m = from.north_m;
        info_.spacing_x_m = from.spacing_x_m;
        info_.spacing_y_m = from.spacing_y_m;
        info_.width = from.width;
        info_.height = from.height;
        info_.sources = paths;
        info_.notes = from.notes;
        info_.generator = "ridgeline " RIDGELINE_VERSION;
    }

    const io::ImageryInfo& info() const override { return info_; }

    Result<void> read(std::int64_t row, std::int64_t rows, std::span<Texel> texels) override {
        // A texel is the four bytes that the source gives.
        return source_.read_rows(
            row, rows, {reinterpret_cast<std::uint8_t*>(texels.data()), texels.size() * sizeof(Texel)});
    }

  private:
    raster::ImageSource source_;
    io::ImageryInfo info_;
};

}  // namespace

Result<std::unique_ptr<TexelRows>> open_imagery(const ImageSources& sources, const io::TerrainInfo& terrain) {
    const raster::TerrainPlace place{terrain.crs_wkt,      terrain.min_east_m(),  terrain.min_north_m(),
                                     terrain.max_east_m(), terrain.max_north_m(), terrain.spacing_x_m,
                                     terrain.spacing_y_m};
    auto source = raster::ImageSource::open(sources.paths, place, {sources.cache_bytes, sources.threads});
    if (!source) return source.error();
    return std::unique_ptr<TexelRows>(std::make_unique<ImageRows>(std::move(*source), sources.paths));
}

}  // namespace ridgeline::build
