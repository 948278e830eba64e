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
#define HEIGHT_GATHER(corner, slot) heights.gather(corner, slot)
#define HEIGHT_PAGE(at) heights.page(at)
#define HEIGHT_FADE(slot) heights.fade(slot)
#else
#define HEIGHTS_FUNCTION
#define HEIGHTS_PARAMETER
#define HEIGHTS
#define HEIGHT_TEXEL(at, slot) texelFetch(height_tiles, ivec3(at, int(slot)), 0).x
// The four texels that meet at one's north-western corner, as textureGather has them: SW, SE, NE, NW. A coordinate there
// is half a texel from naming others.
#define HEIGHT_GATHER(corner, slot) \
    textureGather(height_tiles, vec3(vec2(corner) / vec2(textureSize(height_tiles, 0).xy), float(slot)))
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

// Whether nodes of the finest level meet at a cell: only there may others have it too.
SHADER_FUNCTION bool on_border(DiscUniforms disc, ivec2 cell) {
    int within = (1 << disc.table.w) - 1;
    return (cell.x & within) == 0 || (cell.y & within) == 0;
}

HEIGHTS_FUNCTION HeightPage height_page(HEIGHTS_PARAMETER DiscUniforms disc, ivec2 cell, int coarseness) {
    ivec2 eye_cell = ivec2(disc.eye_cell_and_size.x, disc.eye_cell_and_size.y);
    HeightPage found;
    found.page = 0u;
    found.node_cell = cell;
    int nodes = on_border(disc, cell) ? 4 : 1;
    for (int i = 0; i < nodes && found.page == 0u; ++i) {
        found.node_cell = cell_of_node(disc, ivec2(cell.x - (i & 1), cell.y - (i >> 1)));
        found.page = HEIGHT_PAGE(window_address(disc.table, eye_cell, found.node_cell, coarseness));
    }
    return found;
}

// A tile as heights over the eye's are read from it.
struct HeightTile {
    uint slot;
    int coarseness;
    int datum;   // the eye's height, in the tile's units
    float unit;  // of them, quanta
};

// Of the source's tiles in sixteenths of a quantum (io/pager/heights_texels.h), of made ones in finer units.
SHADER_FUNCTION HeightTile height_tile(DiscUniforms disc, HeightPage found, int eye_quanta) {
    HeightTile tile;
    tile.slot = page_slot(found.page);
    tile.coarseness = page_coarseness(found.page);
    bool made = tile.coarseness < disc.detail.x;
    tile.datum = made_datum(eye_quanta, made ? disc.detail.y : 4);
    tile.unit = made ? disc.eye.w : 0.0625f;
    return tile;
}

// Quanta from the eye's.
HEIGHTS_FUNCTION float sample_quanta(HEIGHTS_PARAMETER ivec2 at, HeightTile tile) {
    return tile.unit * float(made_height_over(HEIGHT_TEXEL(at, tile.slot), tile.datum));
}

// Between samples the bilinear height.
HEIGHTS_FUNCTION float stored_height(HEIGHTS_PARAMETER DiscUniforms disc, ivec2 cell, HeightPage found,
                                     int eye_quanta) {
    HeightTile tile = height_tile(disc, found, eye_quanta);
    int c = tile.coarseness;
    ivec2 in_tile = tile_cell(disc, cell, found.node_cell, c);
    ivec2 at = ivec2((in_tile.x >> c) + kHeightApron, (in_tile.y >> c) + kHeightApron);
    int east = in_tile.x & ((1 << c) - 1), south = in_tile.y & ((1 << c) - 1);
    float scale = exp2(-float(c));
    float u = float(east) * scale, v = float(south) * scale;
    float height = 0.0f;
    int corners = east == 0 && south == 0 ? 1 : 4;
    for (int i = 0; i < corners; ++i) {
        int column = i & 1, row = i >> 1;
        float share = (column == 0 ? 1.0f - u : u) * (row == 0 ? 1.0f - v : v);
        height += share * sample_quanta(HEIGHTS ivec2(at.x + column, at.y + row), tile);
    }
    return height;
}

// The height of a ring's surface at one of its vertices: of the finest resident tile that is no finer than
// the ring. A tile that came late begins with what is drawn without it. (Loops are branches in software rendering, `if`
// is not: hardly a tile turns, and the others' texels are not read.)
HEIGHTS_FUNCTION float ring_height(HEIGHTS_PARAMETER DiscUniforms disc, ivec2 place, int ring,
                                   int eye_quanta) {
    ivec2 cell = on_lattice(disc, place);
    float height = 0.0f, left = 1.0f;
    for (int coarseness = ring; left > 0.0f;) {
        HeightPage found = height_page(HEIGHTS disc, cell, coarseness);
        if (found.page == 0u) break;
        coarseness = page_coarseness(found.page) + 1;
        float fade = coarseness > disc.table.x ? 0.0f : HEIGHT_FADE(page_slot(found.page));
        height += left * (1.0f - fade) * stored_height(HEIGHTS disc, cell, found, eye_quanta);
        left *= fade;
    }
    return height;
}

// Along which diagonal the next ring's cell is divided that holds a ring's vertex in its middle: 1 from its
// north-western corner, -1 from its north-eastern one. Cells meet in fans, two by two.
SHADER_FUNCTION int coarse_diagonal(ivec2 cell, int ring) {
    int column = cell.x >> (ring + 1), row = cell.y >> (ring + 1);
    return ((column ^ row) & 1) == 0 ? 1 : -1;
}

