#version 450 core
// A ring of the disc: lattice places in, heights from cached tiles, watertight positions out.
#include "../lib/morph.h"
#include "../shared/disc_uniforms.h"
#include "../shared/frame_uniforms.h"

layout(location = 0) in ivec2 offset;  // from the ring's centre, in its spacings

layout(std140, binding = kDiscUniformsBinding) uniform DiscBlock { DiscUniforms disc; };
layout(std430, binding = kHeightFadesBinding) readonly buffer HeightFades { float height_fades[]; };
layout(binding = kHeightTableUnit) uniform usampler2DArray height_table;
layout(binding = kHeightTilesUnit) uniform isampler2DArray height_tiles;
#include "../lib/disc.h"

layout(location = 2) uniform ivec3 ring;  // the centre's column and row in the ring's spacings; the ring

invariant gl_Position;

void main() {
    ivec2 cell = (ring.xy + offset) << ring.z;
    precise float height = disc_height(disc, cell, ring.z, frame.eye_cell.x);
    precise vec3 position =
        position_from_eye(cell - disc.eye_cell_and_size.xy, height, frame.eye_rest, frame.scale);
    precise vec4 clip = frame.clip_from_eye * vec4(position, 1.0);
    gl_Position = clip;
}
