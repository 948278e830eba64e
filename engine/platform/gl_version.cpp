#include "ridgeline/platform/gl_version.h"

#include <cstdio>

namespace ridgeline::platform {

namespace {

// From the specification; a header for two constants would be the only use of a GL header in this room.
constexpr unsigned kGlRenderer = 0x1F01;
constexpr unsigned kGlVersion = 0x1F02;

using GetString = const unsigned char* (*)(unsigned name);

std::string text_of(GetString get_string, unsigned name) {
    const unsigned char* text = get_string(name);
    return text != nullptr ? reinterpret_cast<const char*>(text) : "";
}

}  // namespace

bool GlVersion::software() const {
    return renderer.find("llvmpipe") != std::string::npos || renderer.find("softpipe") != std::string::npos ||
           renderer.find("swrast") != std::string::npos;
}

GlVersion read_gl_version(GlLoader loader) {
    const auto get_string = reinterpret_cast<GetString>(loader("glGetString"));
    if (get_string == nullptr) return {};
    GlVersion found;
    found.text = text_of(get_string, kGlVersion);
    found.renderer = text_of(get_string, kGlRenderer);
    // "4.5 (Core Profile) Mesa 22.3.6"; OpenGL ES puts its name first and then counts as none.
    std::sscanf(found.text.c_str(), "%d.%d", &found.major, &found.minor);
    return found;
}

Error too_old(const GlVersion& found) {
    const std::string had = found.text.empty() ? "none" : found.text + " on " + found.renderer;
    return Error{"OpenGL 4.5 is needed, found " + had +
                 ": update the graphics driver, or set LIBGL_ALWAYS_SOFTWARE=1 to draw on the CPU"};
}

}  // namespace ridgeline::platform
