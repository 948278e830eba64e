// One frame's selection in the making, which Selection keeps from frame to frame. Internal to the room; one
// thread at a time. selection.cpp grows the trees and lists what is wanted, hidden_ground.cpp finds what is
// hidden.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/select/assumed_hidden.h"
#include "ridgeline/select/draw_list.h"
#include "ridgeline/select/frame_tree.h"
#include "ridgeline/select/horizon_sweep.h"
#include "ridgeline/select/selection.h"
#include "ridgeline/select/shadow_casters.h"
#include "ridgeline/select/terrain_frame.h"
#include "ridgeline/select/wanted_list.h"

namespace ridgeline::select {

struct Selection::State {
    using Visits = std::vector<Visit>;

    State(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
          const Criterion& criterion_used, const SelectionOptions& options);

    void run(const View& view, Residency residency, const GroundSource* ground);

    // The ideal tree.
    void split_by_criterion();
    void balance();
    // What is in view or may come into it.
    void descend();
    void admit(const Visit& v);
    void admit_roots();
    void admit_children(const Visit& parent, bool ahead);
    unsigned sight_of(const Visit& v, const Visit& parent, const Box& of_chunks) const;
    bool matters(const Visit& v) const;
    bool is_beside_eye(const Box& area) const;
    void keep_fine_beside_eye();
    void keep(const io::NodeId& node);
    bool has_child_beside_eye(const Visit& v) const;
    bool is_ahead(const Visit& v) const;

    // What is drawn, and what the ground in front hides.
    enum class Assume { nothing, hidden };
    void grow_drawn(Assume assume);
    bool is_present(NodeIndex child, const Visit& parent, Assume assume) const;
    bool may_split(const Visit& v) const;
    void find_hidden(const GroundSource& ground);
    bool eye_is_clear(const GroundSource& ground) const;
    GroundAbout ground_about(Residency of, const GroundSource& ground, double floor_m) const;
    bool reveal_disproved();
    void mark_seen();
    void mark(const Visit& v, unsigned flags);
    void assume_for_next();

    // What is wanted.
    void note_all();
    void inherit_sight(const Visit& v);
    enum class Demand { none, extension, visible };
    Demand demand(const Visit& v) const;
    void note(const Visit& v);
    void count(const Visit& v);
    void add_casters();
    void publish();
    bool entry_at(double column, double row, Residency of, DrawEntry& entry) const;

    const io::Grid& grid() const { return frame.grid(); }
    Visits& level(std::vector<Visits>& levels, int l) { return levels[static_cast<std::size_t>(l)]; }

    TerrainFrame frame;
    FrameTree tree;
    const Criterion& criterion;
    View view;
    Residency residency;

    Visits roots;
    std::vector<Visits> visits;  // by level: nodes looked at
    std::vector<Visits> splits;  // by level: nodes that the ideal tree splits
    Visits beside_eye;           // of the ideal tree, below the roots: what the eye stands on or beside
    DrawList draw_list;
    ShadowCasters casters;
    HorizonSweep sweep;
    AssumedHidden assumed;
    bool hiding = false;                        // the horizon holds for this frame
    std::vector<std::uint8_t> hidden_quarters;  // by node; of leaves in view
    WantedList wanted;
    std::vector<NodeIndex> used, held_back;
    SelectionResult result;
};

}  // namespace ridgeline::select
