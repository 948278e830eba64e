// The pass that makes a tile of ground finer than the source from its parent, both of them slots of the heights'
// texture (shaders/lib/detail.h). Render thread only.
#pragma once

#include <cstdint>

#include "ridgeline/base/result.h"
#include "ridgeline/detail/finer_ground.h"
#include "ridgeline/gl/program.h"
#include "ridgeline/gl/texture.h"
#include "ridgeline/io/node_id.h"

namespace ridgeline::render {

// A tile and its parent, which lies there already; octave: of the tile, from 1.
struct DetailWork {
    io::NodeId node;
    int octave = 1;
    std::uint32_t slot = 0, parent_slot = 0;
};

class DetailPass {
  public:
    // quads: of a tile's side.
    static Result<DetailPass> create(detail::FinerGround ground, int quads);

    // tiles: the heights' texture; bound by this for both. Nothing made since the last finish() may be a parent.
    void make(const gl::Texture2DArray& tiles, const DetailWork& work) const;
    // What was made can be sampled, be a parent, and be written over.
    void finish() const;

  private:
    DetailPass(detail::FinerGround ground, int quads) : ground_(std::move(ground)), quads_(quads) {}

    detail::FinerGround ground_;
    int quads_ = 64;
    gl::Program program_;
    gl::Sampler sampler_;
};

}  // namespace ridgeline::render
