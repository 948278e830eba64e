// The drawn frame as a picture: 8-bit RGB, top row first, and as a PNG file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/framebuffer.h"

namespace ridgeline::gl {

struct Image {
    glm::ivec2 size_px{0};
    std::vector<std::byte> rgb;  // 3 bytes a pixel, rows without padding, top row first
};

// Waits for the GPU. Render thread.
Image read_image(const Framebuffer& framebuffer);

// Averaged down by a whole factor >= 1, for thumbnails; rows and columns that do not fill a pixel are
// dropped.
Image shrink(const Image& image, int factor);

// Written beside the target and renamed: what stands there is always whole. Any thread.
Result<void> write_png(const std::filesystem::path& file, const Image& image);

}  // namespace ridgeline::gl
