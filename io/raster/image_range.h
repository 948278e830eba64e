// Which values of pictures that are not of bytes are black and which are white.
#pragma once

#include <gdal.h>

#include <string>
#include <vector>

#include "image_file.h"

namespace ridgeline::raster {

// From values sampled all over the pictures, in any order. What looks like bytes, like fractions, or fills
// its type is taken at its word; else all but the darkest and the brightest half percent spread over the
// range.
ValueRange choose_range(std::vector<double> values, GDALDataType type);

// "values 512 to 14200 become black to white".
std::string described(const ValueRange& range);

}  // namespace ridgeline::raster
