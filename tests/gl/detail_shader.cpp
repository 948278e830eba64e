// Ground made below the source by the GPU is the CPU's, bit by bit: octave after octave over random tiles, from the roughest
// to the level.
#include <doctest/doctest.h>

#include <cstring>
#include <random>
#include <vector>

#include "ridgeline/detail/detail_tile.h"
#include "ridgeline/gl/buffer.h"
#include "ridgeline/gl/program.h"
#include "ridgeline/shaders/shader_source.h"
#include "support/gl_context.h"

using namespace ridgeline;

namespace {

constexpr int kQuads = 64, kStride = kQuads + 1 + 2 * io::HeightsTile::kApron;

// A work group a row of the child.
constexpr const char* kMakeTile = R"(#version 450 core
layout(local_size_x = 71) in;
layout(std430, binding = 0) readonly buffer ParentBlock { int parent_heights[]; };
layout(std430, binding = 1) writeonly buffer ChildBlock { int child_heights[]; };
layout(location = 0) uniform ivec4 corner_and_first;
layout(location = 1) uniform ivec4 gains;
layout(location = 2) uniform int octave;

int detail_height(ivec2 at) { return parent_heights[(at.y + 3) * 71 + at.x + 3]; }
#include "lib/detail.h"

void main() {
    ivec2 place = ivec2(gl_LocalInvocationID.x, gl_WorkGroupID.x);
    child_heights[place.y * 71 + place.x] = detail_sample(corner_and_first.xy + place - 3, corner_and_first.zw, octave,
                                                          DetailOctave(gains.x, gains.y, gains.z, gains.w));
}
)";

gl::ShaderLookup with_test_pass() {
    return [](std::string_view path) -> std::optional<std::string_view> {
        if (path == "make_tile.comp") return kMakeTile;
        return shaders::shader_source(path);
    };
}

class TileMaker {
  public:
    TileMaker() {
        auto program = gl::Program::create({.stages = {"make_tile.comp"}}, with_test_pass());
        REQUIRE_MESSAGE(program, (program ? "" : program.error().message));
        program_ = std::move(*program);
        for (gl::Buffer* buffer : {&parent_, &child_}) {
            auto made = gl::Buffer::create(
                {kStride * kStride * sizeof(std::int32_t), gl::BufferUse::update, "heights"});
            REQUIRE(made);
            *buffer = std::move(*made);
        }
    }

    std::vector<std::int32_t> make(const detail::DetailTile& parent, int quarter,
                                   const io::DetailGains& gains) {
        parent_.write(0, std::as_bytes(std::span(parent.heights)));
        parent_.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
        child_.bind_base(GL_SHADER_STORAGE_BUFFER, 1);
        program_.use();
        program_.set(0, glm::ivec4((quarter & 1) * kQuads, (quarter >> 1) * kQuads, parent.node.x * kQuads,
                                   parent.node.y * kQuads));
        program_.set(
            1, glm::ivec4(gains.face_slope, gains.face_roughness, gains.edge_slope, gains.edge_roughness));
        program_.set(2, parent.octave + 1);
        glDispatchCompute(kStride, 1, 1);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        std::vector<std::int32_t> heights(parent.heights.size());
        glGetNamedBufferSubData(child_.id(), 0, static_cast<GLsizeiptr>(heights.size() * sizeof heights[0]),
                                heights.data());
        return heights;
    }

  private:
    gl::Program program_;
    gl::Buffer parent_, child_;
};

detail::DetailTile random_root(std::mt19937& random) {
    const int roughness = 1 << random() % 22;
    detail::DetailTile tile;
    tile.quads = kQuads;
    tile.node = {9, static_cast<int>(random() % 5000), static_cast<int>(random() % 5000)};
    for (int i = 0; i < kStride * kStride; ++i)
        tile.heights.push_back(i % kStride < 20 ? 7
                                                : static_cast<int>(random() % (2u * roughness)) - roughness);
    return tile;
}

}  // namespace

TEST_CASE("the GPU makes the CPU's ground, bit by bit") {
    test::GlContext gl;
    if (!gl) return;
    TileMaker maker;
    std::mt19937 random(6);
    std::size_t different = 0, made = 0;
    for (int land = 0; land < 20; ++land) {
        detail::DetailTile tile = random_root(random), child;
        const auto gain = [&] {
            return static_cast<int>(random() % (io::DetailInfo::kMostGain + 1)) >> random() % 4;
        };
        for (int octave = 0; octave < 4; ++octave) {
            const io::DetailGains gains{gain() / 8, gain() / 8, gain() / 8, gain() / 8};
            const int quarter = static_cast<int>(random() % 4);
            detail::make_child(tile, quarter, gains, child);
            const auto by_gpu = maker.make(tile, quarter, gains);
            for (std::size_t i = 0; i < by_gpu.size(); ++i) different += by_gpu[i] != child.heights[i];
            made += by_gpu.size();
            std::swap(tile, child);
        }
    }
    CHECK(made == 20 * 4 * kStride * kStride);
    CHECK(different == 0);
}
