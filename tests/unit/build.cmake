ridgeline_test(build
    SOURCES unit/build_cones.cpp unit/build_errors.cpp unit/build_fill.cpp unit/build_memory.cpp unit/build_places.cpp
            unit/build_store.cpp
    LINKS ridgeline::build
    LABELS unit property
    TIMEOUT 900)
# The one case that is about threads, for the thread sanitizer in CI: the rest takes it minutes.
add_test(NAME build_threads COMMAND test_build --test-case=*number?of?threads*)
set_tests_properties(build_threads PROPERTIES LABELS "property;threads" TIMEOUT 900)

ridgeline_test(build_imagery
    SOURCES unit/build_imagery_store.cpp unit/build_imagery_tiles.cpp
    LINKS ridgeline::build
    LABELS unit property threads)
