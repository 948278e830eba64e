#version 450 core
// The ground's colour. RIDGELINE_CUT: for nodes with holes or past the raster's border, where fragments are dropped.
#include "../lib/display.h"
#include "../lib/terrain_shading.h"
#include "../lib/validity.h"

layout(location = 0) in vec3 texel_and_weight;
layout(location = 1) flat in uvec4 node_sources;
#ifdef RIDGELINE_CUT
layout(location = 2) flat in vec2 node_last;
layout(std430, binding = kChunkWordsBinding) readonly buffer ChunkWords { uint chunk_words[]; };
#endif

layout(binding = kNormalsUnit) uniform sampler2DArray normals;
layout(binding = kNoiseUnit) uniform sampler2D noise;

layout(location = 0) uniform int quads;

layout(location = 0) out vec4 color;

#ifdef RIDGELINE_CUT
bool terrain_here() {
    uint mask_word = node_sources.z;
    int cell = cell_at(texel_and_weight.xy, quads);
    bool valid = mask_word == kNoMask || cell_bit(chunk_words[mask_word + uint(cell >> 5)], cell);
    return valid && inside_raster(texel_and_weight.xy, node_last);
}
#endif

vec2 normal_pair(uint place, vec2 texel) {
    NormalTexels at = normal_texels(place, texel, quads);
    vec2 north_west = texelFetch(normals, at.north_west, 0).xy;
    vec2 north_east = texelFetch(normals, at.north_west + ivec3(1, 0, 0), 0).xy;
    vec2 south_west = texelFetch(normals, at.north_west + ivec3(0, 1, 0), 0).xy;
    vec2 south_east = texelFetch(normals, at.north_west + ivec3(1, 1, 0), 0).xy;
    return mix(mix(north_west, north_east, at.share.x), mix(south_west, south_east, at.share.x), at.share.y);
}

GroundPoint ground_point() {
    vec2 own = normal_pair(node_sources.x, texel_and_weight.xy);
    vec2 parent = normal_pair(node_sources.y, parent_texel(texel_and_weight.xy, node_sources.w, quads));
    vec3 ray = frame.ray_origin.xyz + gl_FragCoord.x * frame.ray_dx.xyz + gl_FragCoord.y * frame.ray_dy.xyz;
    vec3 position = ray / gl_FragCoord.w;
    // One mip level finer than the pixel: ground seen at a glancing angle would be a blur otherwise.
    vec3 fine = texture(noise, position.xy * frame.noise_scale.x + frame.noise_offset.xy, -1.0).xyz;
    vec3 broad = texture(noise, position.xy * frame.noise_scale.y + frame.noise_offset.zw, -1.0).xyz;
    vec3 normal = unpack_normal(mix(own, parent, texel_and_weight.z));
    return GroundPoint(position, normal, fine, broad);
}

void main() {
#ifdef RIDGELINE_CUT
    if (!terrain_here()) discard;
#endif
    color = display_color(ground_radiance(frame, ground_point()), gl_FragCoord.xy, frame.background);
}
