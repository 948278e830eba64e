// Private to this room: what a context that has just been made current turned out to be.
#pragma once

#include <string>

#include "ridgeline/base/result.h"
#include "ridgeline/platform/context.h"

namespace ridgeline::platform {

struct GlVersion {
    int major = 0;
    int minor = 0;
    std::string text;
    std::string renderer;

    bool enough() const { return major > 4 || (major == 4 && minor >= 5); }
    // Drawn by the CPU (Mesa's llvmpipe and softpipe).
    bool software() const;
};

// Of the current context.
GlVersion read_gl_version(GlLoader loader);

// The error of a machine whose best context is `found`.
Error too_old(const GlVersion& found);

}  // namespace ridgeline::platform
