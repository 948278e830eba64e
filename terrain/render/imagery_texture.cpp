#include "ridgeline/render/imagery_texture.h"

#include <algorithm>
#include <utility>

#include "ridgeline/gl/capabilities.h"
#include "ridgeline/io/imagery_tile.h"

namespace ridgeline::render {
namespace {

constexpr GLenum kFormat = GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;
static_assert(shaders::kTileSide == io::kImageryTexels && shaders::kTileGutter == io::kImageryGutter);
static_assert(1 << shaders::kTileTexelBits == io::kImageryTile);

// How many times longer than wide a pixel's print may be before the picture blurs. The shader's lookups stay
// within the gutter; a sampler's past it meet the tile's edge again.
constexpr float longest_print(PrintFilter filter) { return filter == PrintFilter::sampler ? 8.0f : 4.0f; }
// Half as many as the longest print has round parts: where the CPU draws, each costs a twentieth of the
// frame.
constexpr float kShaderTaps = 2.0f;
// How many times wider than a pixel that faces the ground its print's round parts get at most: beyond it,
// ground seen on edge shows the colours of what is far around.
constexpr double kMostPrint = 32.0;

VirtualTextureOptions texture_options(const io::Grid& grid, const SlotShape& shape) {
    return {.kind = pager::TileKind::imagery,
            .grid = grid,
            .shape = shape,
            .texels = {.format = kFormat,
                       .layout = {kFormat},
                       .mips = {{io::kImageryTexels, 0}, {io::kImageryMipTexels, io::kImageryMipOffset}},
                       .label = "imagery"},
            .bindings = {shaders::kImageryUniformsBinding, shaders::kImageryFadesBinding,
                         shaders::kPageTableUnit, shaders::kImageryUnit}};
}

}  // namespace

shaders::ImageryUniforms imagery_uniforms(const io::ImageryInfo& info, const glm::dvec2& eye_m) {
    const glm::dvec2 eye = info.texel(eye_m.x, eye_m.y);
    const glm::dvec2 last(static_cast<double>(info.width - 1), static_cast<double>(info.height - 1));
    const glm::dvec2 cell = glm::clamp(glm::floor(eye), glm::dvec2(0.0), last);
    shaders::ImageryUniforms imagery{};
    imagery.eye_rest_and_scale = glm::vec4(eye - cell, 1.0 / info.spacing_x_m, 1.0 / info.spacing_y_m);
    imagery.eye_cell_and_size =
        glm::ivec4(glm::ivec2(cell), static_cast<int>(info.width), static_cast<int>(info.height));
    return imagery;
}

// A little to spare: the shader's float may have a place on the border a little outside.
bool covers(const io::ImageryInfo& imagery, std::span<const io::ImageryRecord> records,
            const io::TerrainInfo& terrain) {
    const glm::dvec2 first = imagery.texel(terrain.min_east_m(), terrain.max_north_m());
    const glm::dvec2 last = imagery.texel(terrain.max_east_m(), terrain.min_north_m());
    constexpr double kSpare = 1.0 / 64.0;
    if (first.x < kSpare || first.y < kSpare || last.x > static_cast<double>(imagery.width) - kSpare ||
        last.y > static_cast<double>(imagery.height) - kSpare)
        return false;
    return std::ranges::all_of(
        records, [](const io::ImageryRecord& record) { return record.has_data() && !record.has_holes(); });
}

Result<ImageryTexture> ImageryTexture::create(const io::ImageryInfo& info, const pager::TileSource& source,
                                              const ImageryTextureOptions& options) {
    if (!gl::query_capabilities().s3tc)
        return Error{"imagery: this GPU cannot read BC1 textures (GL_EXT_texture_compression_s3tc)"};
    const auto shape = plan_slots(imagery_demand(source), options.slots);
    if (!shape) return shape.error();
    auto tiles = VirtualTexture::create(source.tiles(), texture_options(source.imagery.grid, *shape));
    if (!tiles) return tiles.error();
    return ImageryTexture(info, source.imagery.grid, std::move(tiles).value(), options.print_filter);
}

ImageryTexture::ImageryTexture(const io::ImageryInfo& info, const io::Grid& grid, VirtualTexture tiles,
                               PrintFilter print_filter)
    : info_(info),
      finest_level_(grid.finest()),
      tiles_(std::move(tiles)),
      sampler_(gl::Sampler::create({.min_filter = GL_LINEAR_MIPMAP_LINEAR,
                                    .max_anisotropy = print_filter == PrintFilter::sampler
                                                          ? longest_print(PrintFilter::sampler)
                                                          : 1.0f})),
      print_filter_(print_filter) {}

shaders::ImageryUniforms ImageryTexture::uniforms(const platform::Camera& camera) const {
    shaders::ImageryUniforms imagery = imagery_uniforms(info_, glm::dvec2(camera.pose.eye_m));
    imagery.table = glm::ivec4(finest_level_, tiles_.window_bits(), 0);
    const double texels_per_m = 1.0 / std::min(info_.spacing_x_m, info_.spacing_y_m);
    imagery.filtering =
        glm::vec4(longest_print(print_filter_), print_filter_ == PrintFilter::shader ? kShaderTaps : 1.0f,
                  kMostPrint * texels_per_m / platform::pixels_per_tangent(camera.lens), 0.0);
    return imagery;
}

bool ImageryTexture::prepare(const platform::Camera& camera, const pager::Pager& pager,
                             gl::StagingRing& ring) {
    const shaders::ImageryUniforms imagery = uniforms(camera);
    tiles_.look_from(glm::ivec2(imagery.eye_cell_and_size), pager);
    return tiles_.send(std::as_bytes(std::span(&imagery, 1)), ring);
}

}  // namespace ridgeline::render
