// Heights of made tiles as texels: like those of paged ones (io/pager/heights_texels.h), in finer units.
#pragma once

#include "../shared/portable.h"

SHADER_BEGIN

// A texel of one of the source's finest tiles, whose sixteenths are whole quanta, in made tiles' units: 2^shift of them
// to a quantum.
SHADER_FUNCTION int finer_height(int source_texel, int shift) { return (source_texel >> 5) << shift; }

SHADER_FUNCTION int made_texel(int height, bool terrain) { return (height << 1) | (terrain ? 1 : 0); }

// The eye's height in units of which 2^shift are a quantum. Heights over it may wrap around far below a high eye's, and
// are not looked at there.
SHADER_FUNCTION int made_datum(int eye_quanta, int shift) { return int(uint(eye_quanta) << uint(shift)); }

SHADER_FUNCTION int made_height_over(int texel, int datum) { return int(uint(texel >> 1) - uint(datum)); }

SHADER_END
