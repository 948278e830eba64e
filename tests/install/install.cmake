# What `cmake --install` puts down serves others: the examples are built against it, and run.
if(NOT RIDGELINE_SANITIZE)
    set(installed ${CMAKE_BINARY_DIR}/tests/installed)
    add_test(NAME install_prepare
             COMMAND ${CMAKE_CURRENT_LIST_DIR}/prepare ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR} ${installed})
    set_tests_properties(install_prepare PROPERTIES FIXTURES_SETUP installed TIMEOUT 600)
    add_test(NAME install_query COMMAND ${CMAKE_CURRENT_LIST_DIR}/query ${installed})
    set_tests_properties(install_query PROPERTIES FIXTURES_REQUIRED installed TIMEOUT 60)
    add_test(NAME install_headers
             COMMAND ${CMAKE_CURRENT_LIST_DIR}/headers ${CMAKE_CURRENT_LIST_DIR}/headers.CMakeLists.txt ${installed})
    set_tests_properties(install_headers PROPERTIES FIXTURES_REQUIRED installed TIMEOUT 300)
    find_program(XVFB Xvfb)
    if(XVFB)
        add_test(NAME install_embed COMMAND ${PROJECT_SOURCE_DIR}/tests/support/with_display
                                            ${CMAKE_CURRENT_LIST_DIR}/embed ${installed})
        set_tests_properties(install_embed PROPERTIES FIXTURES_REQUIRED installed LABELS gl TIMEOUT 120)
    endif()
endif()
