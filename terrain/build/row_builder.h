// The builder behind its source: what build_terrain does once GDAL has given rows, and what tests give theirs
// to.
#pragma once

#include "ridgeline/build/builder.h"
#include "ridgeline/build/height_rows.h"
#include "ridgeline/build/imagery/texel_rows.h"

namespace ridgeline::build {

// As build_terrain, but sources, imagery, crs and nodata of the options are not looked at. No `imagery`: a
// store without.
Result<BuildReport> build_from_rows(HeightRows& rows, const BuildOptions& options,
                                    TexelRows* imagery = nullptr);

}  // namespace ridgeline::build
