// The programs that draw a surface which samples its heights: one vertex pass, lit and coloured in every way
// that was allowed. Render thread only.
#pragma once

#include <array>
#include <string>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/program.h"
#include "ridgeline/render/mesh_surface.h"

namespace ridgeline::render {

class GroundPrograms {
  public:
    // vertex_pass: "passes/disc.vert".
    static Result<GroundPrograms> create(std::string vertex_pass);
    // Builds the programs that read shadow maps, and those that read imagery, once.
    Result<void> allow_shadows();
    Result<void> allow_imagery(Coverage coverage);

    const gl::Program& program(Lighting lighting, Cover cover) const {
        return programs_[static_cast<std::size_t>(lighting)][static_cast<std::size_t>(cover)];
    }
    // Back faces are dropped by fragment, and must be drawn.
    bool culls_fragments() const { return culls_fragments_; }

  private:
    Result<void> build();

    std::string vertex_pass_;
    Lighting most_lighting_ = Lighting::unshadowed;
    Cover most_cover_ = Cover::tint;
    Coverage coverage_ = Coverage::partly;
    std::array<std::array<gl::Program, 2>, 2> programs_;
    bool culls_fragments_ = false;
};

}  // namespace ridgeline::render
