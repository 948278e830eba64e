ridgeline_test(shader_cpu_terrain SOURCES shader_cpu/terrain.cpp shader_cpu/virtual_texture.cpp LINKS ridgeline::shaders ridgeline::select LABELS unit)
ridgeline_test(shader_cpu_bc1 SOURCES shader_cpu/bc1.cpp LINKS ridgeline::shaders ridgeline::build LABELS unit)
