ridgeline_test(detail_tile SOURCES unit/detail_tile.cpp LINKS ridgeline::detail LABELS unit property)
# Decimated rasters against what they were before: long, and over code that other suites run.
ridgeline_test(detail_statistics SOURCES unit/detail_statistics.cpp
               LINKS ridgeline::app ridgeline::build ridgeline::select ridgeline::synth GDAL::GDAL LABELS unit property statistics)
