// Reports on a frame's drawn tree (node_report.h). Internal to the room.
#pragma once

#include <span>
#include <vector>

#include "ridgeline/base/geometry.h"
#include "ridgeline/select/drawn_tree.h"
#include "ridgeline/select/frame_tree.h"
#include "ridgeline/select/horizon_sweep.h"
#include "ridgeline/select/node_report.h"
#include "ridgeline/select/terrain_frame.h"

namespace ridgeline::select {

class DrawnReport {
  public:
    // All outlive it. nodes: reports are appended.
    DrawnReport(const TerrainFrame& frame, const FrameTree& tree, const Frustum& visible,
                std::vector<NodeReport>& nodes)
        : frame_(frame), tree_(tree), drawn_(frame, tree), visible_(visible), nodes_(nodes) {}

    // What the horizon's sweep found of the leaves in the zone.
    void add(std::span<const SweptLeaf> leaves);

    enum class Where {
        everywhere,       // the horizon hid nothing
        outside_the_zone  // what the sweep did not look at
    };
    // Front to back from a lattice place. root: of level 0.
    void add(const Visit& root, Where where, const glm::ivec2& eye_place);

  private:
    void add_leaf(const Visit& v, unsigned quarters);

    const TerrainFrame& frame_;
    const FrameTree& tree_;
    DrawnTree drawn_;
    const Frustum& visible_;
    std::vector<NodeReport>& nodes_;
};

}  // namespace ridgeline::select
