// The disc's vertices: where they stand on the lattice, how high, and what the ground's normal is there.
//
// Literature: the circular grid that samples cached heights (scheduling paper, 3.3); rings of doubling
// spacing that turn into each other (Losasso, Hoppe, "Geometry clipmaps", SIGGRAPH 2004). How we differ:
// docs/disc.md.
//
// Ring k has vertices at every 2^k-th sample. Heights come from integers and depend on nothing but the
// vertex's place and the ring, so a vertex that two rings share is the same in both. Coarseness, pages and
// windows: virtual_texture.h. Heights are quanta from the eye's.
#pragma once

#include "../shared/disc_uniforms.h"
#include "detail_texels.h"
#include "virtual_texture.h"

// Where texels, pages and fades come from: in GLSL textures of these names, in C++ an object with functions
// of these names.
#ifdef __cplusplus
#define HEIGHTS_FUNCTION     \
    template <class Heights> \
    inline
#define HEIGHTS_PARAMETER const Heights &heights,
#define HEIGHTS heights,
#define HEIGHT_TEXEL(at, slot) heights.texel(at, slot)
#define HEIGHT_PAGE(at) heights.page(at)
#define HEIGHT_FADE(slot) heights.fade(slot)
#else
#define HEIGHTS_FUNCTION
#define HEIGHTS_PARAMETER
#define HEIGHTS
#define HEIGHT_TEXEL(at, slot) texelFetch(height_tiles, ivec3(at, int(slot)), 0).x
#define HEIGHT_PAGE(at) texelFetch(height_table, at, 0).x
#define HEIGHT_FADE(slot) height_fades[slot]
#endif

SHADER_BEGIN

// How much of the next ring's surface a vertex has: 1 on a ring's border, 0 on the next ring's inner one.
// spacings: from the eye, with its height over the ground.
SHADER_FUNCTION float ring_weight(float spacings) {
    return clamp((spacings - kDiscMorphStart) / (kDiscMorphEnd - kDiscMorphStart), 0.0f, 1.0f);
}

SHADER_FUNCTION float ring_distance(DiscUniforms disc, ivec2 cell, int ring) {
    float east = float(cell.x - disc.eye_cell_and_size.x) - disc.middle.x;
    float south = float(cell.y - disc.eye_cell_and_size.y) - disc.middle.y;
    return sqrt(east * east + south * south + disc.middle.z * disc.middle.z) * exp2(-float(ring));
}

// The same place moved onto the lattice.
SHADER_FUNCTION ivec2 on_lattice(DiscUniforms disc, ivec2 cell) {
    return ivec2(clamp(cell.x, 0, disc.eye_cell_and_size.z - 1),
                 clamp(cell.y, 0, disc.eye_cell_and_size.w - 1));
}

// The cell whose node holds a place's height: nodes share borders, and the last has none beyond it. tile_cell
// counts from the node's corner.
SHADER_FUNCTION ivec2 cell_of_node(DiscUniforms disc, ivec2 cell) {
    return ivec2(clamp(cell.x, 0, disc.eye_cell_and_size.z - 2),
                 clamp(cell.y, 0, disc.eye_cell_and_size.w - 2));
}

SHADER_FUNCTION ivec2 tile_cell(DiscUniforms disc, ivec2 cell, ivec2 node_cell, int coarseness) {
    int shift = disc.table.w + coarseness;
    return ivec2(cell.x - ((node_cell.x >> shift) << shift), cell.y - ((node_cell.y >> shift) << shift));
}

// The finest resident tile at or above a coarseness that has a cell's height, and the cell by which it was
// found. A place on a border is in several nodes, of which some may hold no ground.
struct HeightPage {
    uint page;
    ivec2 node_cell;
};

HEIGHTS_FUNCTION HeightPage height_page(HEIGHTS_PARAMETER DiscUniforms disc, ivec2 cell, int coarseness) {
    ivec2 eye_cell = ivec2(disc.eye_cell_and_size.x, disc.eye_cell_and_size.y);
    HeightPage found;
    found.page = 0u;
    found.node_cell = cell;
    for (int i = 0; i < 4 && found.page == 0u; ++i) {
        found.node_cell = cell_of_node(disc, ivec2(cell.x - (i & 1), cell.y - (i >> 1)));
        found.page = HEIGHT_PAGE(window_address(disc.table, eye_cell, found.node_cell, coarseness));
    }
    return found;
}

// A tile: its slot, and its texels' coarseness.
struct HeightTile {
    uint slot;
    int coarseness;
};

