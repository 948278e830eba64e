# One target per decoder family. In the preset `fuzz` it is a fuzzer (scripts/fuzz runs them); in every other
# build a test that feeds the body its corpus.
function(ridgeline_fuzz name)
    cmake_parse_arguments(FUZZ "" "" "SOURCES;LINKS" ${ARGN})
    set(target fuzz_${name})
    set(driver fuzz/replay.cpp)
    if(RIDGELINE_FUZZ)
        set(driver fuzz/libfuzzer.cpp)
    endif()
    add_executable(${target} fuzz/${name}.cpp ${driver} ${FUZZ_SOURCES})
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    target_link_libraries(${target} PRIVATE ${FUZZ_LINKS})
    ridgeline_configure(${target})
    if(RIDGELINE_FUZZ)
        target_link_options(${target} PRIVATE -fsanitize=fuzzer)
        ridgeline_collect(fuzzers ${target})
        return()
    endif()
    add_test(NAME ${target} COMMAND ${target} ${PROJECT_SOURCE_DIR}/tests/fuzz/corpus/${name})
    set_tests_properties(${target} PROPERTIES LABELS "unit;fuzz" TIMEOUT 300)
    ridgeline_collect(cpu_tests ${target})
endfunction()

ridgeline_fuzz(info SOURCES support/sealed_json.cpp LINKS ridgeline::io nlohmann_json::nlohmann_json)
ridgeline_fuzz(tables LINKS ridgeline::io PkgConfig::xxhash)
ridgeline_fuzz(store SOURCES support/sealed_json.cpp LINKS ridgeline::io PkgConfig::xxhash nlohmann_json::nlohmann_json)
ridgeline_fuzz(heights LINKS ridgeline::io ridgeline::pager)
ridgeline_fuzz(chunk LINKS ridgeline::io)
ridgeline_fuzz(relief LINKS ridgeline::io)
ridgeline_fuzz(imagery LINKS ridgeline::io)
ridgeline_fuzz(path LINKS ridgeline::platform)
# The two readers alone: the room that they are of links everything.
ridgeline_fuzz(telemetry
    SOURCES ${PROJECT_SOURCE_DIR}/app/report/frames_csv.cpp ${PROJECT_SOURCE_DIR}/app/report/summary_file.cpp
    LINKS ridgeline::base nlohmann_json::nlohmann_json)
target_include_directories(fuzz_telemetry PRIVATE ${CMAKE_BINARY_DIR}/rooms/app)

# Writes the corpora anew: build/release/tests/fuzz_corpus tests/fuzz/corpus
add_executable(fuzz_corpus EXCLUDE_FROM_ALL fuzz/make_corpus.cpp)
target_include_directories(fuzz_corpus PRIVATE ${PROJECT_SOURCE_DIR}/tests)
target_link_libraries(fuzz_corpus PRIVATE ridgeline::io ridgeline::platform PkgConfig::xxhash doctest::doctest)
ridgeline_configure(fuzz_corpus)
