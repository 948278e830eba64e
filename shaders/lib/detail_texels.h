// Heights of made tiles as texels: like those of paged ones (io/pager/heights_texels.h), in finer units.
#pragma once

#include "../shared/portable.h"

SHADER_BEGIN

// A texel of one of the source's finest tiles, whose sixteenths are whole quanta, in made tiles' units: 2^shift of them
// to a quantum.
SHADER_FUNCTION int finer_height(int source_texel, int shift) { return (source_texel >> 5) << shift; }

SHADER_FUNCTION int made_texel(int height, bool terrain) { return (height << 1) | (terrain ? 1 : 0); }

// Heights over the eye's, in units; heights far below a high eye's may wrap around, and are not looked at.
SHADER_FUNCTION int made_height_over(int texel, int eye_quanta, int shift) {
    return int(uint(texel >> 1) - (uint(eye_quanta) << uint(shift)));
}

SHADER_END
