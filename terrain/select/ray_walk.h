// Where a ray meets the ground of a quadtree whose deepest nodes are grids of bilinear cells. Internal to the
// room; one thread.
//
// Who has the ground (RayGround) says how deep it goes: ground made below the source's finest level is deeper
// nodes with bounds of their own.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "ridgeline/base/result.h"
#include "ridgeline/io/grid.h"
#include "ridgeline/io/node_id.h"

namespace ridgeline::select {

// Part of a ray, by distance along it.
struct Interval {
    double from = 0.0, to = 0.0;
    bool empty() const { return !(from <= to); }
};

// In lattice coordinates: columns, rows and metres of height per metre of the ray.
struct LatticeRay {
    glm::dvec3 origin{0.0};
    glm::dvec3 slope{0.0};
    glm::dvec3 at(double t) const { return origin + t * slope; }
};

// One node's heights at the corners of its cells, as they lie in its tile.
struct CellHeights {
    int stride = 0;
    const std::int32_t* quanta = nullptr;    // of the node's north-western corner
    const std::uint8_t* valid = nullptr;     // likewise; null where all are
    double offset_m = 0.0, quantum_m = 1.0;  // height_m = offset_m + quanta * quantum_m
};

struct HeightRange {
    double least_m = 0.0, most_m = 0.0;
};

class RayGround {
  public:
    virtual ~RayGround() = default;
    // Of the nodes that have cells.
    virtual int deepest_level() const = 0;
    // Of all ground in a node; empty where it has none, or does not exist.
    virtual Result<std::optional<HeightRange>> range(io::NodeId node) = 0;
    // Of a deepest node that has ground; stands until the next call. quads() of them a side.
    virtual Result<CellHeights> cells(io::NodeId node) = 0;
};

class RayWalk {
  public:
    enum class Ends {
        at_surface,    // where the ray crosses or touches the surface, from whichever side
        under_ground,  // where the ray is under the surface for the first time
    };
    RayWalk(RayGround& ground, const io::Grid& grid, Ends ends) : ground_(ground), grid_(grid), ends_(ends) {}

    // The least such t in `reach`, or none. The ray is best when its origin lies near the ground: distances
    // along it are told to a double's rounding.
    Result<std::optional<double>> first(const LatticeRay& ray, Interval reach);

  private:
    // Which side of the ground the ray was on, and until where it is known.
    struct Side {
        double until = -std::numeric_limits<double>::infinity();
        double over_m = 0.0;
    };

    void visit(io::NodeId node, Interval t);
    void visit_children(io::NodeId node, Interval t);
    void visit_cells(io::NodeId node, Interval t);
    bool meets_cell(const CellHeights& cells, const LatticeRay& local, int column, int row, Interval t);
    bool has_crossed(double t, double over_m) const;
    LatticeRay ray_in(io::NodeId node) const;
    Interval clipped_to(io::NodeId node, const HeightRange& heights, Interval t) const;

    RayGround& ground_;
    const io::Grid& grid_;
    const Ends ends_;
    LatticeRay ray_;
    Side side_;
    std::optional<double> met_;
    std::optional<Error> failure_;
};

// Cuts the part of an interval on which origin + t * slope lies within [low, high].
Interval clipped(Interval t, double origin, double slope, double low, double high);

}  // namespace ridgeline::select
