# Every dependency comes from the system (Debian packages; see scripts/setup); nothing is vendored.
include(RidgelineLibraryDependencies)
find_package(doctest REQUIRED)
find_package(CLI11 REQUIRED)
pkg_check_modules(imgui REQUIRED imgui)
find_path(STB_INCLUDE_DIR stb/stb_image_write.h REQUIRED)

# imgui: Debian's pkg-config file leaves out GLFW, which the back-end in the library calls; a library of its own makes
# the linker see GLFW after it.
if(NOT TARGET imgui::imgui)
    find_library(IMGUI_LIBRARY imgui REQUIRED HINTS ${imgui_LIBRARY_DIRS})
    add_library(imgui::imgui UNKNOWN IMPORTED)
    set_target_properties(imgui::imgui PROPERTIES
        IMPORTED_LOCATION ${IMGUI_LIBRARY}
        INTERFACE_INCLUDE_DIRECTORIES "${imgui_INCLUDE_DIRS}"
        INTERFACE_LINK_LIBRARIES "stb;glfw;${CMAKE_DL_LIBS}")
endif()

# glad: an installed package where there is one (vcpkg, Conan), else Debian's generator, which needs no network; --debug:
# with brackets about every call, which engine/gl/call_clock.cpp puts to use.
if(NOT TARGET glad::glad)
    set(glad_dir ${CMAKE_BINARY_DIR}/glad)
    # By its full path: another python3 may come first on PATH and lack Debian's modules.
    set(glad_python /usr/bin/python3)
    add_custom_command(
        OUTPUT ${glad_dir}/src/gl.c ${glad_dir}/include/glad/gl.h
        COMMAND ${glad_python} -m glad --quiet --reproducible --api gl:core=4.5
                --extensions GL_EXT_texture_compression_s3tc,GL_EXT_texture_sRGB,GL_KHR_debug,GL_ARB_texture_filter_anisotropic
                --out-path ${glad_dir} c --debug
        COMMENT "Generating the OpenGL loader")
    add_library(ridgeline_glad STATIC ${glad_dir}/src/gl.c ${glad_dir}/include/glad/gl.h)
    target_include_directories(ridgeline_glad SYSTEM PUBLIC $<BUILD_INTERFACE:${glad_dir}/include>
                                                            $<INSTALL_INTERFACE:${RIDGELINE_GLAD_INCLUDE_DIR}>)
    set_target_properties(ridgeline_glad PROPERTIES EXPORT_NAME glad)
    install(TARGETS ridgeline_glad EXPORT ridgeline ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(DIRECTORY ${glad_dir}/include/ DESTINATION ${RIDGELINE_GLAD_INCLUDE_DIR})
    target_link_libraries(ridgeline_glad PRIVATE ${CMAKE_DL_LIBS})
    add_library(glad::glad ALIAS ridgeline_glad)
endif()
