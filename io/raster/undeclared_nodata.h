// Nodata that a file uses without declaring it: a customary value far below everything else that the band
// holds.
#pragma once

#include <gdal_priv.h>

#include <optional>

namespace ridgeline::raster {

// -9999, -32767, -32768: what files use for nodata, declared or not.
bool is_customary_nodata(double stored);

// Looked for in all rows of small bands and in some of large ones; in stored units. A value that cannot be
// read here is left to those who read the band to its end.
std::optional<double> undeclared_nodata(GDALRasterBand& band);

}  // namespace ridgeline::raster
