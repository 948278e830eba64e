// What the horizon's panels show of one frame: the ground about the eye as selection cut it up, what became
// of each part, and the horizon over which the rest is seen. Plain values; whoever fills them keeps the
// memory from frame to frame.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "ridgeline/base/units.h"
#include "ridgeline/select/node_report.h"
#include "ridgeline/select/view.h"

namespace ridgeline::stage {

// Heights of a node's ground as the horizon knows them: maxima of square cells, row by row from the
// north-west. The bytes are the pager's and stay until the next frame is selected.
struct SceneGround {
    std::span<const std::uint8_t> codes;  // of all cells of the node that has them
    int stride = 0;                       // its cells a row
    glm::ivec2 from{0};                   // the part of them that is this node
    int cells = 0;                        // ... a side; 0: nothing is known
    float base_m = 0.0f;                  // of code 0, over the eye
    float step_m = 0.0f;                  // a code more
};

struct SceneNode {
    select::NodeReport report;
    glm::vec2 corner_m{0.0f};  // north-western: east and north of the eye
    glm::vec2 side_m{0.0f};    // to the east, to the south
    SceneGround ground;
};

struct HorizonScene {
    static constexpr std::size_t kProfileSteps = 1024;

    select::HorizonMode mode = select::HorizonMode::off;  // as chosen
    bool in_use = false;                                  // else nothing is hidden in this frame
    Angle heading;                                        // clockwise from north
    Angle pitch;
    glm::vec2 half_tangents{1.0f};  // of the picture: across, up
    // The terrain about the eye: east and north.
    glm::vec2 least_m{0.0f}, most_m{0.0f};
    float lowest_m = 0.0f, highest_m = 0.0f;  // over the eye
    float finest_side_m = 1.0f;               // of a node of the finest level

    // Tangents of elevation over azimuths from -profile_reach to profile_reach about the heading
    // (select/horizon_profile.h).
    std::array<float, kProfileSteps> profile{};
    Angle profile_reach;

    std::vector<SceneNode> nodes;
    std::array<std::uint32_t, select::kNodeFates> counts{};  // of nodes, by fate
    std::uint32_t ahead = 0;                                 // ... of those out of view: may come into it
};

}  // namespace ridgeline::stage
