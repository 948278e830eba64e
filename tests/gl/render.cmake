foreach(name render_frame)
    ridgeline_test(${name} SOURCES gl/${name}.cpp LINKS ridgeline::app LABELS gl)
endforeach()
