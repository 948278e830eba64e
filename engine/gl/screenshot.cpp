#include "ridgeline/gl/screenshot.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "ridgeline/base/whole_file.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace ridgeline::gl {

namespace {

void flip_rows(Image& image) {
    const auto row_bytes = static_cast<std::ptrdiff_t>(image.size_px.x) * 3;
    for (std::ptrdiff_t top = 0, bottom = image.size_px.y - 1; top < bottom; ++top, --bottom) {
        const auto first = image.rgb.begin() + top * row_bytes;
        std::swap_ranges(first, first + row_bytes, image.rgb.begin() + bottom * row_bytes);
    }
}

// The mean of one channel over a square of `factor` pixels a side.
std::byte mean_of(const Image& image, const glm::ivec2& origin, int factor, int channel) {
    int sum = 0;
    for (int y = origin.y; y < origin.y + factor; ++y)
        for (int x = origin.x; x < origin.x + factor; ++x)
            sum += std::to_integer<int>(
                image.rgb[static_cast<std::size_t>((y * image.size_px.x + x) * 3 + channel)]);
    const int pixels = factor * factor;
    return static_cast<std::byte>((sum + pixels / 2) / pixels);
}

void append(void* bytes, void* data, int size) {
    const auto* first = static_cast<const std::byte*>(data);
    auto& target = *static_cast<std::vector<std::byte>*>(bytes);
    target.insert(target.end(), first, first + size);
}

}  // namespace

Image read_image(const Framebuffer& framebuffer) {
    RIDGELINE_ASSERT_ROLE(render);
    Image image{framebuffer.size_px(), {}};
    image.rgb.resize(static_cast<std::size_t>(image.size_px.x) * static_cast<std::size_t>(image.size_px.y) *
                     3);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer.id());
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadnPixels(0, 0, image.size_px.x, image.size_px.y, GL_RGB, GL_UNSIGNED_BYTE,
                  static_cast<GLsizei>(image.rgb.size()), image.rgb.data());
    flip_rows(image);
    return image;
}

Image shrink(const Image& image, int factor) {
    RIDGELINE_CHECK(factor >= 1);
    Image small{image.size_px / factor, {}};
    small.rgb.reserve(static_cast<std::size_t>(small.size_px.x) * static_cast<std::size_t>(small.size_px.y) *
                      3);
    for (int y = 0; y < small.size_px.y; ++y)
        for (int x = 0; x < small.size_px.x; ++x)
            for (int channel = 0; channel < 3; ++channel)
                small.rgb.push_back(mean_of(image, glm::ivec2(x, y) * factor, factor, channel));
    return small;
}

Result<void> write_png(const std::filesystem::path& file, const Image& image) {
    std::vector<std::byte> png;
    const int made = stbi_write_png_to_func(append, &png, image.size_px.x, image.size_px.y, 3,
                                            image.rgb.data(), image.size_px.x * 3);
    if (made == 0) return Error{file.string() + ": the picture could not be encoded"};
    return write_whole_file(file, png);
}

}  // namespace ridgeline::gl
