// Reads back which ground a frame shows, for the tile schedule of a later frame (scheduling paper, 3.1, step
// 1): a compute pass over the frame's own depth, a ring of buffers, and never a wait.
//
// The paper draws the ground's coordinates into a texture of their own. Depth already holds them: with
// reverse-Z in floats it gives a place to a few millionths of its distance, for any surface, without drawing
// twice. Render thread only.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/buffer.h"
#include "ridgeline/gl/program.h"
#include "ridgeline/gl/readback_ring.h"
#include "ridgeline/gl/texture.h"
#include "ridgeline/platform/camera.h"
#include "ridgeline/select/seen_ground.h"

namespace ridgeline::render {

// Of one in so many pixels to the right and up the place is taken. Rows lie closer: seen aslant, the ground
// between two rows is long.
struct GroundSampling {
    glm::ivec2 step_px{4, 2};
};

// Since the start.
struct GroundReaderCounters {
    std::uint64_t asked = 0;
    std::uint64_t refused = 0;  // the GPU lagged so far that the ring was full
    std::uint64_t arrived = 0;
    // Looking for what has arrived waited and took longer than a tenth of a millisecond.
    std::uint64_t stalls = 0;
};

class GroundReader {
  public:
    static Result<GroundReader> create(const select::GroundLattice& lattice,
                                       const GroundSampling& sampling = {});

    struct Seen {
        std::uint64_t frame = 0;
        const platform::Camera* camera = nullptr;  // with which the depth was drawn
        select::Sight sight;
    };
    // After the ground is drawn, with the frame's uniforms bound.
    void read(const gl::Texture2D& depth, const Seen& seen);
    // Takes in what has arrived since the last call.
    void poll();
    // The newest that has arrived; null before the first. Changes with poll() alone.
    const select::GroundReadback* newest() const { return arrived_ ? &newest_ : nullptr; }

    std::size_t in_flight() const { return ring_.in_flight(); }
    const GroundReaderCounters& counters() const { return counters_; }

  private:
    static constexpr std::size_t kFrames = 4;  // that the GPU may lag

    struct Asked {
        std::uint64_t frame = 0;
        select::Sight sight;
    };
    void set_uniforms(const platform::Camera& camera);
    void take(const gl::ReadbackRing::Arrived& bytes);

    select::GroundLattice lattice_;
    GroundSampling sampling_;
    gl::Program program_;
    gl::Buffer result_;
    gl::ReadbackRing ring_;
    std::array<Asked, kFrames> asked_;  // by their numbers
    std::uint64_t number_ = 0;          // of the last that the ring took
    select::GroundReadback newest_;
    bool arrived_ = false;
    GroundReaderCounters counters_;
};

}  // namespace ridgeline::render
