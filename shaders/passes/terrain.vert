#version 450 core
// Chunks of the mesh surface: integers in, watertight positions out. One instance a node.
// RIDGELINE_SHADOW_MAP: the same positions as the sun sees them, for one cascade of its shadow maps.
#include "../lib/morph.h"
#include "../shared/frame_uniforms.h"
#include "../shared/shadow_uniforms.h"
#include "../shared/terrain_instance.h"

layout(location = 0) in uvec4 vertex;           // class << 24 | column, row, quanta, delta (chunk.h)
layout(location = 1) in ivec4 instance_place;   // origin column, row; step shift; first morph entry
layout(location = 2) in uvec4 instance_sources; // normals, parent's, mask word, quarter
layout(location = 3) in vec2 instance_last;

layout(std430, binding = kMorphTableBinding) readonly buffer MorphTable { MorphEntry morph_table[]; };

#ifdef RIDGELINE_SHADOW_MAP
layout(location = 1) uniform int cascade;
#endif

layout(location = 0) out vec3 texel_and_weight;
layout(location = 1) flat out uvec4 node_sources;
layout(location = 2) flat out vec2 node_last;

invariant gl_Position;

void main() {
    ivec2 offset = ivec2(int(vertex.x & 0xffffffu), int(vertex.y));
    ivec2 lattice = instance_place.xy + (offset << frame.eye_cell.y);
    int quanta = int(vertex.z) - frame.eye_cell.x;
    precise vec3 own = position_from_eye(lattice, float(quanta), frame.eye_rest, frame.scale);
    MorphEntry entry = morph_table[instance_place.w + int(vertex.x >> 24u)];
    precise float weight = morph_weight(entry, distance_from_eye(own));
    precise float height = morphed_quanta(quanta, int(vertex.w), weight);
    precise vec3 position = position_from_eye(lattice, height, frame.eye_rest, frame.scale);
#ifdef RIDGELINE_SHADOW_MAP
    gl_Position = shadows.cascades[cascade].map_from_eye * vec4(position, 1.0);
#else
    precise vec4 clip = frame.clip_from_eye * vec4(position, 1.0);
    gl_Position = clip;
#endif
    texel_and_weight = vec3(vec2(offset) * exp2(-float(instance_place.z)), weight);
    node_sources = instance_sources;
    node_last = instance_last;
}
