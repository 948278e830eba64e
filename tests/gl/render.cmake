foreach(name render_frame render_sabotage render_watertight)
    ridgeline_test(${name} SOURCES gl/${name}.cpp LINKS ridgeline::app LABELS gl)
endforeach()
