// A sheet on which a suite lays its pictures side by side: pixels in memory, no GL.
//
// Places and sizes are in pixels from the upper left corner; what lies outside the sheet is cut off. One
// thread at a time.
#pragma once

#include <glm/glm.hpp>
#include <string_view>

#include "ridgeline/gl/screenshot.h"

namespace ridgeline::app {

struct PixelBox {
    glm::ivec2 origin{0};
    glm::ivec2 size{0};
};

struct Ink {
    glm::u8vec3 rgb{0};
    double opacity = 1.0;
};

class PictureSheet {
  public:
    PictureSheet(const glm::ivec2& size_px, const glm::u8vec3& ground);

    // The part of an image that `from` names; all of it lies within the image.
    void lay(const gl::Image& image, const PixelBox& from, const glm::ivec2& at);
    void lay(const gl::Image& image, const glm::ivec2& at) { lay(image, {{0, 0}, image.size_px}, at); }
    void fill(const PixelBox& box, const Ink& ink);
    void outline(const PixelBox& box, const Ink& ink);
    // One line, white on a dark band, its upper left corner at `at`. ASCII.
    void label(std::string_view text, const glm::ivec2& at);
    static int label_height_px();

    const gl::Image& image() const { return image_; }

  private:
    void blend(const glm::ivec2& at, const glm::vec3& rgb, double opacity);

    gl::Image image_;
};

}  // namespace ridgeline::app
