// Between which heights the ground of an area lies, from the records of the heights' quadtree.
//
// A handful of records at most: those of the level whose nodes are as large as the area. Any thread; the
// records outlive it.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "ridgeline/io/node_record.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/select/ground_mask.h"

namespace ridgeline::select {

class GroundBounds {
  public:
    // records: as in Store::records().
    GroundBounds(const io::TerrainInfo& info, std::span<const io::NodeRecord> records);

    struct Quanta {
        std::int32_t lowest = 0, highest = 0;
    };
    // The finest level whose nodes are no smaller than an area of this size, in metres; 0 where none is.
    int level_for(const glm::dvec2& size_m) const;
    // Of the nodes of a level that an area touches; nothing where they have no data. The bounds of an area
    // hold those of its parts asked for at the same level or at a finer one.
    std::optional<Quanta> of(const GroundRectangle& area, int level) const;
    // As drawn.
    double height_m(std::int32_t quanta, double exaggeration) const {
        return offset_m_ + quanta * quantum_m_ * exaggeration;
    }
    // All ground there is.
    const GroundRectangle& terrain() const { return terrain_; }

  private:
    io::Grid grid_;
    std::span<const io::NodeRecord> records_;
    GroundRectangle terrain_;
    double offset_m_, quantum_m_;
    std::array<glm::dvec2, io::Grid::kMaxLevels> side_m_{};  // of a level's nodes
};

}  // namespace ridgeline::select
