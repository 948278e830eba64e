// What the terrain's program knows of one drawn node: attributes that advance once per instance, and the
// table of morph parameters beside them.
#pragma once

#include "portable.h"

SHADER_BEGIN

SHADER_CONSTANT int kMorphTableBinding = 1;
SHADER_CONSTANT int kChunkWordsBinding = 2;
SHADER_CONSTANT int kVertexClasses = 18;

SHADER_CONSTANT int kNormalsUnit = 0;
SHADER_CONSTANT int kNoiseUnit = 1;

// Scale, bias and fade of one vertex class of one node (select::MorphParameters); a node's classes lie
// together.
struct MorphEntry {
    float scale;
    float bias;
    float fade;
};

SHADER_CONSTANT uint kNoMask = 0xffffffffu;

#ifdef __cplusplus
// Vertex attributes of an instance, in this order: place (four ints), sources (four uints), last (two
// floats).
struct TerrainInstance {
    // Finest samples from the eye's cell to the node's north-western corner.
    std::int32_t origin_column = 0;
    std::int32_t origin_row = 0;
    // log2 of the finest samples between two of the node's level.
    std::int32_t step_shift = 0;
    // Where the node's entries start in the morph table.
    std::int32_t first_morph = 0;
    // The squares of own and parent's normals in the texture array: layer << 16 | row << 8 | column.
    uint normals = 0;
    uint parent_normals = 0;
    // The validity mask's first word in the chunk buffer, or kNoMask.
    uint mask_word = kNoMask;
    // Which quarter of its parent the node is.
    uint quarter = 0;
    // The raster's last column and row in cells of the node's level from its corner.
    float last_column = 0.0f;
    float last_row = 0.0f;
};
static_assert(sizeof(TerrainInstance) == 40);
#endif

SHADER_END
