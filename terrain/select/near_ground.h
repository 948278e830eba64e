// The finest meshes about the eye, as heights at every lattice point: near the ground, most of what is hidden
// is hidden by the next few hundred metres, of which reliefs know too little. Internal to the room.
//
// A few nodes' heights are kept from frame to frame. A chunk's mesh never changes, so what was kept of one
// stays true when the chunk leaves and comes back.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/io/chunk.h"
#include "ridgeline/select/selection.h"

namespace ridgeline::select {

class NearGround {
  public:
    static constexpr int kMostNodes = 9;

    // quads: lattice cells along a node's side.
    explicit NearGround(int quads);

    // Heights of the unmorphed mesh in quanta, (quads + 1)^2, row by row from the north-west. The slot stays
    // this node's until kMostNodes - 1 others have been asked for. chunk: of the finest level.
    int find(NodeIndex node, const io::ChunkView& chunk);
    std::span<const float> quanta(int slot) const { return slots_[static_cast<std::size_t>(slot)].quanta; }

  private:
    struct Slot {
        NodeIndex node = ~NodeIndex{0};
        std::uint32_t used = 0;
        std::vector<float> quanta;
    };
    void fill(const io::ChunkView& chunk, std::span<float> quanta) const;

    int quads_;
    std::uint32_t clock_ = 0;
    std::array<Slot, kMostNodes> slots_;
};

}  // namespace ridgeline::select
