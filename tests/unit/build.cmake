ridgeline_test(build
    SOURCES unit/build_cones.cpp unit/build_errors.cpp unit/build_fill.cpp unit/build_memory.cpp unit/build_places.cpp
            unit/build_store.cpp
    LINKS ridgeline::build
    LABELS unit property
    TIMEOUT 900)
