#include "ridgeline/render/virtual_texture.h"

#include <cstring>

namespace ridgeline::render {
namespace {

using Staging = gl::StagingRing;

std::uint64_t aligned(std::uint64_t bytes) {
    return (bytes + Staging::kAlignment - 1) / Staging::kAlignment * Staging::kAlignment;
}

}  // namespace

Result<VirtualTexture> VirtualTexture::create(const pager::TileSpace& tiles,
                                              const VirtualTextureOptions& options) {
    VirtualTexture made(tiles, options);
    RIDGELINE_TRY(made.create_textures());
    return made;
}

VirtualTexture::VirtualTexture(const pager::TileSpace& tiles, const VirtualTextureOptions& options)
    : tiles_(tiles),
      kind_(options.kind),
      grid_(options.grid),
      shape_(options.shape),
      texels_(options.texels),
      bindings_(options.bindings),
      slots_(options.shape),
      table_(options.grid, static_cast<std::size_t>(options.shape.layers()), options.tile_bits) {
    const auto layers = static_cast<std::size_t>(shape_.layers());
    tile_of_slot_.assign(layers, pager::kNoNode);
    fades_.assign(layers, 0.0f);
    changed_.reserve(static_cast<std::size_t>(grid_.levels() * table_.rows()));
}

Result<void> VirtualTexture::create_textures() {
    auto texture = gl::Texture2DArray::create({.format = texels_.format,
                                               .size_px = glm::ivec2(texels_.mips.front().side_px),
                                               .levels = static_cast<int>(texels_.mips.size()),
                                               .layers = shape_.layers(),
                                               .label = texels_.label});
    if (!texture) return texture.error();
    auto table = gl::Texture2DArray::create({.format = GL_R32UI,
                                             .size_px = {table_.columns(), table_.rows()},
                                             .layers = grid_.levels(),
                                             .label = "page table of " + texels_.label});
    if (!table) return table.error();
    texture_ = std::move(texture).value();
    table_texture_ = std::move(table).value();
    table_sampler_ = gl::Sampler::create({.min_filter = GL_NEAREST, .mag_filter = GL_NEAREST});
    return {};
}

void VirtualTexture::begin_frame(std::uint32_t frame, std::uint32_t completed_frame) {
    frame_ = frame;
    slots_.begin_frame(completed_frame);
}

bool VirtualTexture::upload(std::uint32_t layer, std::span<const std::byte> texels, Staging& staging) {
    const auto staged = staging.allocate(texels.size());
    if (!staged) return false;
    std::memcpy(staged->bytes.data(), texels.data(), texels.size());
    for (std::size_t level = 0; level < texels_.mips.size(); ++level) {
        const TileTexels::Mip& mip = texels_.mips[level];
        texture_.upload(
            {static_cast<int>(level), static_cast<int>(layer), glm::ivec2(0), glm::ivec2(mip.side_px)},
            texels_.layout, staging.buffer(), staged->offset_bytes + mip.offset_bytes);
    }
    return true;
}

VirtualTexture::Outcome VirtualTexture::store(const pager::Upload& upload_of, Staging& staging) {
    const io::NodeId node = tiles_.id(upload_of.node);
    const bool root = node.level == 0;
    if (!root && slots_.full()) return {Stored::no_room};
    const std::uint32_t layer = root ? upload_of.node - tiles_.begin(kind_) : slots_.next();
    if (!upload(layer, upload_of.texels, staging)) return {Stored::staging_full};
    if (!root) slots_.take();
    tile_of_slot_[layer] = upload_of.node;
    table_.insert(node, layer);
    return {Stored::yes, pager::GpuSlot{layer}};
}

// Frames up to the one before could sample it.
void VirtualTexture::release(pager::GpuSlot slot) {
    const auto layer = static_cast<std::uint32_t>(slot);
    pager::NodeIndex& tile = tile_of_slot_[layer];
    table_.remove(tiles_.id(tile));
    tile = pager::kNoNode;
    slots_.release(layer, frame_ - 1);
}

std::optional<std::uint32_t> VirtualTexture::claim(io::NodeId made) {
    if (slots_.full()) return {};
    const std::uint32_t slot = slots_.take();
    fades_[slot] = 0.0f;
    table_.insert(made, slot);
    return slot;
}

void VirtualTexture::release_made(io::NodeId made, std::uint32_t slot) {
    table_.remove(made);
    slots_.release(slot, frame_ - 1);
}

std::uint64_t VirtualTexture::used_bytes() const {
    return static_cast<std::uint64_t>(shape_.layers() - slots_.free_count()) * shape_.tile_bytes +
           shape_.table_bytes;
}

void VirtualTexture::look_from(const glm::ivec2& cell, const pager::Pager& pager) {
    table_.look_from(cell);
    for (std::size_t slot = 0; slot < fades_.size(); ++slot)
        if (tile_of_slot_[slot] != pager::kNoNode) fades_[slot] = pager.fade(tile_of_slot_[slot]);
}

std::uint64_t VirtualTexture::changed_bytes() const {
    std::uint64_t bytes = 0;
    for (const Rows& rows : changed_)
        bytes += aligned(static_cast<std::uint64_t>(rows.count * table_.columns()) * sizeof(std::uint32_t));
    return bytes;
}

bool VirtualTexture::send(std::span<const std::byte> uniforms, Staging& ring) {
    table_.take_changes([this](int level, int first, int count) {
        changed_.push_back({level, first, count});
    });
    const auto fades = std::as_bytes(std::span(fades_));
    const std::uint64_t fades_at = aligned(uniforms.size()), table_at = fades_at + aligned(fades.size());
    const std::uint64_t table_bytes = changed_bytes();
    auto room = ring.allocate(table_at + table_bytes);
    if (!room) return false;  // changed_ stays for the next try
    std::memcpy(room->bytes.data(), uniforms.data(), uniforms.size());
    std::memcpy(room->bytes.data() + fades_at, fades.data(), fades.size());
    sent_ = {room->offset_bytes, uniforms.size(), room->offset_bytes + fades_at};
    send_table(ring, {room->bytes.subspan(table_at), room->offset_bytes + table_at});
    table_bytes_ += table_bytes;
    return true;
}

void VirtualTexture::send_table(const Staging& ring, Staging::Allocation room) {
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

void VirtualTexture::bind(const Staging& ring, const gl::Sampler& tile_sampler) const {
    ring.buffer().bind_range(GL_UNIFORM_BUFFER, bindings_.uniforms, sent_.uniforms, sent_.uniform_bytes);
    ring.buffer().bind_range(GL_SHADER_STORAGE_BUFFER, bindings_.fades, sent_.fades,
                             std::span(fades_).size_bytes());
    table_texture_.bind(bindings_.table);
    table_sampler_.bind(bindings_.table);
    texture_.bind(bindings_.tiles);
    tile_sampler.bind(bindings_.tiles);
}

}  // namespace ridgeline::render
