#include "ridgeline/render/shadow_maps.h"

#include <cstring>
#include <string>
#include <utility>

#include "ridgeline/gl/debug_output.h"

namespace ridgeline::render {
namespace {

// Where passes/terrain.vert has it.
constexpr GLint kCascadeLocation = 1;
constexpr std::uint64_t kTexelBytes = 4;

}  // namespace

Result<ShadowMaps> ShadowMaps::create(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                                      const GpuSlots& slots, int map_px) {
    auto programs = chunk_programs("passes/shadow_map.frag", slots.shape(), {{"RIDGELINE_SHADOW_MAP", "1"}});
    if (!programs) return programs.error();
    ShadowMaps maps(ChunkBatch(info, records, slots, kCount), std::move(programs).value(), map_px);
    RIDGELINE_TRY(maps.create_maps());
    return maps;
}

ShadowMaps::ShadowMaps(ChunkBatch batch, ChunkPrograms programs, int map_px)
    : map_px_(map_px), programs_(std::move(programs)), batch_(std::move(batch)) {}

Result<void> ShadowMaps::create_maps() {
    auto maps = gl::Texture2DArray::create({.format = GL_DEPTH_COMPONENT32F,
                                            .size_px = glm::ivec2(map_px_),
                                            .layers = static_cast<int>(kCount),
                                            .label = "shadow maps"});
    if (!maps) return maps.error();
    maps_ = std::move(maps).value();
    for (std::size_t i = 0; i < kCount; ++i) {
        auto framebuffer =
            gl::Framebuffer::create_layer(maps_, static_cast<int>(i), "shadow map " + std::to_string(i));
        if (!framebuffer) return framebuffer.error();
        framebuffers_[i] = std::move(framebuffer).value();
    }
    sampler_ = gl::Sampler::create({.compare_function = GL_GEQUAL});
    return {};
}

std::uint64_t ShadowMaps::bytes() const {
    const auto side = static_cast<std::uint64_t>(map_px_);
    return side * side * kCount * kTexelBytes;
}

bool ShadowMaps::prepare(const ShadowCascades& cascades, std::span<const select::ShadowCaster> casters,
                         const ChunkPlaces& places, gl::StagingRing& ring) {
    batch_.clear();
    for (const select::ShadowCaster& caster : casters) {
        unsigned lists = 0;
        for (std::size_t i = 0; i < kCount; ++i)
            if (cascades.holds(i, caster.bounds_m)) lists |= 1u << i;
        if (lists != 0) batch_.append(caster.entry, places, lists);
    }
    const shaders::ShadowUniforms uniforms = shadow_uniforms(cascades, map_px_);
    const auto room = ring.allocate(sizeof uniforms);
    if (!room || !batch_.upload(ring)) return false;
    std::memcpy(room->bytes.data(), &uniforms, sizeof uniforms);
    uniforms_offset_ = room->offset_bytes;
    return true;
}

void ShadowMaps::draw(const GpuSlots& slots, const gl::StagingRing& ring) {
    const gl::DebugGroup group("shadow maps");
    bind(ring);
    batch_.bind(slots, ring);
    // The sun also sees the ground from below, through holes and past the terrain's border.
    glDisable(GL_CULL_FACE);
    for (std::size_t i = 0; i < kCount; ++i) {
        framebuffers_[i].bind();
        constexpr float kFarthest = 0.0f;
        glClearNamedFramebufferfv(framebuffers_[i].id(), GL_DEPTH, 0, &kFarthest);
        programs_.whole.set(kCascadeLocation, static_cast<int>(i));
        programs_.cut.set(kCascadeLocation, static_cast<int>(i));
        batch_.draw(i, programs_);
    }
    glEnable(GL_CULL_FACE);
}

void ShadowMaps::bind(const gl::StagingRing& ring) const {
    ring.buffer().bind_range(GL_UNIFORM_BUFFER, shaders::kShadowUniformsBinding, uniforms_offset_,
                             sizeof(shaders::ShadowUniforms));
    maps_.bind(shaders::kShadowMapUnit);
    sampler_.bind(shaders::kShadowMapUnit);
}

}  // namespace ridgeline::render
