foreach(name select_allocation select_criterion select_hidden select_horizon select_mask select_motion select_rays select_report
             select_schedule select_seen_ground select_shadows select_surface select_trees select_watertight)
    ridgeline_test(${name}
        SOURCES unit/${name}.cpp unit/select_scene.cpp
        LINKS ridgeline::select
        LABELS unit property)
endforeach()
# Its last case is about the number of workers.
set_property(TEST select_hidden APPEND PROPERTY LABELS threads)
add_dependencies(thread_tests test_select_hidden test_build)
# Its last rays run over a store that is built from a raster.
target_link_libraries(test_select_rays PRIVATE ridgeline::build ridgeline::detail)
# A million rays with RIDGELINE_LONG=1 take minutes.
set_tests_properties(select_rays PROPERTIES TIMEOUT 1200)
