// The disc: rings about the eye that take their heights from cached tiles, in the vertex shader.
//
// Owns nothing but its buffers and programs; heights are a HeightTexture's. Render thread only; after the
// first frames nothing allocates.
#pragma once

#include <array>

#include "ridgeline/base/geometry.h"
#include "ridgeline/base/result.h"
#include "ridgeline/gl/buffer.h"
#include "ridgeline/gl/program.h"
#include "ridgeline/gl/vertex_array.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/render/disc_grid.h"
#include "ridgeline/render/ground_programs.h"
#include "ridgeline/select/view.h"
#include "ridgeline/shaders/shared/disc_uniforms.h"

namespace ridgeline::render {

// What rings are drawn for: the frame's rings, and what of them the picture can show.
struct DiscScene {
    shaders::DiscUniforms disc;
    select::EyeFrame eye;
    // In the drawn frame, as the selection has it.
    Frustum visible;
    // Of everything that may be drawn.
    Box terrain_m;
};

class DiscSurface {
  public:
    static Result<DiscSurface> create(const io::TerrainInfo& info);
    GroundPrograms& programs() { return programs_; }

    // With the frame's uniforms, noise and heights bound, and shadow maps and imagery where they are read.
    void draw(const DiscScene& scene, Lighting lighting, Cover cover);

    const SurfaceCounters& counters() const { return counters_; }

  private:
    explicit DiscSurface(const io::TerrainInfo& info) : info_(info) {}
    Result<void> create_grid();
    void draw_ring(const DiscScene& scene, const gl::Program& program, int ring, RingHole hole);

    io::TerrainInfo info_;
    GroundPrograms programs_;
    std::array<std::array<RingSector, kRingSectors>, kRingHoles> sectors_{};
    gl::Buffer vertices_;
    gl::Buffer indices_;
    gl::VertexArray array_;
    SurfaceCounters counters_;
};

}  // namespace ridgeline::render
