#version 450 core
// A cell of the quadtree: its vertices' places by their number, heights from cached tiles, watertight
// positions out.
#include "../lib/morph.h"
#include "../lib/quadtree_vertex.h"
#include "../shared/disc_uniforms.h"
#include "../shared/frame_uniforms.h"
#include "../shared/quadtree_blocks.h"

layout(std140, binding = kDiscUniformsBinding) uniform DiscBlock { DiscUniforms disc; };
layout(std430, binding = kHeightFadesBinding) readonly buffer HeightFades { float height_fades[]; };
layout(std430, binding = kQuadtreeInstancesBinding) readonly buffer InstanceBlock {
    QuadtreeInstance quadtree_instances[];
};
layout(std430, binding = kQuadtreeSeamsBinding) readonly buffer SeamBlock { uint quadtree_seams[]; };
#include "../lib/quadtree_seam.h"
layout(binding = kHeightTableUnit) uniform usampler2DArray height_table;
layout(binding = kHeightTilesUnit) uniform isampler2DArray height_tiles;
#include "../lib/disc.h"

layout(location = 2) uniform int quads;  // of a cell's side

invariant gl_Position;

void main() {
    ivec2 at = ivec2(gl_VertexID % (quads + 1), gl_VertexID / (quads + 1));
    QuadtreeInstance cell = quadtree_instances[gl_InstanceID];
    QuadtreeVertex vertex = quadtree_vertex(cell, at, quads);
    vertex.cell = seamed_place(cell, vertex.cell, disc.detail.x, disc.detail.x + disc.table.w);
    precise float height =
        twice_turned_height(disc, vertex.cell, vertex.level, vertex.turned, frame.eye_cell.x);
    precise vec3 position =
        position_from_eye(vertex.cell - disc.eye_cell_and_size.xy, height, frame.eye_rest, frame.scale);
    precise vec4 clip = frame.clip_from_eye * vec4(position, 1.0);
    gl_Position = clip;
}
