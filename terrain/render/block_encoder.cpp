#include "ridgeline/render/block_encoder.h"

#include "ridgeline/base/thread_role.h"
#include "ridgeline/gl/debug_output.h"
#include "ridgeline/gl/fence.h"

namespace ridgeline::render {
namespace {

using io::Bc1Block;
using shaders::Bc1Texels;

enum Location : GLint { kFirst, kCount };

}  // namespace

Result<BlockEncoder> BlockEncoder::create(std::size_t slots, std::size_t blocks_per_slot) {
    BlockEncoder encoder;
    encoder.slots_ = slots;
    encoder.blocks_per_slot_ = blocks_per_slot;
    auto program = gl::Program::create({{"passes/bc1.comp"}, {}});
    if (!program) return program.error();
    encoder.program_ = std::move(program).value();
    const std::size_t all = slots * blocks_per_slot;
    auto texels = gl::Buffer::create(
        {.size_bytes = all * sizeof(Bc1Texels), .use = gl::BufferUse::upload, .label = "texels to encode"});
    if (!texels) return texels.error();
    encoder.texels_ = std::move(texels).value();
    auto blocks = gl::Buffer::create(
        {.size_bytes = all * sizeof(Bc1Block), .use = gl::BufferUse::readback, .label = "encoded blocks"});
    if (!blocks) return blocks.error();
    encoder.blocks_ = std::move(blocks).value();
    return encoder;
}

std::span<Bc1Texels> BlockEncoder::texels(std::size_t slot) const {
    RIDGELINE_CHECK(slot < slots_);
    auto* all = reinterpret_cast<Bc1Texels*>(texels_.mapped().data());
    return {all + slot * blocks_per_slot_, blocks_per_slot_};
}

std::span<const Bc1Block> BlockEncoder::blocks(std::size_t slot) const {
    RIDGELINE_CHECK(slot < slots_);
    const auto* all = reinterpret_cast<const Bc1Block*>(blocks_.mapped().data());
    return {all + slot * blocks_per_slot_, blocks_per_slot_};
}

void BlockEncoder::start(std::size_t slot, std::size_t count) {
    RIDGELINE_ASSERT_ROLE(render);
    RIDGELINE_CHECK(slot < slots_ && count > 0 && count <= blocks_per_slot_);
    const gl::DebugGroup group("encode blocks");
    texels_.bind_base(GL_SHADER_STORAGE_BUFFER, shaders::kBc1TexelsBinding);
    blocks_.bind_base(GL_SHADER_STORAGE_BUFFER, shaders::kBc1BlocksBinding);
    program_.set(kFirst, static_cast<int>(slot * blocks_per_slot_));
    program_.set(kCount, static_cast<int>(count));
    program_.use();
    const std::size_t group_size = shaders::kBc1Group;
    glDispatchCompute(static_cast<GLuint>((count + group_size - 1) / group_size), 1, 1);
}

Result<void> BlockEncoder::finish(std::chrono::nanoseconds limit) {
    RIDGELINE_ASSERT_ROLE(render);
    // What shaders wrote is to be seen through the mapping.
    glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    if (gl::Fence::insert().wait(limit)) return {};
    return Error{"the GPU does not finish its blocks: encode without it"};
}

}  // namespace ridgeline::render
