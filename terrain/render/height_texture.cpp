#include "ridgeline/render/height_texture.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "ridgeline/base/contract.h"
#include "ridgeline/pager/heights_texels.h"
#include "ridgeline/shaders/shared/imagery_uniforms.h"

namespace ridgeline::render {
namespace {

using Staging = gl::StagingRing;
using pager::TileKind;

static_assert(shaders::kHeightApron == io::HeightsTile::kApron);
// What an entry of the page table can name.
constexpr int kMostLayers = static_cast<int>(shaders::kPageSlotMask);

std::uint64_t aligned(std::uint64_t bytes) {
    return (bytes + Staging::kAlignment - 1) / Staging::kAlignment * Staging::kAlignment;
}

int tile_bits(const io::Grid& grid) { return std::countr_zero(static_cast<unsigned>(grid.quads())); }

HeightSlotsShape level0_alone(const io::Grid& grid) {
    return {grid.quads(), static_cast<int>(grid.first(1)), 0, PageTable::bytes(grid)};
}

}  // namespace

std::uint64_t HeightSlotsShape::total_bytes() const {
    return static_cast<std::uint64_t>(layers()) * pager::heights_texels_bytes(quads) + table_bytes;
}

std::uint64_t least_height_bytes(const pager::TileSource& source) {
    return level0_alone(source.grid).total_bytes();
}

Result<HeightSlotsShape> plan_height_slots(const pager::TileSource& source,
                                           const HeightSlotsOptions& options) {
    const int most_layers = std::min(options.max_layers, kMostLayers);
    const std::int64_t roots = source.grid.first(1);
    if (roots > most_layers)
        return Error{source.name + ": it is too long and narrow for the disc: level 0 has " +
                     std::to_string(roots) + " tiles, of which a texture holds " +
                     std::to_string(most_layers)};
    HeightSlotsShape shape = level0_alone(source.grid);
    if (shape.total_bytes() > options.capacity_bytes)
        return Error{source.name +
                     ": the coarsest level of its heights does not fit the GPU cache: use --gpu-cache " +
                     std::to_string((shape.total_bytes() * options.parts + 1023) / 1024) + "KiB or more"};
    const std::uint64_t fit =
        (options.capacity_bytes - shape.total_bytes()) / pager::heights_texels_bytes(shape.quads);
    shape.slots =
        static_cast<int>(std::min({static_cast<std::int64_t>(fit), std::int64_t{most_layers} - roots,
                                   source.grid.node_count() - roots}));
    return shape;
}

shaders::DiscUniforms disc_uniforms(const io::Grid& grid, const DiscView& view) {
    shaders::DiscUniforms disc{};
    disc.eye_cell_and_size =
        glm::ivec4(view.eye.cell, static_cast<int>(grid.width()), static_cast<int>(grid.height()));
    const float spacing_m = std::max(view.eye.spacing_m.x, view.eye.spacing_m.y);
    disc.eye =
        glm::vec4(view.eye.cell_rest, 1.0f / (static_cast<float>(view.projection_px) * spacing_m), 0.0f);
    // The cell is kept on the terrain, the eye need not be.
    const glm::vec2 middle = glm::clamp(view.eye.cell_rest, glm::vec2(0.0f), glm::vec2(1.0f));
    const float above = static_cast<float>(view.eye_above_ground_m) / spacing_m;
    disc.middle =
        glm::vec4(middle, glm::length(glm::vec2(above, glm::distance(middle, view.eye.cell_rest))), 0.0f);
    return disc;
}

Result<HeightTexture> HeightTexture::create(const pager::TileSource& source,
                                            const HeightSlotsOptions& options) {
    RIDGELINE_CHECK(source.heights_tiles == pager::HeightsTiles::paged);
    const auto shape = plan_height_slots(source, options);
    if (!shape) return shape.error();
    HeightTexture made(source, *shape);
    RIDGELINE_TRY(made.create_textures());
    return made;
}

HeightTexture::HeightTexture(const pager::TileSource& source, const HeightSlotsShape& shape)
    : shape_(shape), tiles_(source.tiles()), table_(source.grid, tile_bits(source.grid)) {
    const auto layers = static_cast<std::size_t>(shape.layers());
    free_.reserve(layers);
    released_.reserve(layers);
    for (int layer = shape.layers(); layer-- > shape.roots;)
        free_.push_back(static_cast<std::uint32_t>(layer));
    tile_of_slot_.assign(layers, pager::kNoNode);
    fades_.assign(layers, 0.0f);
    changed_.reserve(static_cast<std::size_t>(source.grid.levels() * table_.rows()));
}

Result<void> HeightTexture::create_textures() {
    auto tiles = gl::Texture2DArray::create({.format = GL_R32I,
                                             .size_px = glm::ivec2(pager::heights_texels_side(shape_.quads)),
                                             .layers = shape_.layers(),
                                             .label = "heights"});
    if (!tiles) return tiles.error();
    auto table = gl::Texture2DArray::create({.format = GL_R32UI,
                                             .size_px = {table_.columns(), table_.rows()},
                                             .layers = tiles_.grid(TileKind::heights).levels(),
                                             .label = "heights page table"});
    if (!table) return table.error();
    texture_ = std::move(tiles).value();
    table_texture_ = std::move(table).value();
    sampler_ = gl::Sampler::create({.min_filter = GL_NEAREST, .mag_filter = GL_NEAREST});
    return {};
}

void HeightTexture::begin_frame(std::uint32_t frame, std::uint32_t completed_frame) {
    frame_ = frame;
    completed_frame_ = completed_frame;
    std::erase_if(released_, [this](const Released& released) {
        if (released.frame > completed_frame_) return false;
        free_.push_back(released.layer);
        return true;
    });
}

bool HeightTexture::upload(std::uint32_t layer, std::span<const std::byte> texels, Staging& staging) {
    const auto staged = staging.allocate(texels.size());
    if (!staged) return false;
    std::memcpy(staged->bytes.data(), texels.data(), texels.size());
    texture_.upload({0, static_cast<int>(layer), {0, 0}, texture_.size_px()}, {GL_RED_INTEGER, GL_INT},
                    staging.buffer(), staged->offset_bytes);
    return true;
}

HeightTexture::Outcome HeightTexture::store(const pager::Upload& upload_of, Staging& staging) {
    const io::NodeId node = tiles_.id(upload_of.node);
    const bool root = node.level == 0;
    if (!root && free_.empty()) return {Stored::no_room};
    const std::uint32_t layer = root ? upload_of.node - tiles_.begin(TileKind::heights) : free_.back();
    if (!upload(layer, upload_of.texels, staging)) return {Stored::staging_full};
    if (!root) free_.pop_back();
    tile_of_slot_[layer] = upload_of.node;
    table_.insert(node, layer);
    return {Stored::yes, pager::GpuSlot{layer}};
}

// Frames up to the one before could sample it.
void HeightTexture::release(pager::GpuSlot slot) {
    const auto layer = static_cast<std::uint32_t>(slot);
    pager::NodeIndex& tile = tile_of_slot_[layer];
    table_.remove(tiles_.id(tile));
    tile = pager::kNoNode;
    if (frame_ - 1 <= completed_frame_)
        free_.push_back(layer);
    else
        released_.push_back({layer, frame_ - 1});
}

std::uint64_t HeightTexture::used_bytes() const {
    const auto used = static_cast<std::uint64_t>(shape_.layers()) - free_.size();
    return used * pager::heights_texels_bytes(shape_.quads) + shape_.table_bytes;
}

std::uint64_t HeightTexture::changed_bytes() const {
    std::uint64_t bytes = 0;
    for (const Rows& rows : changed_)
        bytes += aligned(static_cast<std::uint64_t>(rows.count * table_.columns()) * sizeof(std::uint32_t));
    return bytes;
}

void HeightTexture::fill_fades(const pager::Pager& pager) {
    for (std::size_t slot = 0; slot < fades_.size(); ++slot)
        fades_[slot] = tile_of_slot_[slot] == pager::kNoNode ? 0.0f : pager.fade(tile_of_slot_[slot]);
}

void HeightTexture::look_from(const DiscView& view, const pager::Pager& pager) {
    const io::Grid& grid = tiles_.grid(TileKind::heights);
    uniforms_ = disc_uniforms(grid, view);
    uniforms_.table = glm::ivec4(grid.finest(), table_.window_bits(), tile_bits(grid));
    table_.look_from(view.eye.cell);
    fill_fades(pager);
}

bool HeightTexture::prepare(const DiscView& view, const pager::Pager& pager, Staging& ring) {
    look_from(view, pager);
    table_.take_changes([this](int level, int first, int count) {
        changed_.push_back({level, first, count});
    });
    const std::uint64_t uniform_bytes = aligned(sizeof uniforms_),
                        fade_bytes = aligned(std::span(fades_).size_bytes());
    const std::uint64_t table_bytes = changed_bytes();
    auto room = ring.allocate(uniform_bytes + fade_bytes + table_bytes);
    if (!room) return false;  // changed_ stays for the next try
    std::memcpy(room->bytes.data(), &uniforms_, sizeof uniforms_);
    std::memcpy(room->bytes.data() + uniform_bytes, fades_.data(), std::span(fades_).size_bytes());
    prepared_ = {room->offset_bytes, room->offset_bytes + uniform_bytes};
    send_table(ring, {room->bytes.subspan(uniform_bytes + fade_bytes),
                      room->offset_bytes + uniform_bytes + fade_bytes});
    table_bytes_ += table_bytes;
    return true;
}

void HeightTexture::send_table(const Staging& ring, Staging::Allocation room) {
    const auto columns = static_cast<std::size_t>(table_.columns());
    std::uint64_t at = 0;
    for (const Rows& rows : changed_) {
        const auto entries = table_.entries(rows.level)
                                 .subspan(static_cast<std::size_t>(rows.first) * columns,
                                          static_cast<std::size_t>(rows.count) * columns);
        std::memcpy(room.bytes.data() + at, entries.data(), entries.size_bytes());
        table_texture_.upload({0, rows.level, {0, rows.first}, {table_.columns(), rows.count}},
                              {GL_RED_INTEGER, GL_UNSIGNED_INT}, ring.buffer(), room.offset_bytes + at);
        at += aligned(entries.size_bytes());
    }
    changed_.clear();
}

void HeightTexture::bind(const Staging& ring) const {
    ring.buffer().bind_range(GL_UNIFORM_BUFFER, shaders::kDiscUniformsBinding, prepared_.uniforms,
                             sizeof uniforms_);
    ring.buffer().bind_range(GL_SHADER_STORAGE_BUFFER, shaders::kHeightFadesBinding, prepared_.fades,
                             std::span(fades_).size_bytes());
    table_texture_.bind(shaders::kHeightTableUnit);
    sampler_.bind(shaders::kHeightTableUnit);
    texture_.bind(shaders::kHeightTilesUnit);
    sampler_.bind(shaders::kHeightTilesUnit);
}

}  // namespace ridgeline::render
