ridgeline_test(render_parts SOURCES unit/render_parts.cpp LINKS ridgeline::render LABELS unit property)
ridgeline_test(walk_measure SOURCES unit/walk_measure.cpp LINKS ridgeline::app LABELS unit property threads)
ridgeline_test(walk_parts SOURCES unit/walk_parts.cpp LINKS ridgeline::app ridgeline::raster LABELS unit)
ridgeline_test(render_cascades SOURCES unit/render_cascades.cpp LINKS ridgeline::render LABELS unit property)
