#version 450 core
// The vertex stage of every pass that covers the screen: draw three vertices without attributes.
#include "../lib/fullscreen.h"

// Reverse-Z: 0 is infinitely far, where the sky and what fills the background belong.
layout(location = 0) uniform float depth;

layout(location = 0) out vec2 ndc;

void main() {
    ndc = fullscreen_corner(gl_VertexID);
    gl_Position = vec4(ndc, depth, 1.0);
}
