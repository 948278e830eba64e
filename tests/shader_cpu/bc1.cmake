ridgeline_test(shader_cpu_bc1 SOURCES shader_cpu/bc1.cpp LINKS ridgeline::shaders ridgeline::build GDAL::GDAL LABELS unit property)
