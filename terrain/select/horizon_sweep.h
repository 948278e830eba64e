// The incremental horizon over a frame's drawn tree: front to back, each leaf is held against what stands
// before it, then its own ground raises the horizon. Internal to the room.
//
// Slices of azimuth are swept each by itself, by as many jobs as there are workers; what comes out does not
// depend on how many. Memory is kept from frame to frame.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/jobs/job_system.h"
#include "ridgeline/select/draw_list.h"
#include "ridgeline/select/drawn_tree.h"
#include "ridgeline/select/frame_tree.h"
#include "ridgeline/select/ground_source.h"
#include "ridgeline/select/near_ground.h"
#include "ridgeline/select/slice_horizon.h"
#include "ridgeline/select/terrain_frame.h"
#include "ridgeline/select/view.h"

namespace ridgeline::select {

// A leaf of the drawn tree, or some quarters of one, in its place from front to back.
struct SweptLeaf {
    enum class Kind : std::uint8_t {
        ground,   // its data is there: hides and is hidden
        assumed,  // its data is not: may be hidden, by what an ancestor's maxima say
        nothing,  // no data, or none to know it by: seen, and behind it nothing is hidden
    };
    Visit node;
    // Whose maxima bound it: itself, or its nearest resident ancestor.
    Visit known_by;
    Kind kind = Kind::nothing;
    std::uint8_t quarters = 0;   // as bits
    std::uint8_t in_view = 0;    // ... of which in the picture
    std::int8_t near_mesh = -1;  // its slot in NearGround
    bool whole = false;          // all the node's quarters
    // Quarters that are seen, now and from where the eye may be soon.
    std::uint8_t now = 0, soon = 0;
};

class HorizonSweep {
  public:
    // The references outlive the sweep; jobs may be null: everything on the calling thread.
    HorizonSweep(const TerrainFrame& frame, const FrameTree& tree, const DrawList& draw_list,
                 jobs::JobSystem* jobs);

    // The tree must be complete.
    void run(const View& view, const EyeFrame& eye, Residency residency, std::span<const Visit> roots,
             const GroundSource& source);

    std::span<const SweptLeaf> leaves() const { return leaves_; }
    const SliceHorizon& slice(int i) const { return slices_[static_cast<std::size_t>(i)]; }
    bool swept(int slice) const { return (active_ >> slice & 1u) != 0; }
    // Whether some of the picture lies in it.
    bool pictured(int slice) const { return (pictured_ >> slice & 1u) != 0; }

  private:
    static constexpr int kMostBands = 128;

    void collect(const Visit& v, const Visit* known_by);
    void add(const Visit& v, const Visit* known_by, unsigned quarters);
    unsigned slices_of(const ExtensionZone& cone) const;
    void find_near_mesh(SweptLeaf& leaf, Residency residency);
    bool is_unmorphed(const SweptLeaf& leaf, Residency residency) const;
    void sweep(int slice);
    unsigned sweep(SliceHorizon& slice, const SweptLeaf& leaf) const;
    unsigned sweep_quarters(SliceHorizon& slice, const SweptLeaf& leaf) const;
    void raise_quarter(SliceHorizon& slice, const SweptLeaf& leaf, int quarter,
                       const SliceHorizon::Sight& seen) const;
    SliceHorizon::Sight look(const SliceHorizon& slice, const SweptLeaf& leaf, int quarter) const;
    void close_invalid(SliceHorizon& slice, const SweptLeaf& leaf, unsigned quarters) const;
    // quarter: kWhole, kSeams for all of them.
    void raise(SliceHorizon& slice, const SweptLeaf& leaf, int quarter) const;
    // Bands first to last - 1 of an axis, or those of them that hide most; returns how many.
    int choose_bands(const SweptLeaf& leaf, const io::ReliefView& relief, io::ReliefAxis axis, int first,
                     int last, std::array<int, kMostBands>& chosen) const;
    void raise_mesh(SliceHorizon& slice, const SweptLeaf& leaf, int quarter) const;
    void merge();

    double top_m(NodeIndex index) const;
    // How far the ground that is drawn may be from what chunks know of a leaf's.
    double beside_m(const SweptLeaf& leaf) const {
        return leaf.node.node.level == frame_.grid().finest() ? view_.beside_finest_m : 0.0;
    }
    // In its own sides, on the level; 0 over the leaf.
    double sides_away(const SweptLeaf& leaf) const;

    const TerrainFrame& frame_;
    const FrameTree& tree_;
    const DrawList& draw_list_;
    DrawnTree drawn_;
    jobs::JobSystem* jobs_;
    const GroundSource* source_ = nullptr;
    View view_;
    glm::ivec2 eye_place_{0};
    NearGround near_ground_;
    std::vector<SweptLeaf> leaves_;
    std::array<SliceHorizon, SliceView::kSlices> slices_;
    std::array<std::vector<std::uint16_t>, SliceView::kSlices> seen_;  // by leaf
    unsigned active_ = 0, pictured_ = 0;                               // slices, as bits
};

}  // namespace ridgeline::select
