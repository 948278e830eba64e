// The colours that this GPU shows of BC1 blocks, texel by texel, unfiltered.
//
// The format says how two endpoints are mixed; GPUs mix more coarsely, each in its way. A picture is held
// against what its own GPU makes of a texel, and that against the format.
#pragma once

#include <doctest/doctest.h>

#include <cstring>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "ridgeline/gl/buffer.h"
#include "ridgeline/gl/program.h"
#include "ridgeline/gl/texture.h"
#include "ridgeline/io/imagery_tile.h"

namespace ridgeline::test {

class ShownBlocks {
  public:
    ShownBlocks() {
        auto program = gl::Program::create({.stages = {"shown.comp"}},
                                           [](std::string_view) -> std::optional<std::string_view> {
                                               return R"(#version 450 core
layout(local_size_x = 4, local_size_y = 4) in;
layout(binding = 0) uniform sampler2D blocks;
layout(std430, binding = 0) writeonly buffer Out { vec4 texels[]; };
void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    texels[at.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + at.x] = texelFetch(blocks, ivec2(at), 0);
}
)";
                                           });
        REQUIRE_MESSAGE(program.ok(), (program ? "" : program.error().message));
        program_ = std::move(program).value();
    }

    // blocks: a square of side² of them, row by row. Gives 4 side × 4 side texels, row by row, of linear
    // light.
    std::vector<glm::dvec3> linear(std::span<const io::Bc1Block> blocks, int side) const {
        const glm::ivec2 size_px(4 * side);
        const auto count = static_cast<std::size_t>(size_px.x * size_px.y);
        auto texture = gl::Texture2D::create(
            {.format = GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT, .size_px = size_px, .label = "blocks"});
        const auto shown = gl::Buffer::create({.size_bytes = count * sizeof(glm::vec4),
                                               .use = gl::BufferUse::readback,
                                               .label = "shown blocks"});
        REQUIRE((texture && shown));
        texture->upload({.size_px = size_px}, {.format = GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT},
                        std::as_bytes(blocks));
        texture->bind(0);
        glBindSampler(0, 0);
        shown->bind_base(GL_SHADER_STORAGE_BUFFER, 0);
        program_.use();
        glDispatchCompute(static_cast<GLuint>(side), static_cast<GLuint>(side), 1);
        glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
        glFinish();
        std::vector<glm::vec4> texels(count);
        std::memcpy(texels.data(), shown->mapped().data(), count * sizeof(glm::vec4));
        return {texels.begin(), texels.end()};
    }

  private:
    gl::Program program_;
};

}  // namespace ridgeline::test
