// Where a vertex stands: geomorphing between its own height and its parent surface's, and the way from
// integer lattice coordinates to metres from the eye.
//
// A shared vertex must come out bit for bit the same from every node that draws it, or the surface cracks. So
// all arithmetic that depends on the node is done in integers; what follows uses only numbers that both nodes
// have, in this order, without contraction. (gpu-quadtree paper, eq. 4-6: B' = B - w * dB.)
#pragma once

#include "../shared/portable.h"
#include "../shared/terrain_instance.h"

SHADER_BEGIN

// Forced to 0: all zero; forced to 1: a bias of 1.
SHADER_FUNCTION float morph_weight(MorphEntry entry, float distance_m) {
    SHADER_PRECISE float ramp = distance_m * entry.scale;
    ramp = ramp + entry.bias;
    return max(clamp(ramp, 0.0f, 1.0f), entry.fade);
}

// Quanta from the camera's cell; exact where w is 0 or 1.
SHADER_FUNCTION float morphed_quanta(int quanta_from_cell, int delta, float weight) {
    SHADER_PRECISE float shift = weight * float(delta);
    shift = float(quanta_from_cell) + shift;
    return shift;
}

// lattice_from_cell: columns, rows (southwards) from the camera's cell. eye_rest and scale as in
// FrameUniforms.
SHADER_FUNCTION vec3 position_from_eye(ivec2 lattice_from_cell, float quanta_from_cell, vec4 eye_rest,
                                       vec4 scale) {
    SHADER_PRECISE float east = float(lattice_from_cell.x) - eye_rest.x;
    SHADER_PRECISE float south = float(lattice_from_cell.y) - eye_rest.y;
    SHADER_PRECISE float up = quanta_from_cell - eye_rest.z;
    east = east * scale.x;
    south = south * scale.y;
    up = up * scale.z;
    return vec3(east, -south, up);
}

// Not length(): its expansion is the compiler's choice.
SHADER_FUNCTION float distance_from_eye(vec3 position_m) {
    SHADER_PRECISE float squared = position_m.x * position_m.x;
    SHADER_PRECISE float y_squared = position_m.y * position_m.y;
    SHADER_PRECISE float z_squared = position_m.z * position_m.z;
    squared = squared + y_squared;
    squared = squared + z_squared;
    return sqrt(squared);
}

SHADER_END
