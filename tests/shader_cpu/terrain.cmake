ridgeline_test(shader_cpu_terrain SOURCES shader_cpu/terrain.cpp LINKS ridgeline::shaders ridgeline::select LABELS unit)
