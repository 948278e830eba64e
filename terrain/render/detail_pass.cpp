#include "ridgeline/render/detail_pass.h"

#include <utility>

#include "ridgeline/pager/heights_texels.h"
#include "ridgeline/shaders/shared/detail_octave.h"
#include "ridgeline/shaders/shared/disc_uniforms.h"

namespace ridgeline::render {
namespace {

// Where passes/detail.comp has them.
constexpr GLint kCornerAndFirstLocation = 0;
constexpr GLint kSlotsSideOctaveLocation = 1;
constexpr GLint kGainsLocation = 2;
constexpr GLint kShiftAndSourceLocation = 3;

}  // namespace

Result<DetailPass> DetailPass::create(detail::FinerGround ground, int quads) {
    DetailPass pass(std::move(ground), quads);
    auto program = gl::Program::create({{"passes/detail.comp"}, {}});
    if (!program) return program.error();
    pass.program_ = std::move(program).value();
    pass.sampler_ = gl::Sampler::create({.min_filter = GL_NEAREST, .mag_filter = GL_NEAREST});
    return pass;
}

void DetailPass::make(const gl::Texture2DArray& tiles, const DetailWork& work) const {
    const io::NodeId parent = work.node.parent();
    const int quarter = work.node.quarter(), side = pager::heights_texels_side(quads_);
    const io::DetailGains& gains = ground_.gains[static_cast<std::size_t>(work.octave - 1)];
    program_.use();
    program_.set(kCornerAndFirstLocation, glm::ivec4((quarter & 1) * quads_, (quarter >> 1) * quads_,
                                                     parent.x * quads_, parent.y * quads_));
    program_.set(kSlotsSideOctaveLocation, glm::ivec4(static_cast<int>(work.parent_slot),
                                                      static_cast<int>(work.slot), side, work.octave));
    program_.set(kGainsLocation,
                 glm::ivec4(gains.face_slope, gains.face_roughness, gains.edge_slope, gains.edge_roughness));
    program_.set(kShiftAndSourceLocation, glm::ivec2(ground_.shift, work.octave == 1 ? 1 : 0));
    tiles.bind(shaders::kHeightTilesUnit);
    sampler_.bind(shaders::kHeightTilesUnit);
    tiles.bind_image(shaders::kMadeTilesImage, 0, GL_WRITE_ONLY);
    glDispatchCompute(static_cast<GLuint>((side * side + shaders::kDetailGroup - 1) / shaders::kDetailGroup),
                      1, 1);
}

void DetailPass::finish() const {
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                    GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

}  // namespace ridgeline::render
