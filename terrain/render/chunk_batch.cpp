#include "ridgeline/render/chunk_batch.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "ridgeline/select/drawn_surface.h"

namespace ridgeline::render {
namespace {

constexpr GLuint kChunkBinding = 0;
constexpr GLuint kInstanceBinding = 1;
// Entries for which room is made at once; more make the vectors grow once.
constexpr std::size_t kUsualEntries = 1024;
// Where passes/terrain.frag and its like have it.
constexpr GLint kQuadsLocation = 0;

// Blocks must start where drivers can bind them.
std::uint64_t aligned(std::uint64_t at) {
    constexpr std::uint64_t kAlignment = gl::StagingRing::kAlignment;
    return (at + kAlignment - 1) / kAlignment * kAlignment;
}

template <class T>
std::uint64_t copy_to(const std::vector<T>& values, std::span<std::byte> bytes, std::uint64_t at) {
    std::memcpy(bytes.data() + at, values.data(), std::span(values).size_bytes());
    return at + std::span(values).size_bytes();
}

Result<gl::Program> chunk_program(const char* fragment_stage, const GpuSlotsShape& shape,
                                  std::vector<gl::ShaderDefine> defines) {
    auto program = gl::Program::create({{"passes/terrain.vert", fragment_stage}, std::move(defines)});
    if (!program) return program.error();
    program->set(kQuadsLocation, shape.quads);
    return program;
}

}  // namespace

std::size_t merge_ranges(std::span<io::IndexRange> ranges) {
    std::ranges::sort(ranges, {}, &io::IndexRange::first);
    std::size_t merged = 0;
    for (const io::IndexRange& range : ranges) {
        if (range.count == 0) continue;
        if (merged > 0 && ranges[merged - 1].first + ranges[merged - 1].count == range.first)
            ranges[merged - 1].count += range.count;
        else
            ranges[merged++] = range;
    }
    return merged;
}

Result<ChunkPrograms> chunk_programs(const char* fragment_stage, const GpuSlotsShape& shape,
                                     const std::vector<gl::ShaderDefine>& defines) {
    auto whole = chunk_program(fragment_stage, shape, defines);
    if (!whole) return whole.error();
    auto with_cut = defines;
    with_cut.push_back({"RIDGELINE_CUT", "1"});
    auto cut = chunk_program(fragment_stage, shape, std::move(with_cut));
    if (!cut) return cut.error();
    return ChunkPrograms{std::move(whole).value(), std::move(cut).value()};
}

ChunkBatch::ChunkBatch(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                       const GpuSlots& slots, std::size_t list_count)
    : info_(info), grid_(info.grid()), records_(records), lists_(list_count) {
    instances_.reserve(kUsualEntries);
    morphs_.reserve(kUsualEntries);
    found_.reserve(io::kQuarters * (1 + io::kSides));
    for (List& list : lists_) {
        list.whole.reserve(kUsualEntries * 8);
        list.cut.reserve(kUsualEntries * 8);
    }
    set_up_vertices(slots);
}

void ChunkBatch::set_up_vertices(const GpuSlots& slots) {
    using gl::AttributeKind;
    const std::array<gl::VertexAttribute, 4> attributes = {{
        {0, kChunkBinding, 4, GL_UNSIGNED_INT, AttributeKind::integer, 0},
        {1, kInstanceBinding, 4, GL_INT, AttributeKind::integer, 0},
        {2, kInstanceBinding, 4, GL_UNSIGNED_INT, AttributeKind::integer,
         offsetof(shaders::TerrainInstance, normals)},
        {3, kInstanceBinding, 2, GL_FLOAT, AttributeKind::floating,
         offsetof(shaders::TerrainInstance, last_column)},
    }};
    vertices_ = gl::VertexArray::create(attributes, "chunks");
    vertices_.set_vertex_buffer(kChunkBinding, slots.geometry(), 0, sizeof(io::ChunkVertex));
    vertices_.set_index_buffer(slots.geometry());
    vertices_.set_divisor(kInstanceBinding, 1);
}

void ChunkBatch::clear() {
    instances_.clear();
    morphs_.clear();
    for (List& list : lists_) {
        list.whole.clear();
        list.cut.clear();
    }
    counters_ = {};
}

bool ChunkBatch::is_cut(const select::DrawEntry& entry) const {
    const io::LatticePoint origin = grid_.origin(entry.node);
    const std::int64_t extent = grid_.extent(entry.node.level);
    return records_[entry.index].has_mask() || origin.x + extent > grid_.width() - 1 ||
           origin.y + extent > grid_.height() - 1;
}

shaders::TerrainInstance ChunkBatch::instance(const select::DrawEntry& entry,
                                              const ChunkPlaces& places) const {
    const int level = entry.node.level;
    const io::LatticePoint origin = grid_.origin(entry.node);
    const auto own = places.slots->place(places.pager->gpu_slot(entry.index));
    const auto parent = level == 0 ? own
                                   : places.slots->place(places.pager->gpu_slot(
                                         static_cast<pager::NodeIndex>(grid_.linear(entry.node.parent()))));
    const auto step = static_cast<float>(grid_.step(level));
    const glm::ivec2 place = places.from_eye(entry.origin);
    return {.origin_column = place.x,
            .origin_row = place.y,
            .step_shift = grid_.finest() - level,
            .first_morph = static_cast<std::int32_t>(morphs_.size()) * io::vertex_class::kCount,
            .normals = own.normals,
            .parent_normals = parent.normals,
            .mask_word = records_[entry.index].has_mask() ? own.mask_word : shaders::kNoMask,
            .quarter = static_cast<shaders::uint>(level == 0 ? 0 : entry.node.quarter()),
            .last_column = static_cast<float>(grid_.width() - 1 - origin.x) / step,
            .last_row = static_cast<float>(grid_.height() - 1 - origin.y) / step};
}

void ChunkBatch::find_commands(const select::DrawEntry& entry, const ChunkPlaces& places) {
    std::array<io::IndexRange, io::kQuarters*(1 + io::kSides)> ranges;
    std::size_t count = 0;
    const io::ChunkView chunk = places.pager->chunk(entry.index);
    for (int quarter = 0; quarter < io::kQuarters; ++quarter) {
        if ((entry.quarters >> quarter & 1) == 0) continue;
        for (const io::IndexRange& range : select::quarter_ranges(chunk.ranges(), entry, quarter))
            ranges[count++] = range;
    }
    const auto place = places.slots->place(places.pager->gpu_slot(entry.index));
    const auto indices_offset = chunk.layout().indices / sizeof(std::uint16_t);
    const std::uint32_t first_index = place.first_index + static_cast<std::uint32_t>(indices_offset);
    found_.clear();
    for (const io::IndexRange& range : std::span(ranges).first(merge_ranges(std::span(ranges).first(count))))
        found_.push_back({.index_count = range.count,
                          .first_index = first_index + range.first,
                          .base_vertex = static_cast<std::int32_t>(place.first_vertex),
                          .base_instance = static_cast<std::uint32_t>(instances_.size())});
}

// What is drawn stays where it is until the GPU has drawn it.
void ChunkBatch::use_slots(const select::DrawEntry& entry, const ChunkPlaces& places) const {
    places.slots->use(places.pager->gpu_slot(entry.index), places.frame);
    if (entry.node.level == 0) return;
    const auto parent = static_cast<pager::NodeIndex>(grid_.linear(entry.node.parent()));
    places.slots->use(places.pager->gpu_slot(parent), places.frame);
}

void ChunkBatch::append(const select::DrawEntry& entry, const ChunkPlaces& places, unsigned lists) {
    find_commands(entry, places);
    const bool cut = is_cut(entry);
    for (std::size_t l = 0; l < lists_.size(); ++l) {
        if ((lists >> l & 1u) == 0) continue;
        std::vector<DrawCommand>& commands = cut ? lists_[l].cut : lists_[l].whole;
        commands.insert(commands.end(), found_.begin(), found_.end());
        counters_.draws += static_cast<std::uint32_t>(found_.size());
        for (const DrawCommand& command : found_) counters_.triangles += command.index_count / 3;
    }
    instances_.push_back(instance(entry, places));
    morphs_.push_back(entry.morph);
    use_slots(entry, places);
}

bool ChunkBatch::upload(gl::StagingRing& ring) {
    const std::uint64_t instance_bytes = aligned(std::span(instances_).size_bytes());
    uploaded_.morph_bytes = std::span(morphs_).size_bytes();
    const std::uint64_t before_commands = instance_bytes + aligned(uploaded_.morph_bytes);
    const auto room = ring.allocate(before_commands + counters_.draws * sizeof(DrawCommand) + 1);
    if (!room) return false;
    uploaded_.instances = room->offset_bytes;
    uploaded_.morphs = room->offset_bytes + instance_bytes;
    copy_to(instances_, room->bytes, 0);
    copy_to(morphs_, room->bytes, instance_bytes);
    std::uint64_t at = before_commands;
    for (List& list : lists_) {
        list.offset_bytes = room->offset_bytes + at;
        at = copy_to(list.whole, room->bytes, at);
        at = copy_to(list.cut, room->bytes, at);
    }
    return true;
}

void ChunkBatch::bind(const GpuSlots& slots, const gl::StagingRing& ring) {
    if (instances_.empty()) return;
    vertices_.set_vertex_buffer(kInstanceBinding, ring.buffer(), uploaded_.instances,
                                sizeof(shaders::TerrainInstance));
    vertices_.bind();
    ring.buffer().bind(GL_DRAW_INDIRECT_BUFFER);
    ring.buffer().bind_range(GL_SHADER_STORAGE_BUFFER, shaders::kMorphTableBinding, uploaded_.morphs,
                             uploaded_.morph_bytes);
    slots.masks().bind_base(GL_SHADER_STORAGE_BUFFER, shaders::kChunkWordsBinding);
}

void ChunkBatch::draw(std::size_t list, const ChunkPrograms& programs) const {
    const List& drawn = lists_[list];
    multi_draw(programs.whole, drawn.offset_bytes, drawn.whole.size());
    multi_draw(programs.cut, drawn.offset_bytes + std::span(drawn.whole).size_bytes(), drawn.cut.size());
}

void ChunkBatch::multi_draw(const gl::Program& program, std::uint64_t offset_bytes, std::size_t count) const {
    if (count == 0) return;
    program.use();
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_SHORT, reinterpret_cast<const void*>(offset_bytes),
                                static_cast<GLsizei>(count), sizeof(DrawCommand));
}

}  // namespace ridgeline::render
