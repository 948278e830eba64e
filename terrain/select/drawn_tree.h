// Questions that every walk over a frame's drawn tree asks. Internal to the room.
#pragma once

#include "ridgeline/base/geometry.h"
#include "ridgeline/select/frame_tree.h"
#include "ridgeline/select/terrain_frame.h"

namespace ridgeline::select {

class DrawnTree {
  public:
    // Front to back over a node's quarters: the nearest one XOR each of these, in order.
    static constexpr int kTurns[io::kQuarters] = {0, 1, 2, 3};

    DrawnTree(const TerrainFrame& frame, const FrameTree& tree) : frame_(frame), tree_(tree) {}

    bool child_drawn(io::NodeId node, int quarter) const {
        const io::NodeId child = node.child(quarter);
        return frame_.grid().contains(child) &&
               tree_.has(visit(frame_.grid(), child).index, FrameTree::kDrawn);
    }
    // Whether a quarter that the node draws itself is in the picture. Where the ideal tree splits the node,
    // the children's test was the same one.
    bool quarter_in_view(const Visit& v, int quarter, const Frustum& visible) const {
        if (tree_.has(v.index, FrameTree::kInside)) return true;
        if (tree_.has(v.index, FrameTree::kSplit))
            return tree_.has(visit(frame_.grid(), v.node.child(quarter)).index, FrameTree::kInView);
        return contains(visible, frame_.drawn_box(frame_.quarter_box(v, quarter))) != Containment::outside;
    }
    // The quarter in which a lattice place falls, or the nearest to it. Whole numbers, so that every walk
    // decides alike.
    int nearest_quarter(io::NodeId node, const glm::ivec2& place) const {
        const io::LatticePoint origin = frame_.grid().origin(node);
        const std::int64_t half = frame_.grid().extent(node.level) / 2;
        return (place.x >= origin.x + half ? 1 : 0) + (place.y >= origin.y + half ? 2 : 0);
    }

  private:
    const TerrainFrame& frame_;
    const FrameTree& tree_;
};

}  // namespace ridgeline::select
