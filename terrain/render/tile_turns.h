// How much the quadtree's tiles still look like those above them, as their cells' levels have to know.
//
// A tile's heights turn from its parent's look when it has just come (virtual_texture.h). A tile may also have been there
// and not been drawn: ground behind a ridge, which the eye now sees. Drawn with all its errors at once, it would divide
// where nothing did a frame before; so it turns as a new one does, where the picture before could show its ground. What
// comes into the picture from beside it is there at once.
//
// Render thread only; after construction nothing allocates.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "ridgeline/base/geometry.h"
#include "ridgeline/io/grid.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/render/quadtree_blocks.h"
#include "ridgeline/select/view.h"

namespace ridgeline::render {

// When a picture is made.
struct TurningMoment {
    std::uint32_t frame = 0;  // from one to the next by one
    pager::Seconds now{0.0};
    // Over which a tile turns; 0: it does not.
    pager::Seconds fade{0.0};
};

// What it may show.
struct TurningView {
    select::EyeFrame eye;
    glm::dvec3 eye_m{0.0};
    Frustum visible;
    Box terrain_m;
};

class TileTurns {
  public:
    // slots: of the heights' texture.
    TileTurns(const io::Grid& grid, int slots);

    // Of the tiles that a frame draws, by slot, from 1, all like the one above, to 0; until the next call. height_fades:
    // likewise, of the tiles' heights. A frame may ask again, for other views: its last one counts for the next frame.
    std::span<const float> turn(std::span<const SlottedTile> tiles, std::span<const float> height_fades,
                                const TurningMoment& moment, const TurningView& view);

  private:
    // When a slot's tile was drawn.
    struct Drawn {
        io::NodeId node{-1, 0, 0};
        std::uint32_t last = 0;                 // frame
        std::optional<pager::Seconds> turning;  // since when
    };
    // Of a frame.
    struct Seen {
        std::uint32_t frame = 0;
        TurningView view;
    };

    static float still_to_turn(const Drawn& drawn, const TurningMoment& moment);
    bool could_be_seen_before(io::NodeId node, std::uint32_t frame) const;

    io::Grid grid_;
    std::vector<Drawn> drawn_;  // by slot
    std::vector<float> turned_;
    std::optional<Seen> last_, before_;
};

}  // namespace ridgeline::render
