ridgeline_test(io
    SOURCES unit/io_grid.cpp unit/io_heights.cpp unit/io_chunk.cpp unit/io_imagery.cpp unit/io_terrain_info.cpp unit/io_damage.cpp unit/io_mapped_file.cpp
            unit/io_pending.cpp unit/io_relief.cpp support/sealed_json.cpp
    LINKS ridgeline::io nlohmann_json::nlohmann_json
    LABELS unit)
