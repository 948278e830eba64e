# That the locks are really checked: clang takes a guarded field used under its lock and refuses one used without, with
# the very options that ridgeline_configure() gives it.
find_program(RIDGELINE_CLANG clang++)
if(RIDGELINE_CLANG)
    set(analysis ${RIDGELINE_CLANG} -std=c++20 -fsyntax-only ${RIDGELINE_THREAD_SAFETY}
                 -I ${CMAKE_BINARY_DIR}/rooms/base ${CMAKE_CURRENT_LIST_DIR}/guarded_counter.cpp)
    add_test(NAME locks_kept COMMAND ${analysis})
    add_test(NAME locks_broken COMMAND ${analysis} -DBREAK_THE_LOCK)
    set_tests_properties(locks_broken PROPERTIES
        PASS_REGULAR_EXPRESSION "error: writing variable 'count_' requires holding mutex 'mutex_'")
    set_tests_properties(locks_kept locks_broken PROPERTIES LABELS "unit;static")
endif()
# And that every lock says what it guards.
add_test(NAME locks_named COMMAND ${CMAKE_CURRENT_LIST_DIR}/locks_named ${PROJECT_SOURCE_DIR})
set_tests_properties(locks_named PROPERTIES LABELS "unit;static")
