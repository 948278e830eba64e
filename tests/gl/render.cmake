ridgeline_test(render_detail SOURCES gl/render_detail.cpp LINKS ridgeline::app ridgeline::build LABELS gl TIMEOUT 3600)
foreach(name render_frame render_readback render_sabotage render_watertight)
    ridgeline_test(${name} SOURCES gl/${name}.cpp LINKS ridgeline::app LABELS gl)
endforeach()
ridgeline_test(render_quadtree_passes SOURCES gl/render_quadtree_passes.cpp LINKS ridgeline::app ridgeline::build LABELS gl)
ridgeline_test(render_shadows SOURCES gl/render_shadows.cpp
               LINKS ridgeline::app ridgeline::build ridgeline::raster GDAL::GDAL LABELS gl)
ridgeline_test(render_steady_state SOURCES gl/render_steady_state.cpp
               LINKS ridgeline::app ridgeline::build ridgeline::allocation_counter LABELS gl)
ridgeline_test(app_walk SOURCES gl/app_walk.cpp LINKS ridgeline::app nlohmann_json::nlohmann_json LABELS gl)
target_compile_definitions(test_app_walk PRIVATE RIDGELINE_PROGRAM="$<TARGET_FILE:ridgeline>")
add_dependencies(test_app_walk ridgeline)
ridgeline_test(render_horizon SOURCES gl/render_horizon.cpp LINKS ridgeline::app ridgeline::build ridgeline::synth LABELS gl
               TIMEOUT 7200)
ridgeline_test(bench_horizon SOURCES gl/bench_horizon.cpp LINKS ridgeline::app nlohmann_json::nlohmann_json LABELS gl)
ridgeline_test(bench_scheduling SOURCES gl/bench_scheduling.cpp
               LINKS ridgeline::app ridgeline::build nlohmann_json::nlohmann_json LABELS gl)
ridgeline_test(bench_quadtree SOURCES gl/bench_quadtree.cpp LINKS ridgeline::app nlohmann_json::nlohmann_json LABELS gl)
ridgeline_test(bench_synthesis SOURCES gl/bench_synthesis.cpp
               LINKS ridgeline::app ridgeline::build nlohmann_json::nlohmann_json LABELS gl)
ridgeline_test(bench_stress SOURCES gl/bench_stress.cpp LINKS ridgeline::app nlohmann_json::nlohmann_json LABELS gl)
ridgeline_test(bench_pictures SOURCES gl/bench_pictures.cpp LINKS ridgeline::app ridgeline::build LABELS gl)
target_include_directories(test_bench_pictures SYSTEM PRIVATE ${STB_INCLUDE_DIR})
ridgeline_test(hud_panels SOURCES gl/hud_panels.cpp
               LINKS ridgeline::app ridgeline::allocation_counter imgui::imgui LABELS gl)
ridgeline_test(render_imagery SOURCES gl/render_imagery.cpp LINKS ridgeline::app ridgeline::build LABELS gl)
ridgeline_test(render_surfaces SOURCES gl/render_surfaces.cpp LINKS ridgeline::app ridgeline::build LABELS gl)
ridgeline_test(gpu_encoder SOURCES gl/gpu_encoder.cpp LINKS ridgeline::gpu_encoder LABELS gl)
