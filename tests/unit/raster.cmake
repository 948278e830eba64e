ridgeline_test(raster_values
    SOURCES unit/raster_values.cpp
    LINKS ridgeline::raster GDAL::GDAL
    LABELS unit)
ridgeline_test(raster_crs_name
    SOURCES unit/raster_crs_name.cpp
    LINKS ridgeline::raster GDAL::GDAL
    LABELS unit)
ridgeline_test(raster_places
    SOURCES unit/raster_places.cpp
    LINKS ridgeline::raster GDAL::GDAL
    LABELS unit)
ridgeline_test(raster_warp
    SOURCES unit/raster_warp.cpp
    LINKS ridgeline::raster GDAL::GDAL
    LABELS unit property)
ridgeline_test(raster_damage
    SOURCES unit/raster_damage.cpp
    LINKS ridgeline::raster GDAL::GDAL
    LABELS unit)
ridgeline_test(raster_image
    SOURCES unit/raster_image.cpp
    LINKS ridgeline::raster GDAL::GDAL
    LABELS unit property)
