#version 450 core
// The sky where no ground stands before it.
#include "../lib/atmosphere.h"
#include "../lib/display.h"
#include "../shared/frame_uniforms.h"

layout(location = 0) in vec2 ndc;

layout(location = 0) out vec4 color;

void main() {
    vec3 ray = frame.ray_origin.xyz + gl_FragCoord.x * frame.ray_dx.xyz + gl_FragCoord.y * frame.ray_dy.xyz;
    vec3 direction = normalize(ray);
    vec3 radiance = sky_radiance(direction, frame.sun_direction.xyz) + sun_disc(direction, frame.sun_direction.xyz);
    color = display_color(radiance, gl_FragCoord.xy, frame.background);
}
