#include "ridgeline/app/report/thumbnails.h"

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

#include "ridgeline/app/report/html_text.h"
#include "ridgeline/base/whole_file.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
// Nothing larger is a thumbnail; a file that claims to be is not given the memory for it.
#define STBI_MAX_DIMENSIONS 4096
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace ridgeline::app::report {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestFile_bytes = std::size_t{1} << 24;
// 320 x 180 is 15 KB then, and no block shows at the size at which the page draws it.
constexpr int kJpegQuality = 82;
// What the page is wide, at most, for eight of them: pictures of larger walks are shrunk by whole factors.
constexpr int kMostWidth_px = 360;

struct NumberedFile {
    std::int64_t frame;
    fs::path file;
};

std::optional<std::int64_t> frame_of(const fs::path& file) {
    const std::string stem = file.stem().string();
    std::int64_t frame = 0;
    const auto [end, status] = std::from_chars(stem.data(), stem.data() + stem.size(), frame);
    if (file.extension() != ".png" || status != std::errc() || end != stem.data() + stem.size() || frame < 0)
        return std::nullopt;
    return frame;
}

std::vector<NumberedFile> pictures_in(const fs::path& folder) {
    std::vector<NumberedFile> files;
    std::error_code failed;
    for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed))
        if (const auto frame = frame_of(entry->path())) files.push_back({*frame, entry->path()});
    std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.frame < b.frame; });
    return files;
}

std::vector<NumberedFile> spread(std::vector<NumberedFile> files, std::size_t most) {
    if (files.size() <= most || most == 0) return most == 0 ? std::vector<NumberedFile>() : files;
    std::vector<NumberedFile> kept;
    for (std::size_t i = 0; i < most; ++i)
        kept.push_back(files[most == 1 ? 0 : i * (files.size() - 1) / (most - 1)]);
    return kept;
}

struct Picture {
    int width_px = 0;
    int height_px = 0;
    std::vector<unsigned char> rgb;
};

std::optional<Picture> decoded(const std::string& png) {
    Picture picture;
    int channels = 0;
    const std::unique_ptr<unsigned char, void (*)(void*)> pixels(
        stbi_load_from_memory(reinterpret_cast<const unsigned char*>(png.data()),
                              static_cast<int>(png.size()), &picture.width_px, &picture.height_px, &channels,
                              3),
        [](void* memory) { stbi_image_free(memory); });
    if (!pixels) return std::nullopt;
    picture.rgb.assign(pixels.get(), pixels.get() + std::size_t{3} *
                                                        static_cast<std::size_t>(picture.width_px) *
                                                        static_cast<std::size_t>(picture.height_px));
    return picture;
}

// Averaged down by a whole factor until it is no wider than the page draws it.
Picture shrunk(const Picture& picture) {
    const int factor = std::min((picture.width_px + kMostWidth_px - 1) / kMostWidth_px, picture.height_px);
    Picture small{picture.width_px / factor, picture.height_px / factor, {}};
    for (int y = 0; y < small.height_px; ++y)
        for (int x = 0; x < small.width_px * 3; ++x) {
            int sum = 0;
            for (int dy = 0; dy < factor; ++dy)
                for (int dx = 0; dx < factor; ++dx)
                    sum += picture.rgb[static_cast<std::size_t>(
                        ((y * factor + dy) * picture.width_px + x / 3 * factor + dx) * 3 + x % 3)];
            small.rgb.push_back(static_cast<unsigned char>(sum / (factor * factor)));
        }
    return small;
}

void append(void* bytes, void* data, int size) {
    const auto* first = static_cast<const std::byte*>(data);
    auto& target = *static_cast<std::vector<std::byte>*>(bytes);
    target.insert(target.end(), first, first + size);
}

Result<Thumbnail> read_thumbnail(const NumberedFile& source) {
    const auto png = read_text_file(source.file, kLargestFile_bytes);
    if (!png) return png.error();
    const auto picture = decoded(*png);
    if (!picture) return Error{source.file.string() + ": is no whole PNG"};
    const Picture small = shrunk(*picture);
    std::vector<std::byte> jpeg;
    if (stbi_write_jpg_to_func(append, &jpeg, small.width_px, small.height_px, 3, small.rgb.data(),
                               kJpegQuality) == 0)
        return Error{source.file.string() + ": could not be encoded"};
    return Thumbnail{source.frame, small.width_px, small.height_px, base64(jpeg)};
}

}  // namespace

Thumbnails read_thumbnails(const fs::path& folder, std::size_t most) {
    Thumbnails thumbnails;
    for (const NumberedFile& file : spread(pictures_in(folder), most)) {
        auto picture = read_thumbnail(file);
        if (picture)
            thumbnails.pictures.push_back(std::move(*picture));
        else
            thumbnails.left_out.push_back(picture.error().message);
    }
    return thumbnails;
}

}  // namespace ridgeline::app::report
