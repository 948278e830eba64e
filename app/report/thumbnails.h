// The small pictures of a walk (thumbs/FRAME.png), made smaller still for a page that carries them inside it.
//
// A picture is decoded and written anew as JPEG, a fifth of the bytes: the page stays small, and a file that
// only calls itself a picture never gets there. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"

namespace ridgeline::app::report {

struct Thumbnail {
    std::int64_t frame = 0;
    int width_px = 0;
    int height_px = 0;
    std::string jpeg_base64;
};

struct Thumbnails {
    std::vector<Thumbnail> pictures;    // by frame
    std::vector<std::string> left_out;  // why, of each that is none
};

// At most `most`, spread evenly, the first and the last among them. A folder that is not there holds none.
Thumbnails read_thumbnails(const std::filesystem::path& folder, std::size_t most);

}  // namespace ridgeline::app::report
