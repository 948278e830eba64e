#version 450 core
// Shadow maps hold depth alone. RIDGELINE_CUT: for nodes with holes or past the raster's border, which let
// the sun through there.
#include "../lib/validity.h"

layout(location = 0) in vec3 texel_and_weight;
layout(location = 1) flat in uvec4 node_sources;
layout(location = 2) flat in vec2 node_last;

layout(location = 0) uniform int quads;

void main() {
#ifdef RIDGELINE_CUT
    if (!terrain_at(texel_and_weight.xy, node_sources.z, node_last, quads)) discard;
#endif
}
