// What the horizon reads of resident nodes while a selection runs: their reliefs, and near the eye the mesh
// itself.
//
// The owner of the chunks implements it; what it returns must stand still until the selection has run (under
// a SelectionLease, for the pager's chunks). Called on whichever threads the selection's jobs run.
#pragma once

#include <cstdint>

#include "ridgeline/io/chunk.h"

namespace ridgeline::select {

class GroundSource {
  public:
    virtual ~GroundSource() = default;
    // Of a resident node, by its place in linear order; never empty.
    virtual io::ChunkView chunk(std::uint32_t index) const = 0;
};

}  // namespace ridgeline::select
