// From a place on the ground to a texel of the imagery that happens to be on the GPU.
//
// Literature: clipmaps (Tanner, Migdal, Jones, "The Clipmap: A Virtual Mipmap", SIGGRAPH 1998) for the
// windows about the eye; sparse virtual textures (Barrett, GDC 2008) for the indirection; the tile scheduling
// paper for what is to be found: the finest resident tile. How we differ: an entry of the page table already
// names the finest tile at or above its node, so one fetch finds it, whatever is missing.
//
// Coarseness counts levels up from the finest: a texel of coarseness c is 2^c finest ones a side. Cells are
// finest texels, columns eastwards and rows southwards; from cells on, places are integers, so nothing swims
// far from the lattice's corner.
#pragma once

#include "../shared/imagery_uniforms.h"
#include "../shared/portable.h"

SHADER_BEGIN

struct ImageryPlace {
    ivec2 cell;
    vec2 past;  // what the place is past the cell's north-western corner, in [0, 1)
};

// metres: east and north of the eye.
SHADER_FUNCTION ImageryPlace imagery_place(ImageryUniforms imagery, vec2 metres) {
    vec4 eye = imagery.eye_rest_and_scale;
    vec2 texels = vec2(eye.x + metres.x * eye.z, eye.y - metres.y * eye.w);
    vec2 whole = floor(texels);
    ImageryPlace place;
    place.cell =
        ivec2(imagery.eye_cell_and_size.x + int(whole.x), imagery.eye_cell_and_size.y + int(whole.y));
    place.past = texels - whole;
    return place;
}

SHADER_FUNCTION bool on_imagery(ImageryUniforms imagery, ivec2 cell) {
    return cell.x >= 0 && cell.y >= 0 && cell.x < imagery.eye_cell_and_size.z &&
           cell.y < imagery.eye_cell_and_size.w;
}

// The coarseness, not whole, whose texels are a pixel wide: across the print of the pixel, and along it
// unless that is longer than `longest` times the width. dx, dy: finest texels from pixel to pixel.
SHADER_FUNCTION float wanted_coarseness(vec2 dx, vec2 dy, float longest) {
    float x = dot(dx, dx), y = dot(dy, dy);
    float longer = max(x, y), shorter = min(x, y);
    // At most what integers hold: of a triangle seen on edge, prints are of any size, or not numbers.
    return 0.5f * log2(clamp(max(shorter, longer / (longest * longest)), 1.0e-12f, 1.0e18f));
}

// What is left of a print where the coarseness was limited: of a triangle seen on edge it is without bounds,
// and would be a speck in the mean colour of half the land. The factor for dx and dy.
SHADER_FUNCTION float print_share(vec2 dx, vec2 dy, float coarseness, float longest) {
    float longer = max(max(length(dx), length(dy)), 1.0e-6f);
    return min(1.0f, longest * exp2(coarseness) / longer);
}

// The lookups that the shader lays along a pixel's print where the sampler cannot: how many, and the way from
// the first to the next, in finest texels. Each looks at a round part of the print.
struct ImageryPrint {
    int taps;
    vec2 step;
    float width;  // of the parts, finest texels
};

SHADER_FUNCTION ImageryPrint imagery_print(vec2 dx, vec2 dy, vec2 filtering) {
    float x = length(dx), y = length(dy);
    float longer = max(x, y), shorter = max(min(x, y), 1.0e-6f);
    float ratio = clamp(longer / shorter, 1.0f, filtering.x);
    ImageryPrint print;
    // A quarter longer than wide is round enough.
    print.taps = clamp(int(ceil(ratio - 0.25f)), 1, int(filtering.y));
    print.step = (x >= y ? dx : dy) / float(print.taps);
    print.width = longer / ratio;
    return print;
}

// The page table's windows hold, of every level, the nodes about the eye's. The least coarseness at which the
// window surely holds a place so many cells away, window_bits being the log2 of its side: nodes up to a
// quarter of the side away are in it, wherever in its node the eye stands.
SHADER_FUNCTION int window_coarseness(int cells, int window_bits, int tile_bits) {
    return findMSB(cells) + 1 - tile_bits - (window_bits - 2);
}

// Where to look a place up: column, row and layer of the page table; the level is its layer. At the coarsest
// level the window holds everything.
// eye_cell: about which the windows are. table: the finest level, log2 of a window's columns and rows, log2
// of a tile's finest texels.
SHADER_FUNCTION ivec3 window_address(ivec4 table, ivec2 eye_cell, ivec2 cell, int coarseness) {
    int across = abs(cell.x - eye_cell.x), down = abs(cell.y - eye_cell.y);
    int in_window =
        max(window_coarseness(across, table.y, table.w), window_coarseness(down, table.z, table.w));
    int c = clamp(max(coarseness, in_window), 0, table.x);
    int shift = table.w + c;
    return ivec3((cell.x >> shift) & ((1 << table.y) - 1), (cell.y >> shift) & ((1 << table.z) - 1),
                 table.x - c);
}

SHADER_FUNCTION ivec3 page_address(ImageryUniforms imagery, ivec2 cell, float coarseness) {
    ivec4 table = ivec4(imagery.table.x, imagery.table.y, imagery.table.z, kTileTexelBits);
    ivec2 eye_cell = ivec2(imagery.eye_cell_and_size.x, imagery.eye_cell_and_size.y);
    return window_address(table, eye_cell, cell, int(floor(coarseness)));
}

// One texture lookup: layer of the array, coordinates in it, and the factor that makes finest texels from
// pixel to pixel gradients of it.
struct ImageryTap {
    vec2 at;
    float gradient;
    float layer;
};

SHADER_FUNCTION int page_coarseness(uint page) { return int(page >> uint(kPageCoarsenessShift)); }
SHADER_FUNCTION uint page_slot(uint page) { return (page & kPageSlotMask) - 1u; }

// A tile that came late is shown no sharper than its parent at first: blur is 1 then, which makes it the
// texture's mip 1, and falls to 0. The page must name a tile; coarseness as it was wanted.
SHADER_FUNCTION ImageryTap imagery_tap(ImageryPlace place, uint page, float coarseness, float blur) {
    int c = page_coarseness(page);
    float scale = exp2(-float(c));
    int in_tile = (1 << (kTileTexelBits + c)) - 1;
    vec2 cell = vec2(float(place.cell.x & in_tile), float(place.cell.y & in_tile));
    vec2 texel = (cell + place.past) * scale;
    float mip = coarseness - float(c);
    float blurred = blur > 0.0f ? max(blur - mip, 0.0f) : 0.0f;
    // Past mip 1 there is nothing coarser; longer steps would only lead out of the tile.
    float limited = max(mip - 1.0f, 0.0f);
    ImageryTap tap;
    tap.at = (texel + kTileGutter) / kTileSide;
    tap.gradient = scale * exp2(blurred - limited) / kTileSide;
    tap.layer = float(page_slot(page));
    return tap;
}

SHADER_END
