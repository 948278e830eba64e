ridgeline_test(golden_pictures SOURCES golden/pictures.cpp
               LINKS ridgeline::app ridgeline::build ridgeline::raster GDAL::GDAL LABELS gl golden)
target_include_directories(test_golden_pictures SYSTEM PRIVATE ${STB_INCLUDE_DIR})
