#include "ridgeline/gpu_encoder/block_encoder.h"

#include <chrono>
#include <utility>

#include "ridgeline/base/contract.h"
#include "ridgeline/gl/fence.h"

namespace ridgeline::build {
namespace {

constexpr GLint kCountLocation = 0;
// A batch takes milliseconds, on the slowest software some hundred.
constexpr std::chrono::seconds kPatience{60};

static_assert(sizeof(io::Bc1Block) == sizeof(std::uint32_t) * 2);

}  // namespace

Result<BlockEncoder> BlockEncoder::create(std::size_t most_blocks) {
    auto program = gl::Program::create({{"passes/bc1.comp"}, {}});
    if (!program) return program.error();
    auto texels = gl::Buffer::create({.size_bytes = most_blocks * sizeof(shaders::Bc1Texels),
                                      .use = gl::BufferUse::upload,
                                      .label = "texels"});
    if (!texels) return texels.error();
    const std::size_t block_bytes = most_blocks * sizeof(io::Bc1Block);
    auto blocks = gl::Buffer::create({.size_bytes = block_bytes, .label = "BC1 blocks"});
    if (!blocks) return blocks.error();
    auto arrived = gl::Buffer::create(
        {.size_bytes = block_bytes, .use = gl::BufferUse::readback, .label = "BC1 blocks, arrived"});
    if (!arrived) return arrived.error();
    BlockEncoder made;
    made.most_blocks_ = most_blocks;
    made.program_ = std::move(program).value();
    made.texels_ = std::move(texels).value();
    made.blocks_ = std::move(blocks).value();
    made.arrived_ = std::move(arrived).value();
    return made;
}

std::span<shaders::Bc1Texels> BlockEncoder::texels() {
    return {reinterpret_cast<shaders::Bc1Texels*>(texels_.mapped().data()), most_blocks_};
}

Result<std::span<const io::Bc1Block>> BlockEncoder::encode(std::size_t count) {
    RIDGELINE_CHECK(count <= most_blocks_);
    program_.use();
    program_.set(kCountLocation, static_cast<int>(count));
    texels_.bind_base(GL_SHADER_STORAGE_BUFFER, shaders::kBc1TexelsBinding);
    blocks_.bind_base(GL_SHADER_STORAGE_BUFFER, shaders::kBc1BlocksBinding);
    constexpr std::size_t kGroup = shaders::kBc1Group;
    glDispatchCompute(static_cast<GLuint>((count + kGroup - 1) / kGroup), 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gl::copy(blocks_, 0, arrived_, 0, count * sizeof(io::Bc1Block));
    if (!gl::Fence::insert().wait(kPatience)) return Error{"the GPU does not answer"};
    return std::span(reinterpret_cast<const io::Bc1Block*>(arrived_.mapped().data()), count);
}

}  // namespace ridgeline::build
