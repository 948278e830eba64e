# What `cmake --install` puts down so that others build against the rooms: libraries, headers as they are included, and
# the package that find_package(ridgeline) finds.
set(RIDGELINE_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/ridgeline)
# The OpenGL loader's headers, where it is generated: apart, so that no other program's are hidden.
set(RIDGELINE_GLAD_INCLUDE_DIR ${CMAKE_INSTALL_INCLUDEDIR}/ridgeline/glad)

# ridgeline_install_room(NAME [header left out...]): headers keep their folders within the room; a folder that is a room
# of its own installs itself.
function(ridgeline_install_room name)
    set_target_properties(ridgeline_${name} PROPERTIES EXPORT_NAME ${name})
    install(TARGETS ridgeline_${name} EXPORT ridgeline ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
    file(GLOB_RECURSE headers RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS *.h)
    list(REMOVE_ITEM headers ${ARGN})
    foreach(header ${headers})
        cmake_path(GET header PARENT_PATH folder)
        string(REGEX MATCH "^[^/]+" first "${folder}")
        if(first AND EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${first}/CMakeLists.txt)
            continue()
        endif()
        install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ridgeline/${name}/${folder})
    endforeach()
endfunction()

# After all rooms.
function(ridgeline_install_package)
    include(CMakePackageConfigHelpers)
    configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/ridgeline-config.cmake.in
        ${PROJECT_BINARY_DIR}/ridgeline-config.cmake INSTALL_DESTINATION ${RIDGELINE_PACKAGE_DIR})
    # Until 1.0 a minor version may change what others call.
    write_basic_package_version_file(${PROJECT_BINARY_DIR}/ridgeline-config-version.cmake COMPATIBILITY SameMinorVersion)
    install(EXPORT ridgeline FILE ridgeline-targets.cmake NAMESPACE ridgeline:: DESTINATION ${RIDGELINE_PACKAGE_DIR})
    install(FILES ${PROJECT_BINARY_DIR}/ridgeline-config.cmake ${PROJECT_BINARY_DIR}/ridgeline-config-version.cmake
                  ${PROJECT_SOURCE_DIR}/cmake/RidgelineLibraryDependencies.cmake
            DESTINATION ${RIDGELINE_PACKAGE_DIR})
endfunction()
