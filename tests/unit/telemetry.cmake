ridgeline_test(telemetry
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/telemetry_clock.cpp ${CMAKE_CURRENT_LIST_DIR}/telemetry_summary.cpp
            ${CMAKE_CURRENT_LIST_DIR}/telemetry_trace.cpp ${CMAKE_CURRENT_LIST_DIR}/telemetry_recorder.cpp
            ${CMAKE_CURRENT_LIST_DIR}/telemetry_trend.cpp
    LINKS ridgeline::telemetry nlohmann_json::nlohmann_json
    LABELS unit property threads)
# Alone, since it replaces operator new.
ridgeline_test(telemetry_allocation
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/telemetry_allocation.cpp
    LINKS ridgeline::telemetry ridgeline::allocation_counter
    LABELS unit threads)
