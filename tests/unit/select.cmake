ridgeline_test(select_watertight
    SOURCES unit/select_watertight.cpp unit/select_scene.cpp
    LINKS ridgeline::select
    LABELS unit property)
