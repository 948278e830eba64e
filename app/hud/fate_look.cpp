#include "ridgeline/app/hud/fate_look.h"

namespace ridgeline::app {
namespace {

using select::NodeFate;

constexpr FateLook kDrawn{IM_COL32(255, 190, 70, 78), IM_COL32(255, 206, 110, 235)};
constexpr FateLook kMissing{IM_COL32(226, 88, 20, 150), IM_COL32(255, 122, 50, 255)};
constexpr FateLook kHidden{IM_COL32(12, 24, 74, 178), IM_COL32(112, 146, 232, 150)};
constexpr FateLook kHiddenMissing{IM_COL32(58, 16, 66, 190), IM_COL32(222, 132, 186, 210)};
constexpr FateLook kAhead{IM_COL32(0, 92, 76, 120), IM_COL32(52, 190, 152, 175)};
constexpr FateLook kOutside{IM_COL32(12, 15, 19, 150), IM_COL32(206, 214, 222, 46)};

}  // namespace

FateLook look_of(const select::NodeReport& report) {
    switch (report.fate) {
        case NodeFate::drawn:
        case NodeFate::drawn_in_part:
            return kDrawn;
        case NodeFate::stands_in:
        case NodeFate::missing:
            return kMissing;
        case NodeFate::hidden:
            return kHidden;
        case NodeFate::hidden_missing:
            return kHiddenMissing;
        default:
            return report.ahead ? kAhead : kOutside;
    }
}

ImU32 fill_of(const select::NodeReport& report, int quarter) {
    const bool drawn = (report.drawn >> quarter & 1u) != 0, in_view = (report.in_view >> quarter & 1u) != 0;
    if (drawn || report.fate == NodeFate::missing || report.fate == NodeFate::hidden_missing ||
        report.fate == NodeFate::out_of_view)
        return look_of(report).fill;
    return in_view ? kHidden.fill : kOutside.fill;
}

std::array<LegendEntry, kLegendEntries> legend_of(const HorizonScene& scene) {
    const auto count = [&](NodeFate fate) { return scene.counts[static_cast<std::size_t>(fate)]; };
    return {{{"drawn", count(NodeFate::drawn), kDrawn},
             {"drawn in part", count(NodeFate::drawn_in_part), {kHidden.fill, kDrawn.line}},
             {"hidden", count(NodeFate::hidden), kHidden},
             {"hidden, missing", count(NodeFate::hidden_missing), kHiddenMissing},
             {"missing", count(NodeFate::stands_in) + count(NodeFate::missing), kMissing},
             {"paged ahead", scene.ahead, kAhead},
             {"out of view", count(NodeFate::out_of_view), kOutside}}};
}

}  // namespace ridgeline::app
