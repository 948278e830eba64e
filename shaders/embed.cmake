# Writes the files FILES (separated by |) under ROOT into the C++ source OUT, as raw string literals.
string(REPLACE "|" ";" files "${FILES}")
file(WRITE ${OUT}.new "// Generated from shaders/ by embed.cmake.\n"
     "#include \"ridgeline/shaders/shader_source.h\"\n\nnamespace ridgeline::shaders {\n\n"
     "std::span<const ShaderFile> shader_files() {\n    static constexpr ShaderFile kFiles[] = {\n")
foreach(file IN LISTS files)
    file(READ ${ROOT}/${file} text)
    file(APPEND ${OUT}.new "{\"${file}\", R\"ridgeline(" "${text}" ")ridgeline\"},\n")
endforeach()
file(APPEND ${OUT}.new "    };\n    return kFiles;\n}\n\n}  // namespace ridgeline::shaders\n")
file(RENAME ${OUT}.new ${OUT})
