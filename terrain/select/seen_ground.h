// What a frame sees of the ground, as the tile schedule wants it: from what its selection draws, narrowed by
// what the GPU saw in an earlier frame.
//
// The nodes that a selection draws hold all that the frame can show, but more of it lies behind hills and
// beside the picture. What the GPU read back is exact, but of a frame some frames ago. While the camera has
// hardly moved since, that counts alone; after a turn or a leap, both count, and before the first readback
// the nodes alone. Ground so near that it may be seen before its tiles have come counts besides, whatever hides it.
//
// One thread at a time; the view that see() returns points into this object.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "ridgeline/select/ground_mask.h"
#include "ridgeline/select/selection.h"
#include "ridgeline/select/tile_schedule.h"
#include "ridgeline/select/view.h"

namespace ridgeline::select {

// The eye and the directions to what it sees: whether two frames show the same ground, and nearly as large.
struct Sight {
    glm::dvec3 eye_m{0.0};
    // The picture's corners: directions of unit length, level by level from the lower left.
    std::array<glm::dvec3, 4> corners{};

    // Whether what this one sees lies no more than a cell of the lattice's masks beside what `earlier` saw,
    // but for what came out from behind hills.
    bool is_close_to(const Sight& earlier, const GroundLattice& lattice) const;
};
Sight sight_of(const Camera& camera);

// What the GPU saw of the ground in a frame.
struct GroundReadback {
    std::uint64_t frame = 0;
    Sight sight;
    GroundRectangle rectangle;  // empty: no ground in the picture
    GroundMask mask;            // about the frame's eye

    // Whether a schedule comes to the same with either.
    bool shows_the_same(const GroundReadback& other) const;
};

class SeenGround {
  public:
    // terrain: bounds of all ground.
    SeenGround(const io::TerrainInfo& info, const GroundRectangle& terrain)
        : info_(info), lattice_(terrain) {}

    // late: the newest readback, or null.
    GroundView see(const View& view, const Sight& sight, const SelectionResult& selection,
                   const GroundReadback* late);
    const GroundLattice& lattice() const { return lattice_; }

  private:
    void add_readback(const GroundReadback& late, GroundView& seen);
    void add_drawn(const View& view, const SelectionResult& selection, GroundView& seen);

    const io::TerrainInfo& info_;
    GroundLattice lattice_;
    std::array<GroundMask, 2> masks_;
};

}  // namespace ridgeline::select
