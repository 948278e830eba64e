// Made tiles' texels as the CPU knows them: the GPU's, bit by bit (terrain/detail), made when they are asked for and
// kept for a while. For the eye, which must stay above them, and for the tests.
//
// The source's tiles are the pager's copies. Render thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "ridgeline/detail/finer_ground.h"
#include "ridgeline/detail/made_ground.h"
#include "ridgeline/pager/pager.h"

namespace ridgeline::render {

class MadeHeights {
  public:
    // finest: level of the source's.
    MadeHeights(detail::FinerGround ground, int finest, int quads);

    // All of a tile's, row by row, until the next call; none where the source's tile is not in memory.
    std::span<const std::byte> texels(io::NodeId node, const pager::Pager& pager);
    // One of them. at: as shaders/lib/disc.h asks for it. 0 where the source's tile is not in memory.
    std::int32_t texel(io::NodeId node, const glm::ivec2& at, const pager::Pager& pager);

  private:
    const detail::DetailTile* tile(io::NodeId node, const pager::Pager& pager);
    bool is_terrain(io::NodeId node, glm::ivec2 cell, const pager::Pager& pager) const;

    int finest_, quads_;
    detail::MadeGround made_;
    std::vector<std::int32_t> texels_;
};

}  // namespace ridgeline::render
