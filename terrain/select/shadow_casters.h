// Which nodes cast shadows: those whose surface can stand between the sun and something that is seen.
//
// Receivers are what the draw list holds, so whatever keeps a node from being drawn (the frustum, the
// horizon) keeps it from asking for casters; it may still be one. Casters are leaves of the ideal tree all
// around the eye: they have the levels that they would have in view, so however few of them are drawn, a
// shadow comes out the same. Internal to the room; one thread; memory is per node and sized at construction.
#pragma once

#include <span>
#include <vector>

#include "ridgeline/select/draw_list.h"
#include "ridgeline/select/frame_tree.h"
#include "ridgeline/select/receiver_mask.h"
#include "ridgeline/select/selection.h"
#include "ridgeline/select/terrain_frame.h"

namespace ridgeline::select {

class ShadowCasters {
  public:
    // The references outlive it.
    ShadowCasters(const TerrainFrame& frame, const FrameTree& tree, const DrawList& draw_list);

    // Anew for a view with the sun up; the ideal tree must be complete all around the eye.
    void find(const View& view, std::span<const Visit> roots, Residency residency);
    void clear();

    // Casting nodes and their ancestors, ancestors first, whether their data is there or not.
    std::span<const Visit> nodes() const { return nodes_; }
    // What of them can be drawn: a missing node's area is its ancestor's.
    std::span<const ShadowCaster> entries() const { return entries_; }

  private:
    void see_receivers();
    bool casts(const Visit& leaf) const;
    bool mark(const Visit& v);
    void append(const Visit& v, Residency residency);
    bool child_stands(io::NodeId node, int quarter) const;
    bool quarter_casts(const Visit& v, int quarter) const;

    const TerrainFrame& frame_;
    const FrameTree& tree_;
    const DrawList& draw_list_;
    const View* view_ = nullptr;
    EyeFrame eye_;
    FrameTree marks_;  // kDrawn: casts, or an ancestor of what does
    ReceiverMask mask_;
    std::vector<SunBox> receivers_;
    std::vector<Visit> nodes_;
    std::vector<ShadowCaster> entries_;
};

}  // namespace ridgeline::select
