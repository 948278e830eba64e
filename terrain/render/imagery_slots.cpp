#include "ridgeline/render/imagery_slots.h"

#include <algorithm>
#include <cstring>

#include "ridgeline/gl/capabilities.h"
#include "ridgeline/io/imagery_tile.h"
#include "ridgeline/render/page_table.h"
#include "ridgeline/shaders/shared/imagery_uniforms.h"

namespace ridgeline::render {
namespace {

constexpr GLenum kFormat = GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;
static_assert(shaders::kTileSide == io::kImageryTexels && shaders::kTileGutter == io::kImageryGutter);
static_assert(1 << shaders::kTileTexelBits == io::kImageryTile);
// What an entry of the page table can name.
constexpr int kMostLayers = static_cast<int>(shaders::kPageSlotMask);

std::int64_t tile_count(std::span<const io::ImageryRecord> records) {
    return std::ranges::count_if(records, [](const io::ImageryRecord& record) { return record.has_data(); });
}

ImagerySlotsShape level0_alone(const io::Grid& grid) {
    return {static_cast<int>(grid.first(1)), 0, PageTable::bytes(grid)};
}

}  // namespace

std::uint64_t ImagerySlotsShape::total_bytes() const {
    return static_cast<std::uint64_t>(layers()) * io::kImageryTileBytes + table_bytes;
}

std::uint64_t least_imagery_bytes(const pager::TileSource& source) {
    return level0_alone(source.imagery.grid).total_bytes();
}

Result<ImagerySlotsShape> plan_imagery_slots(const pager::TileSource& source,
                                             const ImagerySlotsOptions& options) {
    const pager::ImagerySource& imagery = source.imagery;
    const int most_layers = std::min(options.max_layers, kMostLayers);
    const std::int64_t roots = imagery.grid.first(1);
    if (roots > most_layers)
        return Error{source.name + ": its imagery is too long and narrow: level 0 has " +
                     std::to_string(roots) + " tiles, of which a texture holds " +
                     std::to_string(most_layers)};
    ImagerySlotsShape shape = level0_alone(imagery.grid);
    if (shape.total_bytes() > options.capacity_bytes)
        return Error{source.name +
                     ": the coarsest level of its imagery does not fit the GPU cache: use --gpu-cache " +
                     std::to_string((shape.total_bytes() * options.parts + 1023) / 1024) + "KiB or more"};
    const std::uint64_t fit = (options.capacity_bytes - shape.total_bytes()) / io::kImageryTileBytes;
    const std::int64_t others =
        tile_count(imagery.records) - tile_count(imagery.records.first(static_cast<std::size_t>(roots)));
    shape.slots = static_cast<int>(
        std::min({static_cast<std::int64_t>(fit), std::int64_t{most_layers} - roots, others}));
    return shape;
}

Result<ImagerySlots> ImagerySlots::create(const ImagerySlotsShape& shape) {
    if (!gl::query_capabilities().s3tc)
        return Error{"imagery: this GPU cannot read BC1 textures (GL_EXT_texture_compression_s3tc)"};
    ImagerySlots slots(shape);
    auto texture = gl::Texture2DArray::create({.format = kFormat,
                                               .size_px = glm::ivec2(io::kImageryTexels),
                                               .levels = 2,
                                               .layers = shape.layers(),
                                               .label = "imagery"});
    if (!texture) return texture.error();
    slots.texture_ = std::move(texture).value();
    return slots;
}

ImagerySlots::ImagerySlots(const ImagerySlotsShape& shape) : shape_(shape) {
    free_.reserve(static_cast<std::size_t>(shape.slots));
    released_.reserve(static_cast<std::size_t>(shape.slots));
    for (int layer = shape.layers(); layer-- > shape.roots;)
        free_.push_back(static_cast<std::uint32_t>(layer));
}

ImagerySlots::Outcome ImagerySlots::store(std::span<const std::byte> texels, gl::StagingRing& staging) {
    if (free_.empty()) return {Stored::no_room};
    const std::uint32_t layer = free_.back();
    if (!upload(layer, texels, staging)) return {Stored::staging_full};
    free_.pop_back();
    return {Stored::yes, pager::GpuSlot{layer}};
}

ImagerySlots::Outcome ImagerySlots::store_root(int root, std::span<const std::byte> texels,
                                               gl::StagingRing& staging) {
    const auto layer = static_cast<std::uint32_t>(root);
    if (!upload(layer, texels, staging)) return {Stored::staging_full};
    return {Stored::yes, pager::GpuSlot{layer}};
}

bool ImagerySlots::upload(std::uint32_t layer, std::span<const std::byte> texels, gl::StagingRing& staging) {
    const auto staged = staging.allocate(texels.size());
    if (!staged) return false;
    std::memcpy(staged->bytes.data(), texels.data(), texels.size());
    const auto to_layer = static_cast<int>(layer);
    texture_.upload({0, to_layer, {0, 0}, glm::ivec2(io::kImageryTexels)}, {kFormat}, staging.buffer(),
                    staged->offset_bytes);
    texture_.upload({1, to_layer, {0, 0}, glm::ivec2(io::kImageryMipTexels)}, {kFormat}, staging.buffer(),
                    staged->offset_bytes + io::kImageryMipOffset);
    return true;
}

void ImagerySlots::release(pager::GpuSlot slot, std::uint32_t frame) {
    const auto layer = static_cast<std::uint32_t>(slot);
    if (frame <= completed_frame_)
        free_.push_back(layer);
    else
        released_.push_back({layer, frame});
}

void ImagerySlots::begin_frame(std::uint32_t completed_frame) {
    completed_frame_ = completed_frame;
    std::erase_if(released_, [this](const Released& released) {
        if (released.frame > completed_frame_) return false;
        free_.push_back(released.layer);
        return true;
    });
}

std::uint64_t ImagerySlots::used_bytes() const {
    return static_cast<std::uint64_t>(shape_.roots + used_slots()) * io::kImageryTileBytes +
           shape_.table_bytes;
}

}  // namespace ridgeline::render
