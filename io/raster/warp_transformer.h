// The map from a raster's pixels to those of a grid in another CRS, as GDAL's warper wants it.
#pragma once

#include <gdal_alg.h>

#include <memory>

#include "placement.h"

namespace ridgeline::raster {

struct DestroyTransformer {
    void operator()(void* transformer) const { GDALDestroyTransformer(transformer); }
};
using Transformer = std::unique_ptr<void, DestroyTransformer>;

// From the dataset's pixels to the plane of `to`; null where there is no such map.
Transformer make_transformer(GDALDataset& source, const OGRSpatialReference& from,
                             const OGRSpatialReference& to);

// The same to the pixels of `target`, many times faster and hardly less exact.
Transformer approximated(Transformer exact, const Placement& target);

}  // namespace ridgeline::raster
