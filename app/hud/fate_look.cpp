#include "ridgeline/app/hud/fate_look.h"

namespace ridgeline::app {
namespace {

using select::NodeFate;

constexpr FateLook kDrawn{IM_COL32(255, 190, 70, 92), IM_COL32(255, 214, 130, 225)};
constexpr FateLook kMissing{IM_COL32(226, 88, 20, 128), IM_COL32(255, 122, 50, 255)};
constexpr FateLook kHidden{IM_COL32(20, 44, 122, 150), IM_COL32(120, 164, 250, 165)};
constexpr FateLook kHiddenMissing{IM_COL32(34, 12, 58, 170), IM_COL32(206, 124, 190, 112)};
constexpr FateLook kAhead{IM_COL32(0, 122, 92, 92), IM_COL32(64, 206, 166, 150)};
constexpr FateLook kOutside{IM_COL32(12, 15, 19, 118), IM_COL32(214, 222, 230, 40)};

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
    const auto plain = [](const char* name, std::uint32_t nodes, const FateLook& look) {
        return LegendEntry{name, nodes, look, look.fill};
    };
    return {plain("drawn", count(NodeFate::drawn), kDrawn),
            LegendEntry{"drawn in part", count(NodeFate::drawn_in_part), kDrawn,
                        scene.in_use ? kHidden.fill : kOutside.fill},
            plain("hidden", count(NodeFate::hidden), kHidden),
            plain("hidden, missing", count(NodeFate::hidden_missing), kHiddenMissing),
            plain("missing", count(NodeFate::stands_in) + count(NodeFate::missing), kMissing),
            plain("paged ahead", scene.ahead, kAhead),
            plain("out of view", count(NodeFate::out_of_view), kOutside)};
}

}  // namespace ridgeline::app