// Quanta from the eye's: of the source's tiles in sixteenths (io/pager/heights_texels.h), of made ones in finer units.
HEIGHTS_FUNCTION float sample_quanta(HEIGHTS_PARAMETER DiscUniforms disc, ivec2 at, HeightTile tile,
                                     int eye_quanta) {
    int texel = HEIGHT_TEXEL(at, tile.slot);
    if (tile.coarseness >= disc.detail.x) return 0.0625f * float((texel >> 1) - 16 * eye_quanta);
    return disc.eye.w * float(made_height_over(texel, eye_quanta, disc.detail.y));
}

// Between samples the bilinear height.
HEIGHTS_FUNCTION float stored_height(HEIGHTS_PARAMETER DiscUniforms disc, ivec2 cell, HeightPage found,
                                     int eye_quanta) {
    int c = page_coarseness(found.page);
    HeightTile tile;
    tile.slot = page_slot(found.page);
    tile.coarseness = c;
    ivec2 in_tile = tile_cell(disc, cell, found.node_cell, c);
    ivec2 at = ivec2((in_tile.x >> c) + kHeightApron, (in_tile.y >> c) + kHeightApron);
    int east = in_tile.x & ((1 << c) - 1), south = in_tile.y & ((1 << c) - 1);
    float north_west = sample_quanta(HEIGHTS disc, at, tile, eye_quanta);
    if (east == 0 && south == 0) return north_west;
    float north_east = sample_quanta(HEIGHTS disc, ivec2(at.x + 1, at.y), tile, eye_quanta);
    float south_west = sample_quanta(HEIGHTS disc, ivec2(at.x, at.y + 1), tile, eye_quanta);
    float south_east = sample_quanta(HEIGHTS disc, ivec2(at.x + 1, at.y + 1), tile, eye_quanta);
    float scale = exp2(-float(c));
    float u = float(east) * scale, v = float(south) * scale;
    return mix(mix(north_west, north_east, u), mix(south_west, south_east, u), v);
}

// The height of a ring's surface at one of its vertices: of the finest resident tile that is no finer than
// the ring. A tile that came late begins with its parent's height.
HEIGHTS_FUNCTION float ring_height(HEIGHTS_PARAMETER DiscUniforms disc, ivec2 place, int ring,
                                   int eye_quanta) {
    ivec2 cell = on_lattice(disc, place);
    HeightPage found = height_page(HEIGHTS disc, cell, ring);
    if (found.page == 0u) return 0.0f;
    float height = stored_height(HEIGHTS disc, cell, found, eye_quanta);
    float fade = HEIGHT_FADE(page_slot(found.page));
    if (fade <= 0.0f) return height;
    HeightPage parent = height_page(HEIGHTS disc, cell, page_coarseness(found.page) + 1);
    return mix(height, stored_height(HEIGHTS disc, cell, parent, eye_quanta), fade);
}

// Along which diagonal the next ring's cell is divided that holds a ring's vertex in its middle: 1 from its
// north-western corner, -1 from its north-eastern one. Cells meet in fans, two by two.
SHADER_FUNCTION int coarse_diagonal(ivec2 cell, int ring) {
    int column = cell.x >> (ring + 1), row = cell.y >> (ring + 1);
    return ((column ^ row) & 1) == 0 ? 1 : -1;
}

// The height of the next ring's triangles at a ring's vertex.
HEIGHTS_FUNCTION float next_ring_height(HEIGHTS_PARAMETER DiscUniforms disc, ivec2 cell, int ring,
                                        int eye_quanta) {
    int east = cell.x & (1 << ring), south = cell.y & (1 << ring);
    if (east == 0 && south == 0) return ring_height(HEIGHTS disc, cell, ring + 1, eye_quanta);
    int turned = east != 0 && south != 0 ? coarse_diagonal(cell, ring) : 1;
    ivec2 way = ivec2(east, turned * south);
    float one = ring_height(HEIGHTS disc, ivec2(cell.x - way.x, cell.y - way.y), ring + 1, eye_quanta);
    float other = ring_height(HEIGHTS disc, ivec2(cell.x + way.x, cell.y + way.y), ring + 1, eye_quanta);
    return 0.5f * (one + other);
}

// Exactly one ring's or the next one's where the weight is 0 or 1.
HEIGHTS_FUNCTION float turned_height(HEIGHTS_PARAMETER DiscUniforms disc, ivec2 cell, int ring, float weight,
                                     int eye_quanta) {
    if (weight >= 1.0f) return next_ring_height(HEIGHTS disc, cell, ring, eye_quanta);
    float own = ring_height(HEIGHTS disc, cell, ring, eye_quanta);
    if (weight <= 0.0f) return own;
    return mix(own, next_ring_height(HEIGHTS disc, cell, ring, eye_quanta), weight);
}

