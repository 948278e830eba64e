# The parts of engine/gl that need no context.
foreach(name gl_ring_allocator gl_shader_source)
    ridgeline_test(${name} SOURCES unit/${name}.cpp LINKS ridgeline::gl LABELS unit)
endforeach()
