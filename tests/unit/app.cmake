foreach(name app_options app_progress app_walk_options)
    ridgeline_test(${name} SOURCES unit/${name}.cpp LINKS ridgeline::app LABELS unit)
endforeach()

ridgeline_test(app_bench
    SOURCES unit/app_bench.cpp
    LINKS ridgeline::app ridgeline::build nlohmann_json::nlohmann_json
    LABELS unit)

ridgeline_test(app_stress_paths SOURCES unit/app_stress_paths.cpp LINKS ridgeline::app LABELS unit property)
ridgeline_test(app_soak SOURCES unit/app_soak.cpp LINKS ridgeline::app LABELS unit property)
ridgeline_test(app_clipmap SOURCES unit/app_clipmap.cpp LINKS ridgeline::app LABELS unit property)

ridgeline_test(app_bench_imagery SOURCES unit/app_bench_imagery.cpp LINKS ridgeline::app ridgeline::build LABELS unit)
ridgeline_test(app_oracle
    SOURCES unit/app_oracle.cpp unit/select_scene.cpp
    LINKS ridgeline::app
    LABELS unit property)

foreach(name app_report_charts app_report_page app_report_tables)
    ridgeline_test(${name} SOURCES unit/${name}.cpp LINKS ridgeline::app nlohmann_json::nlohmann_json LABELS unit property)
endforeach()

# Black-box tests of the built program.
foreach(name app_disk_full app_kills app_report app_store app_unreadable app_usage)
    ridgeline_test(${name} SOURCES unit/${name}.cpp LINKS ridgeline::base nlohmann_json::nlohmann_json LABELS unit)
    target_compile_definitions(test_${name} PRIVATE RIDGELINE_PROGRAM="$<TARGET_FILE:ridgeline>")
    add_dependencies(test_${name} ridgeline)
endforeach()

ridgeline_test(app_reference SOURCES unit/app_reference.cpp LINKS ridgeline::app LABELS unit)
target_compile_definitions(test_app_reference PRIVATE RIDGELINE_PROGRAM="$<TARGET_FILE:ridgeline>")
add_dependencies(test_app_reference ridgeline)

# Builds that are killed, run out of disk, or meet damage.
set_tests_properties(app_disk_full app_kills app_unreadable PROPERTIES LABELS "unit;faults")
# 360 kills with RIDGELINE_LONG=1, each with a run of `verify`.
set_tests_properties(app_kills PROPERTIES TIMEOUT 1800)
