# Shared structs and functions, compiled as C++: each header alone, so that none leans on what another includes.
get_target_property(shader_headers ridgeline_shaders RIDGELINE_SHADER_HEADERS)
set(header_sources)
foreach(header IN LISTS shader_headers)
    string(MAKE_C_IDENTIFIER ${header} name)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/shader_cpu/${name}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "#include \"ridgeline/shaders/${header}\"\n")
    list(APPEND header_sources ${source})
endforeach()
ridgeline_test(shader_cpu SOURCES shader_cpu/color.cpp shader_cpu/fullscreen.cpp shader_cpu/ground_cells.cpp ${header_sources}
               LINKS ridgeline::shaders ridgeline::select LABELS unit)
