#include "ridgeline/app/bench/cpu_lod.h"

#include <bit>

#include "ridgeline/io/imagery_tile.h"

namespace ridgeline::app {
namespace {

// Written round and round, as drivers do it with a buffer that is filled anew in every frame.
constexpr std::uint64_t kGeometryBytes = 64_MiB;
constexpr GLenum kFormat = GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;

std::span<const std::byte> drawn_share(std::span<const std::byte> bytes, int quarters) {
    return bytes.first(bytes.size() * static_cast<std::size_t>(quarters) / io::kQuarters);
}

}  // namespace

Result<CpuLod> CpuLod::create() {
    CpuLod sender;
    auto geometry = gl::Buffer::create({kGeometryBytes, gl::BufferUse::update, "CPU LOD"});
    if (!geometry) return geometry.error();
    sender.geometry_ = std::move(*geometry);
    auto texture = gl::Texture2D::create(
        {.format = kFormat, .size_px = glm::ivec2(io::kImageryTexels), .levels = 2, .label = "CPU LOD"});
    if (!texture) return texture.error();
    sender.texture_ = std::move(*texture);
    sender.tile_.resize(io::kImageryTileBytes);
    return sender;
}

SentBytes CpuLod::send(const TerrainStage& stage) {
    SentBytes sent;
    for (const select::DrawEntry& entry : stage.selection().draws) sent.heights += send_chunk(stage, entry);
    if (stage.schedule() == nullptr) return sent;
    for (std::size_t i = 0; i < stage.schedule()->tiles.size(); ++i) send_tile();
    sent.imagery = static_cast<std::int64_t>(stage.schedule()->tiles.size() * io::kImageryTileBytes);
    return sent;
}

std::int64_t CpuLod::send_chunk(const TerrainStage& stage, const select::DrawEntry& entry) {
    const io::ChunkView chunk = stage.pager().chunk(entry.index);
    if (!chunk) return 0;
    const int quarters = std::popcount(entry.quarters);
    const auto geometry = drawn_share(chunk.geometry(), quarters);
    const auto normals = drawn_share(std::as_bytes(chunk.normals()), quarters);
    write(geometry);
    write(normals);
    return static_cast<std::int64_t>(geometry.size() + normals.size());
}

void CpuLod::write(std::span<const std::byte> bytes) {
    if (written_ + bytes.size() > geometry_.size_bytes()) written_ = 0;
    geometry_.write(written_, bytes);
    written_ += bytes.size();
}

void CpuLod::send_tile() {
    const std::span<const std::byte> tile(tile_);
    texture_.upload({.size_px = glm::ivec2(io::kImageryTexels)}, {kFormat},
                    tile.first(io::kImageryMipOffset));
    texture_.upload({.level = 1, .size_px = glm::ivec2(io::kImageryMipTexels)}, {kFormat},
                    tile.subspan(io::kImageryMipOffset));
}

}  // namespace ridgeline::app
