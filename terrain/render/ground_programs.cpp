#include "ridgeline/render/ground_programs.h"

#include <utility>
#include <vector>

#include "ridgeline/gl/capabilities.h"

namespace ridgeline::render {

Result<GroundPrograms> GroundPrograms::create(std::string vertex_pass) {
    GroundPrograms programs;
    programs.vertex_pass_ = std::move(vertex_pass);
    programs.culls_fragments_ = gl::query_capabilities().culls_before_snapping;
    RIDGELINE_TRY(programs.build());
    return programs;
}

// Whatever is allowed by now, in every combination, and not yet there.
Result<void> GroundPrograms::build() {
    for (const Lighting lighting : {Lighting::unshadowed, Lighting::shadowed})
        for (const Cover cover : {Cover::tint, Cover::imagery}) {
            if (lighting > most_lighting_ || cover > most_cover_ || !program(lighting, cover).empty())
                continue;
            std::vector<gl::ShaderDefine> defines = {{"RIDGELINE_DISC", "1"}};
            if (lighting == Lighting::shadowed) defines.push_back({"RIDGELINE_SHADOWS", "1"});
            if (cover == Cover::imagery) defines.push_back({"RIDGELINE_IMAGERY", "1"});
            if (cover == Cover::imagery && coverage_ == Coverage::wholly)
                defines.push_back({"RIDGELINE_IMAGERY_WHOLE", "1"});
            if (culls_fragments_) defines.push_back({"RIDGELINE_CULL_FRAGMENTS", "1"});
            auto built = gl::Program::create({{vertex_pass_, "passes/terrain.frag"}, std::move(defines)});
            if (!built) return built.error();
            programs_[static_cast<std::size_t>(lighting)][static_cast<std::size_t>(cover)] =
                std::move(built).value();
        }
    return {};
}

Result<void> GroundPrograms::allow_shadows() {
    most_lighting_ = Lighting::shadowed;
    return build();
}

Result<void> GroundPrograms::allow_imagery(Coverage coverage) {
    most_cover_ = Cover::imagery;
    coverage_ = coverage;
    return build();
}

}  // namespace ridgeline::render
