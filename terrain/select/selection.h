// Selection: which nodes a frame draws, how each of them meets its neighbours, and which tiles are wanted.
//
// Three trees, coarse to fine. The ideal tree splits where the criterion says, all around the eye, and keeps
// edge neighbours within one level. The drawn tree is the part of it whose data is there: a missing child is
// drawn as its quarter of the parent. The wanted tree is what of the ideal one lies in view, close about the
// eye, or where it can come into view. docs/selection.md tells why the result is watertight.
//
// What the ground in front hides is neither drawn nor wanted, and where it is missing it counts as present
// (horizon_sweep.h, assumed_hidden.h).
//
// One thread at a time (a job), which may hand out parts to other workers; the residency and the ground are
// read during run() only. Results live in the Selection until the next run(). Memory is per node and sized at
// construction; after the first frames run() allocates nothing.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "ridgeline/io/chunk.h"
#include "ridgeline/io/grid.h"
#include "ridgeline/io/node_record.h"
#include "ridgeline/io/node_residency.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/select/criterion.h"
#include "ridgeline/select/ground_source.h"
#include "ridgeline/select/horizon.h"
#include "ridgeline/select/node_report.h"
#include "ridgeline/select/view.h"

namespace ridgeline::jobs {
class JobSystem;
}

namespace ridgeline::select {

// Place of a node in linear order (Grid::linear).
using NodeIndex = std::uint32_t;

// A node's data as the render thread has it.
using io::NodeResidency;
// One per node, in linear order.
using Residency = std::span<const NodeResidency>;

// How vertices of one class morph: w = max(clamp(distance * scale + bias, 0, 1), fade), where distance is the
// eye's to the vertex at its own height. Twelve bytes, as the GPU reads them (std430).
struct MorphParameters {
    float scale = 0.0f;  // per metre
    float bias = 0.0f;
    float fade = 0.0f;
};
static_assert(sizeof(MorphParameters) == 12);
// By vertex class (io/chunk.h).
using MorphTable = std::array<MorphParameters, io::vertex_class::kCount>;
static_assert(sizeof(MorphTable) == 216);

// Which triangles close a quarter's side.
enum class SideUse : std::uint8_t {
    none,   // the quarter is not drawn here
    plain,  // the chunk's own edge
    fan,    // with the border vertices of the finer level, which is on the other side
};

struct DrawEntry {
    io::NodeId node;
    NodeIndex index = 0;
    std::uint8_t quarters = 0;  // bit q: quarter q is drawn
    std::array<std::array<SideUse, io::kSides>, io::kQuarters> sides{};
    glm::ivec2 origin{0};  // the node's north-western corner minus EyeFrame::cell, finest samples
    MorphTable morph{};
};

// What the sun's shadow maps draw of one node.
struct ShadowCaster {
    DrawEntry entry;  // its own quarters, in view or not
    SunBox bounds_m;
};

struct WantedTile {
    NodeIndex index = 0;
    bool visible = false;   // or close about the eye; else in the extension zone, or wanted for its shadow
    bool resident = false;  // to be kept, not to be asked for
    // Pixels by which the parent's mesh may miss the terrain here: what its absence costs.
    float error_px = 0.0f;
};

// What telemetry writes of a selection.
struct SelectionCounters {
    std::uint32_t visited = 0;         // nodes looked at, of all three trees
    std::uint32_t frustum_culled = 0;  // leaves of the drawn tree, and branches as one, outside the frustum
    std::uint32_t horizon_culled = 0;  // leaves of the drawn tree in view that the ground in front hides
    std::uint32_t assumed = 0;         // ... of them those whose data is missing
    std::uint32_t horizon_rounds = 0;  // 0: the horizon could hide nothing for this eye, or is off
    std::uint32_t drawn = 0;           // draw entries
    std::uint32_t wanted = 0;          // before the capacity cuts
    std::uint32_t missing = 0;         // wanted, visible, not resident
    std::uint32_t held_back = 0;
    std::uint32_t casters = 0;    // shadow casters
    std::uint64_t triangles = 0;  // estimate: a node's triangles spread evenly over its quarters
    int ideal_finest_level = 0;
    int drawn_finest_level = 0;
};

struct SelectionResult {
    EyeFrame eye;
    std::span<const DrawEntry> draws;  // front to back
    // Empty without shadows.
    std::span<const ShadowCaster> casters;
    // Visible before extension, coarse before fine, larger error first; so ancestors come before descendants.
    std::span<const WantedTile> wanted;
    // Resident nodes on which the picture rests (drawn ones and their ancestors): not to be evicted.
    std::span<const NodeIndex> used;
    // Resident and wanted for this view, but a neighbour's missing data keeps them out: whoever keeps the
    // fades sets theirs back to 1, so that they morph in when they are let in.
    std::span<const NodeIndex> held_back;
    // The next run assumes other missing nodes to be hidden, and may draw others, also if nothing else
    // changes.
    bool unsettled = false;
    SelectionCounters counters;
};

// What is drawn close about the eye.
struct GroundAbout {
    // Over the eye, in the drawn frame; never under the floor asked for.
    double highest_m = 0.0;
    bool complete = true;  // there is ground to all sides
};

struct SelectionOptions {
    // Wanted tiles passed on; the least urgent beyond it are cut.
    std::size_t wanted_capacity = 8192;
    // Shares the horizon's work; null: everything on the calling thread.
    jobs::JobSystem* jobs = nullptr;
};

class Selection {
  public:
    // The spans and references outlive the Selection; records as in Store::records().
    Selection(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
              const Criterion& criterion, const SelectionOptions& options = {});
    ~Selection();
    Selection(Selection&&) noexcept;
    Selection& operator=(Selection&&) noexcept;

    // residency: one entry per node. Level 0 is drawn where it is resident, whatever the view. ground: of the
    // resident nodes; without it the horizon is off.
    const SelectionResult& run(const View& view, Residency residency, const GroundSource* ground = nullptr);
    const SelectionResult& result() const;

    // How high the last run's surface stands within View::near_reach_m of its eye to any side, in view or
    // not; what stays under floor_m does not matter. residency, ground: as the last run had them.
    GroundAbout ground_about(Residency residency, const GroundSource& ground, double floor_m) const;

    // The entry with which the last run would draw a place, were it in view: of the finest resident node of
    // the drawn tree there, with all its quarters. False outside the terrain and over nodes without data.
    // residency: as the last run had it.
    bool entry_at(double column, double row, Residency residency, DrawEntry& entry) const;

    // Of the last run, for pictures of it. The horizon's columns: of one slice, as SliceView counts them;
    // empty where none of the picture lies.
    std::span<const float> horizon_columns(int slice) const;
    // The heading to which the slices are turned.
    const glm::dvec2& heading() const;
    // Whether the horizon was used; else nothing is hidden, and there are no columns.
    bool uses_horizon() const;
    // The leaves of the whole drawn tree, those in the zone front to back.
    void report(std::vector<NodeReport>& nodes) const;

    const io::Grid& grid() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ridgeline::select