HEIGHTS_FUNCTION float disc_height(HEIGHTS_PARAMETER DiscUniforms disc, ivec2 cell, int ring,
                                   int eye_quanta) {
    return turned_height(HEIGHTS disc, cell, ring, ring_weight(ring_distance(disc, cell, ring)), eye_quanta);
}

// --- for fragments

// A place on the ground: the sample to its north-west, and what it is past that, in samples.
struct LatticePlace {
    ivec2 cell;
    vec2 past;
};

// metres: east and north of the eye. spacing: of samples.
SHADER_FUNCTION LatticePlace lattice_place(DiscUniforms disc, vec2 metres, vec2 spacing) {
    vec2 samples = vec2(disc.eye.x + metres.x / spacing.x, disc.eye.y - metres.y / spacing.y);
    vec2 whole = floor(samples);
    LatticePlace place;
    place.cell = ivec2(disc.eye_cell_and_size.x + int(whole.x), disc.eye_cell_and_size.y + int(whole.y));
    place.past = samples - whole;
    return place;
}

SHADER_FUNCTION bool inside_lattice(DiscUniforms disc, LatticePlace place) {
    // The far border itself is inside.
    vec2 east_south = vec2(float(disc.eye_cell_and_size.z - 1 - place.cell.x) - place.past.x,
                           float(disc.eye_cell_and_size.w - 1 - place.cell.y) - place.past.y);
    return place.cell.x >= 0 && place.cell.y >= 0 && east_south.x >= 0.0f && east_south.y >= 0.0f;
}

// Whether the cell by which a page was found is terrain, by the finest resident tile at or above a coarseness.
HEIGHTS_FUNCTION bool terrain_in(HEIGHTS_PARAMETER DiscUniforms disc, HeightPage found) {
    int c = page_coarseness(found.page);
    ivec2 in_tile = tile_cell(disc, found.node_cell, found.node_cell, c);
    ivec2 at = ivec2((in_tile.x >> c) + kHeightApron, (in_tile.y >> c) + kHeightApron);
    return (HEIGHT_TEXEL(at, page_slot(found.page)) & 1) != 0;
}

// The ground's slopes in quanta a finest sample, eastwards and southwards, and its height in quanta from the
// eye's: of the quadratic B-spline over a tile's samples, which is smooth and needs three by three of them.
HEIGHTS_FUNCTION vec3 slopes_and_height_in(HEIGHTS_PARAMETER DiscUniforms disc, LatticePlace place,
                                           HeightPage found, int eye_quanta) {
    int c = page_coarseness(found.page);
    HeightTile tile;
    tile.slot = page_slot(found.page);
    tile.coarseness = c;
    ivec2 in_tile = tile_cell(disc, place.cell, found.node_cell, c);
    float scale = exp2(-float(c));
    vec2 texel = vec2((float(in_tile.x) + place.past.x) * scale, (float(in_tile.y) + place.past.y) * scale);
    ivec2 at = ivec2(int(floor(texel.x + 0.5f)), int(floor(texel.y + 0.5f)));
    float u = texel.x - float(at.x), v = texel.y - float(at.y);
    vec3 across = vec3(0.5f * (0.5f - u) * (0.5f - u), 0.75f - u * u, 0.5f * (0.5f + u) * (0.5f + u));
    vec3 down = vec3(0.5f * (0.5f - v) * (0.5f - v), 0.75f - v * v, 0.5f * (0.5f + v) * (0.5f + v));
    vec3 along_x = vec3(u - 0.5f, -2.0f * u, u + 0.5f), along_y = vec3(v - 0.5f, -2.0f * v, v + 0.5f);
    vec3 sum = vec3(0.0f, 0.0f, 0.0f);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x) {
            ivec2 sample_at = ivec2(at.x + x - 1 + kHeightApron, at.y + y - 1 + kHeightApron);
            float height = sample_quanta(HEIGHTS disc, sample_at, tile, eye_quanta);
            sum = sum +
                  vec3(along_x[x] * down[y] * scale, across[x] * along_y[y] * scale, across[x] * down[y]) *
                      height;
        }
    return sum;
}

// Where samples are this many pixels apart, the next level takes over: what the schedule pages.
SHADER_CONSTANT float kNormalPixels = 1.0f;
// The same of made levels: what nobody has measured need not be lit pixel by pixel, and takes a ninth of the tiles.
SHADER_CONSTANT float kMadePixels = 3.0f;

// The levels that a place at a distance is shaded by: their coarseness, not whole.
SHADER_FUNCTION float shading_coarseness(DiscUniforms disc, float distance_m) {
    float samples = disc.eye.z * distance_m;
    float source = log2(kNormalPixels * samples), made = float(disc.detail.x);
    if (source >= made) return max(source, 0.0f);
    return clamp(log2(kMadePixels * samples), 0.0f, made);
}

SHADER_END
