# What clang holds locks to, in every build that it makes: an error, whatever other warnings are.
set(RIDGELINE_THREAD_SAFETY -Wthread-safety -Werror=thread-safety)

# One place for language standard, warnings and sanitizers.
function(ridgeline_configure target)
    target_compile_features(${target} PUBLIC cxx_std_20)
    set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast
                                             $<$<BOOL:${RIDGELINE_WERROR}>:-Werror>
                                             "$<$<CXX_COMPILER_ID:Clang>:${RIDGELINE_THREAD_SAFETY}>"
                                             # GCC 12 warns falsely inside std::string (GCC bug 105329).
                                             $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
    # Contracted multiply-adds would make heights differ between builds; exactness is an invariant here.
    target_compile_options(${target} PRIVATE -ffp-contract=off)
    if(RIDGELINE_SANITIZE)
        target_compile_options(${target} PRIVATE -fsanitize=${RIDGELINE_SANITIZE} -fno-omit-frame-pointer
                                                 -fno-sanitize-recover=all)
        target_link_options(${target} PRIVATE -fsanitize=${RIDGELINE_SANITIZE})
        if(RIDGELINE_SANITIZE MATCHES thread AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
            # GCC warns of the fences in moodycamel's queue, which the thread sanitizer does not follow.
            target_compile_options(${target} PRIVATE -Wno-tsan)
        endif()
    endif()
    if(RIDGELINE_COVERAGE)
        # Not atomic, which takes several times as long: threads lose counts, but no line that ran stays at none.
        target_compile_options(${target} PRIVATE --coverage)
        target_link_options(${target} PRIVATE --coverage)
    endif()
    if(RIDGELINE_CONTRACTS)
        target_compile_definitions(${target} PRIVATE RIDGELINE_CONTRACTS=1)
    endif()
    ridgeline_precompile(${target})
endfunction()

# What most files include takes most of them longer to read than their own code to compile: it is read once per build.
# Every file still includes what it uses; the presets that do without this (debug, clang) tell where one does not.
function(ridgeline_precompile target)
    if(NOT RIDGELINE_PRECOMPILE OR target STREQUAL ridgeline_common_headers)
        return()
    endif()
    if(NOT TARGET ridgeline_common_headers)
        file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/common_headers.cpp CONTENT "")
        add_library(ridgeline_common_headers OBJECT ${CMAKE_BINARY_DIR}/common_headers.cpp)
        target_link_libraries(ridgeline_common_headers PRIVATE glm::glm)
        ridgeline_configure(ridgeline_common_headers)
        target_precompile_headers(ridgeline_common_headers PRIVATE
            <algorithm> <array> <atomic> <bit> <chrono> <cmath> <cstddef> <cstdint> <cstdio> <cstring> <filesystem>
            <functional> <glm/glm.hpp> <limits> <map> <memory> <numbers> <optional> <span> <string> <string_view>
            <thread> <utility> <variant> <vector>)
    endif()
    target_precompile_headers(${target} REUSE_FROM ridgeline_common_headers)
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
        # GCC 12 then warns falsely of more inside std::string (GCC bug 105329); builds without keep these warnings.
        target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread)
    endif()
endfunction()

# ridgeline_room(NAME [INTERNAL] SOURCES a.cpp ... [PUBLIC targets...] [PRIVATE targets...] [OWN_HEADERS a.h ...])
#
# A room is a static library `ridgeline_NAME` (alias `ridgeline::NAME`) whose headers are included as
# "ridgeline/NAME/header.h". Only targets that link the room see that path: it is a symbolic link in the build
# tree, one include directory per room, so that an include against the directions of the house does not compile.
# Rooms are installed for others to use, but for those that say INTERNAL, and for headers that need a library which the
# room keeps to itself: OWN_HEADERS.
function(ridgeline_room name)
    cmake_parse_arguments(ROOM "INTERNAL" "" "SOURCES;PUBLIC;PRIVATE;OWN_HEADERS" ${ARGN})
    set(visible ${CMAKE_BINARY_DIR}/rooms/${name})
    file(MAKE_DIRECTORY ${visible}/ridgeline)
    file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${visible}/ridgeline/${name} SYMBOLIC)
    add_library(ridgeline_${name} STATIC ${ROOM_SOURCES})
    add_library(ridgeline::${name} ALIAS ridgeline_${name})
    target_include_directories(ridgeline_${name} PUBLIC $<BUILD_INTERFACE:${visible}>
                                                        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_link_libraries(ridgeline_${name} PUBLIC ${ROOM_PUBLIC} PRIVATE ${ROOM_PRIVATE})
    ridgeline_configure(ridgeline_${name})
    if(NOT ROOM_INTERNAL)
        ridgeline_install_room(${name} ${ROOM_OWN_HEADERS})
    endif()
endfunction()

# A target that stands for several: made with the first of them.
function(ridgeline_collect collection target)
    if(NOT TARGET ${collection})
        add_custom_target(${collection})
    endif()
    add_dependencies(${collection} ${target})
endfunction()

# ridgeline_test(NAME SOURCES a.cpp ... LINKS targets... [LABELS labels...] [TIMEOUT seconds])
# A doctest program; tests that need a GL context or the real data skip themselves with a message.
function(ridgeline_test name)
    cmake_parse_arguments(TEST "" "TIMEOUT" "SOURCES;LINKS;LABELS" ${ARGN})
    # doctest's own code is slow to compile: once for all tests.
    if(NOT TARGET ridgeline_test_main)
        add_library(ridgeline_test_main STATIC ${PROJECT_SOURCE_DIR}/tests/support/main.cpp)
        target_link_libraries(ridgeline_test_main PUBLIC doctest::doctest)
        ridgeline_configure(ridgeline_test_main)
    endif()
    add_executable(test_${name} ${TEST_SOURCES})
    target_link_libraries(test_${name} PRIVATE ${TEST_LINKS} ridgeline_test_main)
    target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    target_compile_definitions(test_${name} PRIVATE RIDGELINE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    ridgeline_configure(test_${name})
    add_test(NAME ${name} COMMAND test_${name})
    if(NOT TEST_TIMEOUT)
        # Sanitizers slow a test ten times and more, counting lines a few times.
        if(RIDGELINE_SANITIZE OR RIDGELINE_COVERAGE)
            set(TEST_TIMEOUT 1200)
        else()
            set(TEST_TIMEOUT 300)
        endif()
    endif()
    set_tests_properties(${name} PROPERTIES LABELS "${TEST_LABELS}" TIMEOUT ${TEST_TIMEOUT})
    # What needs no GL: all that the sanitizer presets build.
    if(NOT "gl" IN_LIST TEST_LABELS AND NOT "golden" IN_LIST TEST_LABELS)
        ridgeline_collect(cpu_tests test_${name})
    endif()
    # What runs several threads: all that CI builds for the thread sanitizer.
    if("threads" IN_LIST TEST_LABELS)
        ridgeline_collect(thread_tests test_${name})
    endif()
endfunction()
