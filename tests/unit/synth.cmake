ridgeline_test(synth
    SOURCES unit/synth.cpp
    LINKS ridgeline::synth ridgeline::raster ridgeline::jobs GDAL::GDAL
    LABELS unit property)
