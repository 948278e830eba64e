#include "ridgeline/render/virtual_texture.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace ridgeline::render {
namespace {

using Staging = gl::StagingRing;

// How many times longer than wide a pixel's print may be before the picture blurs. The shader's lookups stay
// within the gutter; a sampler's past it meet the tile's edge again.
constexpr float longest_print(PrintFilter filter) { return filter == PrintFilter::sampler ? 8.0f : 4.0f; }
// Half as many as the longest print has round parts: where the CPU draws, each costs a twentieth of the frame.
constexpr float kShaderTaps = 2.0f;
// How many times wider than a pixel that faces the ground its print's round parts get at most: beyond it, ground
// seen on edge shows the colours of what is far around.
constexpr double kMostPrint = 32.0;

std::uint64_t aligned(std::uint64_t bytes) {
    return (bytes + Staging::kAlignment - 1) / Staging::kAlignment * Staging::kAlignment;
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

Result<VirtualTexture> VirtualTexture::create(const io::ImageryInfo& info, const pager::TileSource& source,
                                              const VirtualTextureOptions& options) {
    const auto shape = plan_imagery_slots(source, options.slots);
    if (!shape) return shape.error();
    auto slots = ImagerySlots::create(*shape);
    if (!slots) return slots.error();
    VirtualTexture made(info, source, std::move(slots).value());
    const PageTable& table = made.table_;
    auto texture = gl::Texture2DArray::create({.format = GL_R32UI,
                                               .size_px = {table.columns(), table.rows()},
                                               .layers = source.imagery.grid.levels(),
                                               .label = "page table"});
    if (!texture) return texture.error();
    made.table_texture_ = std::move(texture).value();
    made.print_filter_ = options.print_filter;
    const float anisotropy =
        options.print_filter == PrintFilter::sampler ? longest_print(PrintFilter::sampler) : 1.0f;
    made.sampler_ =
        gl::Sampler::create({.min_filter = GL_LINEAR_MIPMAP_LINEAR, .max_anisotropy = anisotropy});
    made.table_sampler_ = gl::Sampler::create({.min_filter = GL_NEAREST, .mag_filter = GL_NEAREST});
    return made;
}

VirtualTexture::VirtualTexture(const io::ImageryInfo& info, const pager::TileSource& source,
                               ImagerySlots slots)
    : info_(info), tiles_(source.tiles()), slots_(std::move(slots)), table_(source.imagery.grid) {
    const auto layers = static_cast<std::size_t>(slots_.shape().layers());
    tile_of_slot_.assign(layers, pager::kNoNode);
    fades_.assign(layers, 0.0f);
    changed_.reserve(static_cast<std::size_t>(source.imagery.grid.levels() * table_.rows()));
}

void VirtualTexture::begin_frame(std::uint32_t frame, std::uint32_t completed_frame) {
    frame_ = frame;
    slots_.begin_frame(completed_frame);
}

ImagerySlots::Outcome VirtualTexture::store(const pager::Upload& upload, gl::StagingRing& staging) {
    const io::NodeId node = tiles_.id(upload.node);
    const auto root = static_cast<int>(upload.node - tiles_.begin(pager::TileKind::imagery));
    const auto outcome = node.level == 0 ? slots_.store_root(root, upload.texels, staging)
                                         : slots_.store(upload.texels, staging);
    if (outcome.stored != ImagerySlots::Stored::yes) return outcome;
    tile_of_slot_[static_cast<std::size_t>(outcome.slot)] = upload.node;
    table_.insert(node, static_cast<std::uint32_t>(outcome.slot));
    return outcome;
}

// Frames up to the one before could sample it.
void VirtualTexture::release(pager::GpuSlot slot) {
    pager::NodeIndex& tile = tile_of_slot_[static_cast<std::size_t>(slot)];
    table_.remove(tiles_.id(tile));
    tile = pager::kNoNode;
    slots_.release(slot, frame_ - 1);
}

std::uint64_t VirtualTexture::changed_bytes() {
    std::uint64_t bytes = 0;
    for (const Rows& rows : changed_)
        bytes += aligned(static_cast<std::uint64_t>(rows.count * table_.columns()) * sizeof(std::uint32_t));
    return bytes;
}

void VirtualTexture::fill_fades(const pager::Pager& pager) {
    for (std::size_t slot = 0; slot < fades_.size(); ++slot)
        fades_[slot] = tile_of_slot_[slot] == pager::kNoNode ? 0.0f : pager.fade(tile_of_slot_[slot]);
}

void VirtualTexture::fill_uniforms(const platform::Camera& camera) {
    uniforms_ = imagery_uniforms(info_, glm::dvec2(camera.pose.eye_m));
    uniforms_.table = glm::ivec4(tiles_.grid(pager::TileKind::imagery).finest(), table_.window_bits(), 0);
    const double texels_per_m = 1.0 / std::min(info_.spacing_x_m, info_.spacing_y_m);
    uniforms_.filtering =
        glm::vec4(longest_print(print_filter_), print_filter_ == PrintFilter::shader ? kShaderTaps : 1.0f,
                  kMostPrint * texels_per_m / platform::pixels_per_tangent(camera.lens), 0.0);
}

bool VirtualTexture::prepare(const platform::Camera& camera, const pager::Pager& pager, Staging& ring) {
    fill_uniforms(camera);
    table_.look_from(glm::ivec2(uniforms_.eye_cell_and_size));
    table_.take_changes([this](int level, int first, int count) {
        changed_.push_back({level, first, count});
    });
    fill_fades(pager);

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

void VirtualTexture::bind(const Staging& ring) const {
    ring.buffer().bind_range(GL_UNIFORM_BUFFER, shaders::kImageryUniformsBinding, prepared_.uniforms,
                             sizeof uniforms_);
    ring.buffer().bind_range(GL_SHADER_STORAGE_BUFFER, shaders::kImageryFadesBinding, prepared_.fades,
                             std::span(fades_).size_bytes());
    table_texture_.bind(shaders::kPageTableUnit);
    table_sampler_.bind(shaders::kPageTableUnit);
    slots_.texture().bind(shaders::kImageryUnit);
    sampler_.bind(shaders::kImageryUnit);
}

}  // namespace ridgeline::render
