// From the drawn tree to draw entries: which quarters, which side triangles, which morph ranges. Internal to
// the room.
#pragma once

#include <vector>

#include "ridgeline/base/geometry.h"
#include "ridgeline/select/drawn_tree.h"
#include "ridgeline/select/frame_tree.h"
#include "ridgeline/select/morph_ranges.h"
#include "ridgeline/select/selection.h"
#include "ridgeline/select/terrain_frame.h"

namespace ridgeline::select {

class DrawList {
  public:
    // The references outlive the list. The tree must be complete when build() is called.
    DrawList(const TerrainFrame& frame, const FrameTree& tree);

    // Everything in view, front to back.
    // hidden_quarters: of each node those that are hidden, as bits; empty: none.
    void build(const Frustum& visible, const EyeFrame& eye, Residency residency, std::span<const Visit> roots,
               std::span<const std::uint8_t> hidden_quarters);

    std::span<const DrawEntry> entries() const { return entries_; }
    std::uint64_t triangles() const { return triangles_; }
    int finest_level() const { return finest_level_; }

    // The entry of one node with the quarters given as bits.
    DrawEntry entry(const Visit& v, unsigned quarters, const EyeFrame& eye, Residency residency) const;

  private:
    void walk(const Visit& v);
    MorphNeighbours neighbours_of(const Visit& v, Residency residency) const;

    const TerrainFrame& frame_;
    const FrameTree& tree_;
    DrawnTree drawn_;
    const Frustum* visible_ = nullptr;
    EyeFrame eye_;
    Residency residency_;
    std::span<const std::uint8_t> hidden_quarters_;
    std::vector<DrawEntry> entries_;
    std::uint64_t triangles_ = 0;
    int finest_level_ = 0;
};

}  // namespace ridgeline::select
