// What the ground in front hides of a frame, and what the next frame may take for hidden (horizon paper, 4.1
// and 4.2). docs/selection.md tells why nothing that is seen is left out.
#include "ridgeline/select/selection_state.h"

namespace ridgeline::select {
namespace {

using io::NodeId;

// Drawn trees grown for one frame at most: with everything assumed that was hidden before, with what that
// disproved left out, with nothing assumed.
constexpr int kMostRounds = 3;

}  // namespace

// Grows the drawn tree until the horizon over it proves all that was assumed for it.
void Selection::State::find_hidden(const GroundSource& ground) {
    for (int round = 1; round <= kMostRounds; ++round) {
        grow_drawn(round < kMostRounds ? Assume::hidden : Assume::nothing);
        if (!eye_is_clear(ground)) return;
        sweep.run(view, result.eye, residency, roots, ground);
        result.counters.horizon_rounds = static_cast<std::uint32_t>(round);
        if (!reveal_disproved()) break;
    }
    hiding = true;
    mark_seen();
}

// Over the ground, and so far that the near plane cuts none of it: then every ray that passes behind a ridge
// has met drawn ground before. (docs/selection.md)
bool Selection::State::eye_is_clear(const GroundSource& ground) const {
    const io::TerrainInfo& info = frame.info();
    const glm::dvec2 eye = info.lattice(view.eye_m.x, view.eye_m.y);
    const glm::dvec2 last(static_cast<double>(info.width - 1), static_cast<double>(info.height - 1));
    if (glm::any(glm::lessThan(eye, glm::dvec2(0.0))) || glm::any(glm::greaterThan(eye, last))) return false;
    const GroundAbout about = ground_about(residency, ground, -view.near_reach_m);
    return about.complete && about.highest_m <= -view.near_reach_m;
}

// Whether some leaf without data was seen; it and what it hangs from are not assumed again.
bool Selection::State::reveal_disproved() {
    bool disproved = false;
    for (const SweptLeaf& leaf : sweep.leaves()) {
        if (leaf.now == 0 || !tree.has(leaf.node.index, FrameTree::kAssumed)) continue;
        disproved = true;
        for (Visit v = leaf.node; tree.has(v.index, FrameTree::kAssumed); v = visit(grid(), v.node.parent()))
            assumed.reveal(v.index);
    }
    return disproved;
}

// Of nodes: whether anything of them is seen. Of a leaf's quarters: the same, as the children's.
void Selection::State::mark_seen() {
    for (const SweptLeaf& leaf : sweep.leaves()) hidden_quarters[leaf.node.index] = 0;
    for (const SweptLeaf& leaf : sweep.leaves()) {
        if (!frame.record(leaf.node.index).has_data()) continue;
        const unsigned hidden = leaf.in_view & ~unsigned{leaf.now};
        hidden_quarters[leaf.node.index] =
            static_cast<std::uint8_t>(hidden_quarters[leaf.node.index] | hidden);
        if (leaf.in_view != 0 && leaf.now == 0) {
            ++result.counters.horizon_culled;
            result.counters.assumed += leaf.kind == SweptLeaf::Kind::assumed;
        }
        if (leaf.now != 0) mark(leaf.node, FrameTree::kSeen | FrameTree::kSoon);
        if (leaf.soon != 0) mark(leaf.node, FrameTree::kSoon);
        for (int q = 0; q < io::kQuarters; ++q) {
            const NodeId child = leaf.node.node.child(q);
            if (!grid().contains(child)) continue;
            if ((leaf.now >> q & 1) != 0)
                tree.add(visit(grid(), child).index, FrameTree::kSeen | FrameTree::kSoon);
            if ((leaf.soon >> q & 1) != 0) tree.add(visit(grid(), child).index, FrameTree::kSoon);
        }
    }
}

// With all ancestors.
void Selection::State::mark(const Visit& v, unsigned flags) {
    for (Visit up = v; !tree.has(up.index, flags); up = visit(grid(), up.node.parent())) {
        tree.add(up.index, flags);
        if (up.node.level == 0) return;
    }
}

void Selection::State::assume_for_next() {
    assumed.begin_next();
    for (const Visits& list : visits)
        for (const Visit& v : list) {
            const unsigned flags = tree.flags_of(v.index);
            if ((flags & FrameTree::kInView) == 0 || (flags & FrameTree::kAhead) != 0 ||
                !frame.record(v.index).has_data())
                continue;
            const bool missing = (flags & FrameTree::kResident) == 0;
            const bool revealed = assumed.revealed(v.index);
            const bool hidden = (flags & FrameTree::kSeen) == 0 && !revealed;
            if (missing && hidden != assumed.holds(v.index)) result.unsettled = true;
            if (hidden) assumed.add_hidden(v.index);
            if (missing && revealed) assumed.keep_revealed(v.index);
        }
    assumed.finish_next();
}

// Below the drawn tree nothing is known but what the quarter says in which a node lies.
void Selection::State::inherit_sight(const Visit& v) {
    if (v.node.level == 0) return;
    const NodeIndex parent = visit(grid(), v.node.parent()).index;
    if (!tree.has(parent, FrameTree::kDrawn))
        tree.add(v.index, tree.flags_of(parent) & (FrameTree::kSeen | FrameTree::kSoon));
}

}  // namespace ridgeline::select
