#include "ridgeline/render/mesh_surface.h"

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
// Where passes/terrain.frag has it.
constexpr GLint kQuadsLocation = 0;

template <class T>
std::uint64_t copy_to(std::span<const T> values, std::span<std::byte> bytes, std::uint64_t at) {
    std::memcpy(bytes.data() + at, values.data(), values.size_bytes());
    // Blocks must start where drivers can bind them.
    constexpr std::uint64_t kAlignment = gl::StagingRing::kAlignment;
    return (at + values.size_bytes() + kAlignment - 1) / kAlignment * kAlignment;
}

Result<gl::Program> terrain_program(const GpuSlotsShape& shape, std::vector<gl::ShaderDefine> defines) {
    auto program = gl::Program::create({{"passes/terrain.vert", "passes/terrain.frag"}, std::move(defines)});
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

Result<MeshSurface> MeshSurface::create(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                                        const GpuSlots& slots) {
    MeshSurface surface(info, records);
    auto whole = terrain_program(slots.shape(), {});
    if (!whole) return whole.error();
    auto cut = terrain_program(slots.shape(), {{"RIDGELINE_CUT", "1"}});
    if (!cut) return cut.error();
    surface.whole_program_ = std::move(whole).value();
    surface.cut_program_ = std::move(cut).value();
    surface.set_up_vertices(slots);
    return surface;
}

MeshSurface::MeshSurface(const io::TerrainInfo& info, std::span<const io::NodeRecord> records)
    : info_(info), grid_(info.grid()), records_(records) {
    instances_.reserve(kUsualEntries);
    morphs_.reserve(kUsualEntries);
    whole_.reserve(kUsualEntries * 8);
    cut_.reserve(kUsualEntries * 8);
}

void MeshSurface::set_up_vertices(const GpuSlots& slots) {
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

bool MeshSurface::is_cut(const select::DrawEntry& entry) const {
    const io::LatticePoint origin = grid_.origin(entry.node);
    const std::int64_t extent = grid_.extent(entry.node.level);
    return records_[entry.index].has_mask() || origin.x + extent > grid_.width() - 1 ||
           origin.y + extent > grid_.height() - 1;
}

shaders::TerrainInstance MeshSurface::instance(const select::DrawEntry& entry, const Scene& scene) const {
    const int level = entry.node.level;
    const io::LatticePoint origin = grid_.origin(entry.node);
    const auto own = scene.slots->place(scene.pager->gpu_slot(entry.index));
    const auto parent = level == 0 ? own
                                   : scene.slots->place(scene.pager->gpu_slot(
                                         static_cast<pager::NodeIndex>(grid_.linear(entry.node.parent()))));
    const auto step = static_cast<float>(grid_.step(level));
    return {.origin_column = entry.origin.x,
            .origin_row = entry.origin.y,
            .step_shift = grid_.finest() - level,
            .first_morph = static_cast<std::int32_t>(morphs_.size()) * io::vertex_class::kCount,
            .normals = own.normals,
            .parent_normals = parent.normals,
            .mask_word = records_[entry.index].has_mask() ? own.mask_word : shaders::kNoMask,
            .quarter = static_cast<shaders::uint>(level == 0 ? 0 : entry.node.quarter()),
            .last_column = static_cast<float>(grid_.width() - 1 - origin.x) / step,
            .last_row = static_cast<float>(grid_.height() - 1 - origin.y) / step};
}

void MeshSurface::append_commands(const select::DrawEntry& entry, const Scene& scene,
                                  std::vector<DrawCommand>& commands) {
    std::array<io::IndexRange, io::kQuarters*(1 + io::kSides)> ranges;
    std::size_t count = 0;
    const io::ChunkView chunk = scene.pager->chunk(entry.index);
    for (int quarter = 0; quarter < io::kQuarters; ++quarter) {
        if ((entry.quarters >> quarter & 1) == 0) continue;
        for (const io::IndexRange& range : select::quarter_ranges(chunk.ranges(), entry, quarter))
            ranges[count++] = range;
    }
    const auto place = scene.slots->place(scene.pager->gpu_slot(entry.index));
    const auto indices_offset = chunk.layout().indices / sizeof(std::uint16_t);
    const std::uint32_t first_index = place.first_index + static_cast<std::uint32_t>(indices_offset);
    for (const io::IndexRange& range :
         std::span(ranges).first(merge_ranges(std::span(ranges).first(count)))) {
        commands.push_back({.index_count = range.count,
                            .first_index = first_index + range.first,
                            .base_vertex = static_cast<std::int32_t>(place.first_vertex),
                            .base_instance = static_cast<std::uint32_t>(instances_.size())});
        counters_.triangles += range.count / 3;
    }
}

void MeshSurface::append(const select::DrawEntry& entry, const Scene& scene) {
    append_commands(entry, scene, is_cut(entry) ? cut_ : whole_);
    instances_.push_back(instance(entry, scene));
    morphs_.push_back(entry.morph);
    scene.slots->use(scene.pager->gpu_slot(entry.index), scene.frame);
    if (entry.node.level > 0)
        scene.slots->use(
            scene.pager->gpu_slot(static_cast<pager::NodeIndex>(grid_.linear(entry.node.parent()))),
            scene.frame);
}

bool MeshSurface::prepare(const Scene& scene, gl::StagingRing& ring) {
    instances_.clear();
    morphs_.clear();
    whole_.clear();
    cut_.clear();
    counters_ = {};
    for (const select::DrawEntry& entry : scene.selection->draws) append(entry, scene);
    counters_.draws = static_cast<std::uint32_t>(whole_.size() + cut_.size());
    return upload(ring);
}

bool MeshSurface::upload(gl::StagingRing& ring) {
    const std::uint64_t size_bytes = std::span(instances_).size_bytes() + std::span(morphs_).size_bytes() +
                                     counters_.draws * sizeof(DrawCommand) + 3 * gl::StagingRing::kAlignment;
    const auto room = ring.allocate(size_bytes);
    if (!room) return false;
    std::uint64_t at = 0;
    prepared_.instances = room->offset_bytes + at;
    at = copy_to(std::span<const shaders::TerrainInstance>(instances_), room->bytes, at);
    prepared_.morphs = room->offset_bytes + at;
    prepared_.morph_bytes = std::span(morphs_).size_bytes();
    at = copy_to(std::span<const select::MorphTable>(morphs_), room->bytes, at);
    prepared_.commands = room->offset_bytes + at;
    // Both lists without a gap: the second multi-draw starts where the first ends.
    std::memcpy(room->bytes.data() + at, whole_.data(), std::span(whole_).size_bytes());
    at += std::span(whole_).size_bytes();
    std::memcpy(room->bytes.data() + at, cut_.data(), std::span(cut_).size_bytes());
    return true;
}

void MeshSurface::draw(const GpuSlots& slots, const gl::StagingRing& ring) {
    if (counters_.draws == 0) return;
    vertices_.set_vertex_buffer(kInstanceBinding, ring.buffer(), prepared_.instances,
                                sizeof(shaders::TerrainInstance));
    vertices_.bind();
    ring.buffer().bind(GL_DRAW_INDIRECT_BUFFER);
    ring.buffer().bind_range(GL_SHADER_STORAGE_BUFFER, shaders::kMorphTableBinding, prepared_.morphs,
                             prepared_.morph_bytes);
    slots.masks().bind_base(GL_SHADER_STORAGE_BUFFER, shaders::kChunkWordsBinding);
    multi_draw(whole_program_, prepared_.commands, whole_.size());
    multi_draw(cut_program_, prepared_.commands + std::span(whole_).size_bytes(), cut_.size());
}

void MeshSurface::multi_draw(const gl::Program& program, std::uint64_t offset_bytes,
                             std::size_t count) const {
    if (count == 0) return;
    program.use();
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_SHORT, reinterpret_cast<const void*>(offset_bytes),
                                static_cast<GLsizei>(count), sizeof(DrawCommand));
}

}  // namespace ridgeline::render