// From a ring's vertex to one end of the next ring's edge or diagonal on whose middle it lies; the other end is as far on
// the other side. Nothing where the next ring has the vertex too.
SHADER_FUNCTION ivec2 way_to_next_ring(ivec2 cell, int ring) {
    int east = cell.x & (1 << ring), south = cell.y & (1 << ring);
    return ivec2(east, east != 0 && south != 0 ? coarse_diagonal(cell, ring) * south : south);
}

// A ring's height at a vertex, turned by a weight into that of the next ring's triangles there. Exactly one or the
// other where the weight is 0 or 1.
HEIGHTS_FUNCTION float turned_height(HEIGHTS_PARAMETER DiscUniforms disc, ivec2 cell, int ring, float weight,
                                     int eye_quanta) {
    ivec2 way = way_to_next_ring(cell, ring);
    float height = 0.0f;
    // The vertex itself, then the ends, of which there may be one.
    int ends = way.x == 0 && way.y == 0 ? 1 : 2;
    int first = weight >= 1.0f ? 1 : 0, last = weight <= 0.0f ? 0 : ends;
    for (int i = first; i <= last; ++i) {
        float share = i == 0 ? 1.0f - weight : weight / float(ends);
        int side = i == 0 ? 0 : 2 * i - 3;
        ivec2 at = ivec2(cell.x + side * way.x, cell.y + side * way.y);
        height += share * ring_height(HEIGHTS disc, at, i == 0 ? ring : ring + 1, eye_quanta);
    }
    return height;
}

// The same of a weight up to 2: past 1 it is what the next ring's triangles have there, turned by what is more.
HEIGHTS_FUNCTION float twice_turned_height(HEIGHTS_PARAMETER DiscUniforms disc, ivec2 cell, int ring,
                                           float weight, int eye_quanta) {
    int past = weight > 1.0f ? 1 : 0;
    ivec2 way = way_to_next_ring(cell, ring);
    way = ivec2(way.x * past, way.y * past);
    int ends = way.x == 0 && way.y == 0 ? 1 : 2;
    float height = 0.0f;
    for (int i = 0; i < ends; ++i) {
        int side = 2 * i - 1;
        ivec2 at = ivec2(cell.x + side * way.x, cell.y + side * way.y);
        height += turned_height(HEIGHTS disc, at, ring + past, weight - float(past), eye_quanta);
    }
    return height / float(ends);
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

// A quadratic B-spline over three samples, about the middle one: its value and its slope there, by their weights.
struct SplineWeights {
    vec3 value, slope;
};
// past: the place, in samples from the middle one, -0.5 to 0.5.
SHADER_FUNCTION SplineWeights spline_weights(float past) {
    SplineWeights weights;
    weights.value =
        vec3(0.5f * (0.5f - past) * (0.5f - past), 0.75f - past * past, 0.5f * (0.5f + past) * (0.5f + past));
    weights.slope = vec3(past - 0.5f, -2.0f * past, past + 0.5f);
    return weights;
}

// A row of three texels under a spline: value over the datum and slope, in a tile's units.
SHADER_FUNCTION vec2 spline_row(int west, int middle, int east, int datum, SplineWeights weights) {
    vec3 row = vec3(float(made_height_over(west, datum)), float(made_height_over(middle, datum)),
                    float(made_height_over(east, datum)));
    return vec2(dot(weights.value, row), dot(weights.slope, row));
}

// The ground's slopes in quanta a finest sample, eastwards and southwards, and its height in quanta from the
// eye's: of the quadratic B-spline over a tile's samples, which is smooth and needs three by three of them.
HEIGHTS_FUNCTION vec3 slopes_and_height_in(HEIGHTS_PARAMETER DiscUniforms disc, LatticePlace place,
                                           HeightPage found, int eye_quanta) {
    HeightTile tile = height_tile(disc, found, eye_quanta);
    ivec2 in_tile = tile_cell(disc, place.cell, found.node_cell, tile.coarseness);
    float scale = exp2(-float(tile.coarseness));
    vec2 texel = vec2((float(in_tile.x) + place.past.x) * scale, (float(in_tile.y) + place.past.y) * scale);
    ivec2 at = ivec2(int(floor(texel.x + 0.5f)), int(floor(texel.y + 0.5f)));
    SplineWeights across = spline_weights(texel.x - float(at.x)),
                  down = spline_weights(texel.y - float(at.y));
    // Four by four are read, in four looks: cheaper than nine.
    ivec2 corner = ivec2(at.x + kHeightApron, at.y + kHeightApron);
    ivec4 north_west = HEIGHT_GATHER(corner, tile.slot);
    ivec4 north_east = HEIGHT_GATHER(ivec2(corner.x + 1, corner.y), tile.slot);
    ivec4 south_west = HEIGHT_GATHER(ivec2(corner.x, corner.y + 1), tile.slot);
    ivec4 south_east = HEIGHT_GATHER(ivec2(corner.x + 1, corner.y + 1), tile.slot);
    vec2 north = spline_row(north_west.w, north_west.z, north_east.z, tile.datum, across);
    vec2 middle = spline_row(north_west.x, north_west.y, north_east.y, tile.datum, across);
    vec2 south = spline_row(south_west.x, south_west.y, south_east.y, tile.datum, across);
    vec3 values = vec3(north.x, middle.x, south.x), slopes = vec3(north.y, middle.y, south.y);
    return tile.unit *
           vec3(dot(down.value, slopes) * scale, dot(down.slope, values) * scale, dot(down.value, values));
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
