// Literature: the nodes that the light sees besides those that the eye sees, PVS_L and PVS_E of the horizon
// paper (section 5, after Govindaraju et al. 2003), and the mask of receivers of Bittner et al. (2011). How
// we differ: the paper asks silhouettes whether they easily shade their neighbours; here every leaf is asked
// whether its box can, because silhouettes lie under the surface and would lose casters.
#include "ridgeline/select/shadow_casters.h"

namespace ridgeline::select {
namespace {

using io::NodeId;

constexpr std::size_t kUsualNodes = 4096;
constexpr std::size_t kUsualReceivers = 4096;

}  // namespace

ShadowCasters::ShadowCasters(const TerrainFrame& frame, const FrameTree& tree, const DrawList& draw_list)
    : frame_(frame), tree_(tree), draw_list_(draw_list), marks_(frame.grid().node_count()) {
    receivers_.reserve(kUsualReceivers);
    nodes_.reserve(kUsualNodes);
    entries_.reserve(kUsualNodes);
}

void ShadowCasters::clear() {
    nodes_.clear();
    entries_.clear();
}

void ShadowCasters::find(const View& view, std::span<const Visit> roots, Residency residency) {
    clear();
    view_ = &view;
    eye_ = eye_frame(view, frame_.info());
    marks_.begin_frame();
    if (view.sun.casters == CasterSet::pvs) see_receivers();
    for (const Visit& root : roots) mark(root);
    for (const Visit& root : roots) append(root, residency);
}

void ShadowCasters::see_receivers() {
    receivers_.clear();
    for (const DrawEntry& entry : draw_list_.entries())
        for (int quarter = 0; quarter < io::kQuarters; ++quarter) {
            if ((entry.quarters >> quarter & 1u) == 0) continue;
            const Box box = frame_.quarter_box({entry.node, entry.index}, quarter);
            const glm::dvec3 farthest = glm::max(box.max - view_->eye_m, view_->eye_m - box.min);
            const ShadowReach& reach = view_->sun.reach_at(glm::length(farthest));
            SunBox seen = sun_box(view_->sun.axes, view_->eye_m, box);
            seen.min -= glm::dvec3(reach.aside_m, reach.down_m);
            seen.max += glm::dvec3(reach.aside_m, 0.0);
            receivers_.push_back(seen);
        }
    mask_.fill(receivers_);
}

bool ShadowCasters::casts(const Visit& leaf) const {
    if (view_->sun.casters == CasterSet::all) return true;
    return mask_.shades(sun_box(view_->sun.axes, view_->eye_m, frame_.box(leaf)));
}

// Whether the node or anything below it casts.
bool ShadowCasters::mark(const Visit& v) {
    if (!frame_.record(v.index).has_data()) return false;
    const std::size_t place = nodes_.size();
    nodes_.push_back(v);
    bool any = false;
    if (!tree_.has(v.index, FrameTree::kSplit)) {
        any = casts(v);
    } else {
        for (int quarter = 0; quarter < io::kQuarters; ++quarter) {
            const NodeId child = v.node.child(quarter);
            if (frame_.grid().contains(child) && mark(visit(frame_.grid(), child))) any = true;
        }
    }
    if (any)
        marks_.add(v.index, FrameTree::kDrawn);
    else
        nodes_.resize(place);
    return any;
}

bool ShadowCasters::child_stands(NodeId node, int quarter) const {
    const NodeId child = node.child(quarter);
    return frame_.grid().contains(child) &&
           tree_.has(visit(frame_.grid(), child).index, FrameTree::kDrawn | FrameTree::kResident);
}

bool ShadowCasters::quarter_casts(const Visit& v, int quarter) const {
    if (!tree_.has(v.index, FrameTree::kSplit)) return true;
    const NodeId child = v.node.child(quarter);
    return frame_.grid().contains(child) && marks_.has(visit(frame_.grid(), child).index, FrameTree::kDrawn);
}

void ShadowCasters::append(const Visit& v, Residency residency) {
    const bool stands = tree_.has(v.index, FrameTree::kDrawn | FrameTree::kResident);
    if (!stands || !marks_.has(v.index, FrameTree::kDrawn)) return;
    unsigned own_quarters = 0;
    for (int quarter = 0; quarter < io::kQuarters; ++quarter) {
        if (!frame_.quarter_exists(v.node, quarter)) continue;
        if (child_stands(v.node, quarter))
            append(visit(frame_.grid(), v.node.child(quarter)), residency);
        else if (quarter_casts(v, quarter))
            own_quarters |= 1u << quarter;
    }
    if (own_quarters == 0) return;
    entries_.push_back({draw_list_.entry(v, own_quarters, eye_, residency),
                        sun_box(view_->sun.axes, view_->eye_m, frame_.box(v))});
}

}  // namespace ridgeline::select
