#include "ridgeline/select/drawn_report.h"

namespace ridgeline::select {
namespace {

NodeFate fate_of(const NodeReport& report, bool finer_wanted) {
    if (report.in_view == 0) return NodeFate::out_of_view;
    if (report.drawn == 0) return report.resident ? NodeFate::hidden : NodeFate::hidden_missing;
    if (!report.resident) return NodeFate::missing;
    if (finer_wanted) return NodeFate::stands_in;
    return report.drawn == report.quarters ? NodeFate::drawn : NodeFate::drawn_in_part;
}

}  // namespace

void DrawnReport::add(std::span<const SweptLeaf> leaves) {
    for (const SweptLeaf& leaf : leaves) {
        if (!frame_.record(leaf.node.index).has_data()) continue;
        NodeReport report{.node = leaf.node.node,
                          .quarters = leaf.quarters,
                          .in_view = leaf.in_view,
                          .drawn = leaf.now,
                          .resident = leaf.kind == SweptLeaf::Kind::ground,
                          .ahead = leaf.now == 0 && leaf.soon != 0};
        report.fate = fate_of(report, tree_.has(leaf.node.index, FrameTree::kSplit));
        if (!report.resident) report.drawn = 0;
        nodes_.push_back(report);
    }
}

void DrawnReport::add(const Visit& v, Where where, const glm::ivec2& eye_place) {
    if (!frame_.record(v.index).has_data()) return;
    unsigned own = 0;
    for (const int turn : DrawnTree::kTurns) {
        const int quarter = drawn_.nearest_quarter(v.node, eye_place) ^ turn;
        if (!frame_.quarter_exists(v.node, quarter)) continue;
        if (drawn_.child_drawn(v.node, quarter))
            add(visit(frame_.grid(), v.node.child(quarter)), where, eye_place);
        else
            own |= 1u << quarter;
    }
    if (own == 0 || (where == Where::outside_the_zone && tree_.has(v.index, FrameTree::kInZone))) return;
    add_leaf(v, own);
}

void DrawnReport::add_leaf(const Visit& v, unsigned quarters) {
    NodeReport report{.node = v.node,
                      .quarters = static_cast<std::uint8_t>(quarters),
                      .resident = tree_.has(v.index, FrameTree::kResident)};
    if (tree_.has(v.index, FrameTree::kInView))
        for (int q = 0; q < io::kQuarters; ++q)
            if ((quarters >> q & 1u) != 0 && drawn_.quarter_in_view(v, q, visible_))
                report.in_view = static_cast<std::uint8_t>(report.in_view | 1u << q);
    report.drawn = report.in_view;
    report.ahead = report.in_view == 0 && tree_.has(v.index, FrameTree::kInZone);
    report.fate = fate_of(report, tree_.has(v.index, FrameTree::kSplit));
    if (!report.resident) report.drawn = 0;
    nodes_.push_back(report);
}

}  // namespace ridgeline::select
