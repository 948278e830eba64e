foreach(name gl_context gl_culling gl_objects gl_program gl_rings gl_screenshot)
    ridgeline_test(${name} SOURCES gl/${name}.cpp LINKS ridgeline::gl ridgeline::platform LABELS gl)
endforeach()

ridgeline_test(gl_call_clock SOURCES gl/gl_call_clock.cpp LINKS ridgeline::gl ridgeline::platform ridgeline::telemetry LABELS gl)

# The HUD's plumbing, without the rest of the program.
ridgeline_test(gl_imgui SOURCES gl/gl_imgui.cpp ${PROJECT_SOURCE_DIR}/app/hud/imgui_layer.cpp
               LINKS ridgeline::gl ridgeline::platform imgui::imgui LABELS gl)
target_include_directories(test_gl_imgui PRIVATE ${PROJECT_SOURCE_DIR}/app/hud)

# Windows need a display: where Xvfb is installed, a virtual one; without any, the test says that it was skipped.
ridgeline_test(gl_window SOURCES gl/gl_window.cpp ${PROJECT_SOURCE_DIR}/app/hud/imgui_layer.cpp
               LINKS ridgeline::gl ridgeline::platform imgui::imgui LABELS gl)
target_include_directories(test_gl_window PRIVATE ${PROJECT_SOURCE_DIR}/app/hud)
find_program(XVFB Xvfb)
if(XVFB)
    add_test(NAME gl_window_xvfb
             COMMAND ${PROJECT_SOURCE_DIR}/tests/support/with_display $<TARGET_FILE:test_gl_window>)
    set_tests_properties(gl_window_xvfb PROPERTIES LABELS gl TIMEOUT 60 RUN_SERIAL TRUE)
endif()
ridgeline_test(detail_shader SOURCES gl/detail_shader.cpp LINKS ridgeline::detail ridgeline::gl ridgeline::platform LABELS gl)
