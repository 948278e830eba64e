ridgeline_test(app_options SOURCES unit/app_options.cpp LINKS ridgeline::app LABELS unit)
ridgeline_test(app_progress SOURCES unit/app_progress.cpp LINKS ridgeline::app LABELS unit)

# Black-box tests of the built program.
foreach(name app_usage)
    ridgeline_test(${name} SOURCES unit/${name}.cpp LINKS ridgeline::base LABELS unit)
    target_compile_definitions(test_${name} PRIVATE RIDGELINE_PROGRAM="$<TARGET_FILE:ridgeline>")
    add_dependencies(test_${name} ridgeline)
endforeach()
