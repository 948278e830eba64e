#include "ridgeline/app/bench/picture_sheet.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "ridgeline/base/contract.h"

namespace ridgeline::app {
namespace {

constexpr int kMargin_px = 4;  // of a label about its letters
constexpr Ink kBand{{0, 0, 0}, 0.55};

// The HUD's letters, as coverage.
class Letters {
  public:
    struct Letter {
        PixelBox coverage;  // in the atlas
        glm::ivec2 offset{0};
        int advance_px = 0;
    };

    Letters() {
        font_ = atlas_.AddFontDefault();
        atlas_.GetTexDataAsAlpha8(&pixels_, &size_.x, &size_.y);
    }

    int height_px() const { return static_cast<int>(font_->FontSize); }
    Letter letter(char c) const {
        const ImFontGlyph& glyph = *font_->FindGlyph(static_cast<ImWchar>(static_cast<unsigned char>(c)));
        const auto rounded = [](float value) { return static_cast<int>(std::lround(value)); };
        const glm::ivec2 first(rounded(glyph.U0 * static_cast<float>(size_.x)),
                               rounded(glyph.V0 * static_cast<float>(size_.y)));
        const glm::ivec2 end(rounded(glyph.U1 * static_cast<float>(size_.x)),
                             rounded(glyph.V1 * static_cast<float>(size_.y)));
        return {{first, end - first}, {rounded(glyph.X0), rounded(glyph.Y0)}, rounded(glyph.AdvanceX)};
    }
    double coverage(const glm::ivec2& at) const { return pixels_[at.y * size_.x + at.x] / 255.0; }

  private:
    ImFontAtlas atlas_;
    ImFont* font_ = nullptr;
    unsigned char* pixels_ = nullptr;
    glm::ivec2 size_{0};
};

const Letters& letters() {
    static const Letters made;
    return made;
}

}  // namespace

PictureSheet::PictureSheet(const glm::ivec2& size_px, const glm::u8vec3& ground) : image_{size_px, {}} {
    image_.rgb.resize(static_cast<std::size_t>(size_px.x) * static_cast<std::size_t>(size_px.y) * 3);
    fill({{0, 0}, size_px}, {ground});
}

void PictureSheet::lay(const gl::Image& image, const PixelBox& from, const glm::ivec2& at) {
    RIDGELINE_CHECK(glm::all(glm::greaterThanEqual(from.origin, glm::ivec2(0))) &&
                    glm::all(glm::lessThanEqual(from.origin + from.size, image.size_px)));
    const auto channel = [&](const glm::ivec2& pixel, int c) {
        const auto place = static_cast<std::size_t>((pixel.y * image.size_px.x + pixel.x) * 3 + c);
        return std::to_integer<int>(image.rgb[place]);
    };
    for (int y = 0; y < from.size.y; ++y)
        for (int x = 0; x < from.size.x; ++x) {
            const glm::ivec2 pixel = from.origin + glm::ivec2(x, y);
            blend(at + glm::ivec2(x, y), {channel(pixel, 0), channel(pixel, 1), channel(pixel, 2)}, 1.0);
        }
}

void PictureSheet::fill(const PixelBox& box, const Ink& ink) {
    for (int y = 0; y < box.size.y; ++y)
        for (int x = 0; x < box.size.x; ++x) blend(box.origin + glm::ivec2(x, y), ink.rgb, ink.opacity);
}

void PictureSheet::outline(const PixelBox& box, const Ink& ink) {
    const glm::ivec2 end = box.origin + box.size - 1;
    fill({box.origin, {box.size.x, 1}}, ink);
    fill({{box.origin.x, end.y}, {box.size.x, 1}}, ink);
    fill({box.origin, {1, box.size.y}}, ink);
    fill({{end.x, box.origin.y}, {1, box.size.y}}, ink);
}

void PictureSheet::label(std::string_view text, const glm::ivec2& at) {
    int width_px = 0;
    for (const char c : text) width_px += letters().letter(c).advance_px;
    fill({at, {width_px + 2 * kMargin_px, label_height_px()}}, kBand);
    glm::ivec2 pen = at + kMargin_px;
    for (const char c : text) {
        const Letters::Letter letter = letters().letter(c);
        for (int y = 0; y < letter.coverage.size.y; ++y)
            for (int x = 0; x < letter.coverage.size.x; ++x)
                blend(pen + letter.offset + glm::ivec2(x, y), glm::vec3(255.0f),
                      letters().coverage(letter.coverage.origin + glm::ivec2(x, y)));
        pen.x += letter.advance_px;
    }
}

int PictureSheet::label_height_px() { return letters().height_px() + 2 * kMargin_px; }

void PictureSheet::blend(const glm::ivec2& at, const glm::vec3& rgb, double opacity) {
    if (at.x < 0 || at.y < 0 || at.x >= image_.size_px.x || at.y >= image_.size_px.y) return;
    std::byte* pixel = &image_.rgb[static_cast<std::size_t>((at.y * image_.size_px.x + at.x) * 3)];
    for (int c = 0; c < 3; ++c) {
        const double mixed =
            std::to_integer<int>(pixel[c]) * (1.0 - opacity) + static_cast<double>(rgb[c]) * opacity;
        pixel[c] = static_cast<std::byte>(std::lround(mixed));
    }
}

}  // namespace ridgeline::app
