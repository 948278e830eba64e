// Whether GL found the memory for what was just asked of it. Render thread only.
#pragma once

#include <glad/gl.h>

#include <cstdint>
#include <string>

#include "ridgeline/base/result.h"
#include "ridgeline/base/units.h"

namespace ridgeline::gl {

class MemoryCheck {
  public:
    // Errors of before are not ours; debug output has reported them.
    MemoryCheck() {
        while (glGetError() != GL_NO_ERROR) {
        }
    }

    Result<void> finish(const std::string& what, std::uint64_t size_bytes) const {
        const GLenum code = glGetError();
        if (code == GL_NO_ERROR) return {};
        if (code == GL_OUT_OF_MEMORY)
            return Error{what + ": the GPU has not " + format_bytes(size_bytes) +
                         " left: use smaller caches"};
        return Error{what + ": the GPU driver refused " + format_bytes(size_bytes) + " (GL error " +
                     std::to_string(code) + ")"};
    }
};

}  // namespace ridgeline::gl
