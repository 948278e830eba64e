#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <numeric>
#include <vector>

#include "ridgeline/gl/fence.h"
#include "ridgeline/gl/query.h"
#include "ridgeline/gl/vertex_array.h"
#include "support/gl_context.h"

namespace ridgeline::gl {
namespace {

constexpr std::chrono::seconds kLong{20};

std::vector<std::uint32_t> numbers(std::size_t count) {
    std::vector<std::uint32_t> values(count);
    std::iota(values.begin(), values.end(), 100U);
    return values;
}

// What a buffer holds, read through a mapped one.
std::vector<std::uint32_t> contents(const Buffer& buffer) {
    auto read =
        Buffer::create({.size_bytes = buffer.size_bytes(), .use = BufferUse::readback, .label = "read"});
    REQUIRE(read);
    copy(buffer, 0, *read, 0, buffer.size_bytes());
    REQUIRE(Fence::insert().wait(kLong));
    std::vector<std::uint32_t> values(buffer.size_bytes() / 4);
    std::memcpy(values.data(), read->mapped().data(), values.size() * 4);
    return values;
}

std::vector<std::uint8_t> texels_of(const Texture2D& texture, GLenum format, std::size_t bytes) {
    std::vector<std::uint8_t> texels(bytes);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(texture.id(), 0, format, GL_UNSIGNED_BYTE, static_cast<GLsizei>(bytes), texels.data());
    return texels;
}

TEST_CASE("objects are empty by default and when moved from") {
    test::GlContext gl;
    if (!gl) return;
    Buffer none;
    CHECK(none.empty());
    auto buffer = Buffer::create({.size_bytes = 16, .label = "moved"});
    REQUIRE(buffer);
    const GLuint id = buffer->id();
    Buffer taken = std::move(*buffer);
    CHECK(buffer->empty());
    CHECK(taken.id() == id);
    none = std::move(taken);
    CHECK(none.id() == id);
    none = Buffer();
    taken = Buffer();
    CHECK(glIsBuffer(id) == GL_FALSE);
}

TEST_CASE("buffers hold what they are given, in every use") {
    test::GlContext gl;
    if (!gl) return;
    const auto values = numbers(64);
    const std::span<const std::byte> bytes = bytes_of(std::span(values));
    for (BufferUse use : {BufferUse::gpu, BufferUse::update, BufferUse::upload, BufferUse::readback}) {
        const auto buffer = Buffer::create({.size_bytes = bytes.size(), .use = use, .label = "whole"}, bytes);
        REQUIRE(buffer);
        CHECK(contents(*buffer) == values);
        CHECK(buffer->mapped().empty() == (use == BufferUse::gpu || use == BufferUse::update));
    }
    auto part = Buffer::create({.size_bytes = bytes.size() * 2, .label = "part"}, bytes);
    REQUIRE(part);
    auto found = contents(*part);
    found.resize(values.size());
    CHECK(found == values);
    part->clear(7);
    CHECK(contents(*part) == std::vector<std::uint32_t>(128, 7));
}

TEST_CASE("what is written through a mapping is seen by the GPU") {
    test::GlContext gl;
    if (!gl) return;
    const auto values = numbers(32);
    auto buffer = Buffer::create({.size_bytes = 128, .use = BufferUse::upload, .label = "mapped"});
    REQUIRE(buffer);
    std::memcpy(buffer->mapped().data(), values.data(), 128);
    CHECK(contents(*buffer) == values);
}

TEST_CASE("memory that the GPU has not is an error, not a crash") {
    test::GlContext gl;
    if (!gl) return;
    // A petabyte.
    const auto buffer = Buffer::create({.size_bytes = std::uint64_t{1} << 50, .label = "chunk slots"});
    REQUIRE_FALSE(buffer);
    CHECK(buffer.error().message.starts_with("chunk slots: "));
    gl.expect_errors(1);
}

TEST_CASE("texels come from memory or from a buffer, rows as long as they say") {
    test::GlContext gl;
    if (!gl) return;
    std::vector<std::uint8_t> values(12);
    std::iota(values.begin(), values.end(), std::uint8_t{1});
    const auto bytes = std::as_bytes(std::span(values));
    auto texture = Texture2D::create({.format = GL_R8, .size_px = {3, 2}, .label = "small"});
    REQUIRE(texture);
    const TexelLayout layout{.format = GL_RED, .row_length_px = 5};
    texture->upload({.size_px = {3, 2}}, layout, bytes);
    CHECK(texels_of(*texture, GL_RED, 6) == std::vector<std::uint8_t>{1, 2, 3, 6, 7, 8});

    auto source = Buffer::create({.size_bytes = 12, .label = "source"}, bytes);
    REQUIRE(source);
    texture->upload({.origin_px = {1, 0}, .size_px = {2, 2}}, {.format = GL_RED}, *source, 4);
    CHECK(texels_of(*texture, GL_RED, 6) == std::vector<std::uint8_t>{1, 5, 6, 6, 7, 8});
}

TEST_CASE("layers of an array are uploaded, drawn to and apart") {
    test::GlContext gl;
    if (!gl) return;
    auto array =
        Texture2DArray::create({.format = GL_RGBA8, .size_px = {4, 4}, .layers = 3, .label = "layers"});
    REQUIRE(array);
    const std::vector<std::byte> white(64, std::byte{255});
    array->upload({.layer = 2, .size_px = {4, 4}}, {}, white);
    const auto layer = Framebuffer::create_layer(*array, 1, "layer 1");
    REQUIRE(layer);
    layer->bind();
    const std::array<float, 4> color = {1.0f, 0.0f, 0.0f, 1.0f};
    glClearNamedFramebufferfv(layer->id(), GL_COLOR, 0, color.data());
    std::vector<std::uint8_t> texels(192);
    glGetTextureImage(array->id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, 192, texels.data());
    CHECK(texels[64] == 255);
    CHECK(texels[65] == 0);
    CHECK(std::count(texels.begin() + 128, texels.end(), std::uint8_t{255}) == 64);
}

TEST_CASE("BC1 blocks are uploaded and decoded") {
    test::GlContext gl;
    if (!gl) return;
    if (!query_capabilities().s3tc) {
        MESSAGE("skipped: no BC1 textures here");
        return;
    }
    // Both end colours pure green (565: 0x07E0), all indices 0.
    const std::array<std::uint8_t, 8> green = {0xE0, 0x07, 0xE0, 0x07, 0, 0, 0, 0};
    auto texture =
        Texture2D::create({.format = GL_COMPRESSED_RGB_S3TC_DXT1_EXT, .size_px = {8, 4}, .label = "BC1"});
    REQUIRE(texture);
    texture->upload({.origin_px = {4, 0}, .size_px = {4, 4}}, {.format = GL_COMPRESSED_RGB_S3TC_DXT1_EXT},
                    std::as_bytes(std::span(green)));
    const auto texels = texels_of(*texture, GL_RGB, 96);
    CHECK(texels[4 * 3 + 0] == 0);
    CHECK(texels[4 * 3 + 1] == 255);
}

TEST_CASE("a framebuffer that cannot be drawn to is an error") {
    test::GlContext gl;
    if (!gl) return;
    const auto compressed =
        Texture2D::create({.format = GL_COMPRESSED_RED_RGTC1, .size_px = {8, 8}, .label = "compressed"});
    REQUIRE(compressed);
    const Texture2D* colors[] = {&*compressed};
    CHECK_FALSE(Framebuffer::create({.colors = colors, .label = "wrong"}));
}

TEST_CASE("an empty fence has passed, and so has one that was waited for") {
    test::GlContext gl;
    if (!gl) return;
    CHECK(Fence().passed());
    const Fence fence = Fence::insert();
    CHECK(fence.wait(kLong));
    CHECK(fence.passed());
}

TEST_CASE("vertex arrays and samplers are made without errors") {
    test::GlContext gl;
    if (!gl) return;
    const VertexAttribute attributes[] = {{.location = 0, .components = 2},
                                          {.location = 1,
                                           .components = 1,
                                           .type = GL_UNSIGNED_INT,
                                           .kind = AttributeKind::integer,
                                           .offset_bytes = 8}};
    VertexArray array = VertexArray::create(attributes, "two attributes");
    auto buffer = Buffer::create({.size_bytes = 120, .label = "vertices"});
    REQUIRE(buffer);
    array.set_vertex_buffer(0, *buffer, 0, 12);
    array.set_index_buffer(*buffer);
    array.bind();
    const Sampler sampler = Sampler::create(
        {.min_filter = GL_LINEAR_MIPMAP_LINEAR, .max_anisotropy = 16.0f, .compare_function = GL_GEQUAL});
    sampler.bind(3);
    CHECK_FALSE(sampler.empty());
}

}  // namespace
}  // namespace ridgeline::gl
