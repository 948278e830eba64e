#include "ridgeline/io/chunk.h"

#include "ridgeline/base/contract.h"

namespace ridgeline::io {
namespace {

constexpr std::size_t round_up(std::size_t bytes) { return (bytes + 15) & ~std::size_t{15}; }

template <class T>
std::span<T> part(std::span<std::byte> block, std::size_t offset, std::size_t count) {
    return {reinterpret_cast<T*>(block.data() + offset), count};
}

std::size_t mask_words(const NodeRecord& record, int quads) {
    const auto side = static_cast<std::size_t>(quads);
    return record.has_mask() ? side * side / 32 : 0;
}

std::size_t normal_count(int quads) {
    const auto side = static_cast<std::size_t>(quads) + 1;
    return side * side;
}

}  // namespace

ChunkLayout chunk_layout(const NodeRecord& record, const ChunkShape& shape) {
    ChunkLayout layout;
    layout.indices = record.vertex_count * sizeof(ChunkVertex);
    layout.mask = layout.indices + round_up(record.index_count * sizeof(std::uint16_t));
    layout.geometry = layout.mask + round_up(mask_words(record, shape.quads) * sizeof(std::uint32_t));
    layout.normals = layout.geometry;
    layout.ranges = layout.normals + round_up(normal_count(shape.quads) * sizeof(NormalTexel));
    layout.relief = layout.ranges + round_up(sizeof(ChunkRanges));
    layout.total = layout.relief + round_up(shape.relief.bytes());
    return layout;
}

ChunkView::ChunkView(std::span<std::byte> block, const NodeRecord& record, const ChunkShape& shape)
    : block_(block),
      layout_(chunk_layout(record, shape)),
      relief_shape_(shape.relief),
      vertex_count_(record.vertex_count),
      index_count_(record.index_count),
      mask_words_(static_cast<std::uint32_t>(mask_words(record, shape.quads))),
      normal_count_(static_cast<std::uint32_t>(normal_count(shape.quads))) {
    RIDGELINE_CHECK(block.size() >= layout_.total);
    RIDGELINE_CHECK(reinterpret_cast<std::uintptr_t>(block.data()) % alignof(ChunkVertex) == 0);
}

std::span<ChunkVertex> ChunkView::vertices() const {
    return part<ChunkVertex>(block_, layout_.vertices, vertex_count_);
}
std::span<std::uint16_t> ChunkView::indices() const {
    return part<std::uint16_t>(block_, layout_.indices, index_count_);
}
std::span<std::uint32_t> ChunkView::mask() const {
    return part<std::uint32_t>(block_, layout_.mask, mask_words_);
}
std::span<NormalTexel> ChunkView::normals() const {
    return part<NormalTexel>(block_, layout_.normals, normal_count_);
}
ReliefView ChunkView::relief() const {
    return {block_.subspan(layout_.relief, relief_shape_.bytes()), relief_shape_};
}
ChunkRanges& ChunkView::ranges() const { return *part<ChunkRanges>(block_, layout_.ranges, 1).data(); }

}  // namespace ridgeline::io
