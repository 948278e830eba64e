// One triangle that covers the whole screen: no seam along a diagonal, no vertex buffer.
#pragma once
#include "../shared/portable.h"

SHADER_BEGIN

// The corner of vertex 0, 1 or 2 in normalised device coordinates: (-1, -1), (3, -1), (-1, 3).
SHADER_FUNCTION vec2 fullscreen_corner(int vertex) {
    return vec2((vertex & 1) != 0 ? 3.0f : -1.0f, (vertex & 2) != 0 ? 3.0f : -1.0f);
}

SHADER_END
