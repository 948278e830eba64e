// Literature: the horizon paper (3.2) for potential silhouettes. We differ in what a silhouette lies under
// (the lower envelope of all morph states, not one mesh), in its course (a ridge found by dynamic
// programming), and in that it is exact: its segments are checked against the envelope at every triangle edge
// that they cross.
#include "ridgeline/io/relief_maker.h"

#include <algorithm>
#include <cmath>

#include "ridgeline/io/relief_codec.h"
#include "ridgeline/io/relief_lattice.h"

namespace ridgeline::io {
namespace {

// Whether there is ground wherever a segment touches a cell of the node, borders included.
class GroundMask {
  public:
    GroundMask(const HeightsTile& heights, ReliefAxis axis, int segment_quads)
        : quads_(heights.quads), segment_quads_(segment_quads) {
        const auto side = static_cast<std::size_t>(quads_) + 1;
        invalid_before_.assign(side * side, 0);
        for (int along = 0; along < quads_; ++along)
            for (int across = 0; across < quads_; ++across) {
                const int at = axis == ReliefAxis::east ? across * quads_ + along : along * quads_ + across;
                const int invalid = heights.cell_valid[static_cast<std::size_t>(at)] == 0 ? 1 : 0;
                before(along + 1, across + 1) =
                    invalid + before(along, across + 1) + before(along + 1, across) - before(along, across);
            }
    }

    bool operator()(const RidgeSearch::Segment& segment) const {
        const int first = std::max(segment.along - 1, 0);
        const int last = std::min(segment.along + segment_quads_, quads_ - 1);
        const auto [least, most] = std::minmax(segment.from, segment.to);
        if (all_valid(first, last, least - 1, most)) return true;
        for (int cell = first; cell <= last; ++cell) {
            const int start = std::max(cell, segment.along);
            const int end = std::min(cell + 1, segment.along + segment_quads_);
            const int near = std::min(across_above(segment, start), across_above(segment, end)) - 1;
            const int far = std::max(across_below(segment, start), across_below(segment, end));
            if (!all_valid(cell, cell, near, far)) return false;
        }
        return true;
    }

  private:
    // Where the segment is at a column, rounded down and up.
    int across_below(const RidgeSearch::Segment& segment, int along) const {
        return (segment.from * segment_quads_ + rise(segment, along)) / segment_quads_;
    }
    int across_above(const RidgeSearch::Segment& segment, int along) const {
        return (segment.from * segment_quads_ + rise(segment, along) + segment_quads_ - 1) / segment_quads_;
    }
    static int rise(const RidgeSearch::Segment& segment, int along) {
        return (segment.to - segment.from) * (along - segment.along);
    }
    // The cells of a rectangle, both ends included, as far as they are the node's.
    bool all_valid(int first_along, int last_along, int first_across, int last_across) const {
        const int low = std::max(first_across, 0), high = std::min(last_across, quads_ - 1) + 1;
        return before(last_along + 1, high) - before(first_along, high) - before(last_along + 1, low) +
                   before(first_along, low) ==
               0;
    }
    int before(int along, int across) const {
        return invalid_before_[static_cast<std::size_t>(along * (quads_ + 1) + across)];
    }
    int& before(int along, int across) {
        return invalid_before_[static_cast<std::size_t>(along * (quads_ + 1) + across)];
    }

    int quads_, segment_quads_;
    std::vector<int> invalid_before_;  // invalid cells north-west of a lattice point (a summed-area table)
};

// The code of the next step on or under a height; none under the node's lowest.
std::uint16_t chain_code(double quanta, const HeightSteps& steps, const NodeRecord& record) {
    if (quanta < record.min_quanta) return chain_height::kHidesNothing;
    int step = steps.below(quanta);
    while (step >= 0 && chain_height::quanta(chain_step::code(step), record) > quanta) --step;
    return step < 0 ? chain_height::kHidesNothing : chain_step::code(step);
}

// The least code that is no lower than the height.
std::uint8_t maximum_code(std::int32_t quanta, const HeightSteps& steps, const NodeRecord& record) {
    int code = steps.below(quanta);
    while (code < kMostMaximum &&
           maximum_quanta(static_cast<std::uint8_t>(code), record) < static_cast<float>(quanta))
        ++code;
    return static_cast<std::uint8_t>(code);
}

// What a segment must lie under: its envelope's points.
using Limits = std::vector<Envelope::Point>;

// How high a segment may end (or start) that starts (or ends) at a height; infinite where nothing limits it.
double highest_end(const Limits& limits, double start) {
    double highest = std::numeric_limits<double>::infinity();
    for (const auto& [along, quanta] : limits)
        if (along > 0.0) highest = std::min(highest, start + (quanta - start) / along);
    return highest;
}
double highest_start(const Limits& limits, double end) {
    double highest = std::numeric_limits<double>::infinity();
    for (const auto& [along, quanta] : limits)
        if (along < 1.0) highest = std::min(highest, end + (quanta - end) / (1.0 - along));
    return highest;
}

// Where the segment sticks out most, and how far; nothing (0) where it lies under its limits.
Envelope::Point most_over(const Limits& limits, double start, double end) {
    Envelope::Point most;
    for (const auto& [along, quanta] : limits) {
        const double over = start + along * (end - start) - quanta;
        if (over > most.quanta) most = {along, over};
    }
    return most;
}

// The end that is nearer to where the segment sticks out sinks more; that never hurts its other segment.
void lower_segment(const Limits& limits, double floor, double& start, double& end) {
    constexpr int kRounds = 4;
    const double highest_start_yet = start, highest_end_yet = end;
    for (int round = 0; round < kRounds; ++round) {
        const auto [along, over] = most_over(limits, start, end);
        const double share = over / (along * along + (1.0 - along) * (1.0 - along));
        start -= share * (1.0 - along);
        end -= share * along;
    }
    const double rest = most_over(limits, start, end).quanta;
    start -= rest;
    end -= rest;
    // No limit lies under the floor, so a segment that begins there may end there.
    if (start < floor) {
        start = floor;
        end = std::min(highest_end_yet, highest_end(limits, floor));
    } else if (end < floor) {
        end = floor;
        start = std::min(highest_start_yet, highest_start(limits, floor));
    }
}

}  // namespace

void ReliefBounds::add_child(const ReliefShape& shape, int quarter, const ReliefBounds& child) {
    widen(child.min_quanta);
    widen(child.max_quanta);
    const int cells = shape.cells, half = cells / 2;
    if (maxima.empty()) maxima.assign(static_cast<std::size_t>(cells * cells), kNothing);
    std::int32_t* corner =
        &maxima[static_cast<std::size_t>((quarter >> 1) * half * cells + (quarter & 1) * half)];
    for (int row = 0; row < half; ++row)
        for (int column = 0; column < half; ++column) {
            const std::int32_t* upper = &child.maxima[static_cast<std::size_t>(2 * row * cells + 2 * column)];
            const std::int32_t* lower = upper + cells;
            corner[row * cells + column] = std::max({upper[0], upper[1], lower[0], lower[1]});
        }
}

void ReliefMaker::append(const Grid& grid, NodeId node, const ReliefShape& shape, ChunkScratch& scratch,
                         const HeightsTile& heights, EncodedChunk& encoded, ReliefBounds& bounds,
                         std::vector<std::uint8_t>& payload) {
    quads_ = grid.quads();
    bounds.widen(encoded.min_quanta);
    bounds.widen(encoded.max_quanta);
    encoded.min_quanta = bounds.min_quanta;
    encoded.max_quanta = bounds.max_quanta;
    NodeRecord record;
    record.min_quanta = bounds.min_quanta;
    record.max_quanta = bounds.max_quanta;
    envelope_.begin(grid, node, scratch.state());
    bytes_.resize(shape.bytes());
    const ReliefView relief(bytes_, shape);
    find_maxima(scratch.state().bisection, grid.step(node.level), record, bounds, relief);
    find_silhouettes(heights, record, relief);
    encode_relief(relief, record, heights, payload);
}

// The bisection's triangles and the lattice's cells are nested, so over a lattice cell the upper envelope is
// greatest at a corner or at a vertex.
void ReliefMaker::find_maxima(const Bisection& bisection, std::int64_t step, const NodeRecord& record,
                              ReliefBounds& bounds, ReliefView relief) {
    const ReliefShape& shape = relief.shape();
    greatest_by_cell(shape, quads_, envelope_.upper_lattice().data(), quads_ + 1, row_, greatest_);
    if (step > 1) raise_by_vertices(bisection, static_cast<std::uint32_t>(step), shape);
    bounds.maxima.resize(greatest_.size(), ReliefBounds::kNothing);
    const HeightSteps steps(record, kMostMaximum);
    for (std::size_t cell = 0; cell < greatest_.size(); ++cell) {
        // No higher than the bounds: fans are rounded, but to heights within them.
        const double most =
            std::min(greatest_[cell] + envelope_.fan_rise(), static_cast<double>(bounds.max_quanta));
        std::int32_t& maximum = bounds.maxima[cell];
        maximum = std::max(maximum, static_cast<std::int32_t>(std::ceil(most)));
        relief.maxima()[cell] = maximum_code(maximum, steps, record);
    }
}

// Vertices between the lattice's points count for every cell that they touch.
void ReliefMaker::raise_by_vertices(const Bisection& bisection, std::uint32_t step,
                                    const ReliefShape& shape) {
    cells_of_quad_.assign(static_cast<std::size_t>(quads_), {shape.cells, -1});
    for (int cell = 0; cell < shape.cells; ++cell) {
        const LatticeRange quads = cell_range(shape, quads_, cell);
        for (int quad = quads.first; quad < quads.last; ++quad) {
            LatticeRange& cells = cells_of_quad_[static_cast<std::size_t>(quad)];
            cells = {std::min(cells.first, cell), cell};
        }
    }
    // On a line between two quads a vertex touches both.
    const auto cells_at = [&](std::uint32_t place) {
        const std::uint32_t last = std::min(place / step, static_cast<std::uint32_t>(quads_) - 1);
        const std::uint32_t first = place % step == 0 && place > 0 ? place / step - 1 : last;
        return LatticeRange{cells_of_quad_[first].first, cells_of_quad_[last].last};
    };
    const auto& vertices = bisection.vertices();
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        if (((vertices[v].x | vertices[v].y) & (step - 1)) == 0) continue;
        const LatticeRange columns = cells_at(vertices[v].x), rows = cells_at(vertices[v].y);
        for (int row = rows.first; row <= rows.last; ++row)
            for (int column = columns.first; column <= columns.last; ++column) {
                double& greatest = greatest_[static_cast<std::size_t>(row * shape.cells + column)];
                greatest = std::max(greatest, static_cast<double>(envelope_.upper(v)));
            }
    }
}

void ReliefMaker::find_silhouettes(const HeightsTile& heights, const NodeRecord& record, ReliefView relief) {
    const ReliefShape& shape = relief.shape();
    const auto lattice = envelope_.lower_lattice();
    const auto stride = static_cast<std::size_t>(quads_) + 1;
    // Where only samples beyond the node are invalid, all its cells are valid.
    const bool has_voids =
        std::find(heights.cell_valid.begin(), heights.cell_valid.end(), 0) != heights.cell_valid.end();
    lattice_.resize(lattice.size());
    for (const ReliefAxis axis : {ReliefAxis::east, ReliefAxis::south}) {
        for (std::size_t along = 0; along < stride; ++along)
            for (std::size_t across = 0; across < stride; ++across) {
                const std::size_t at =
                    axis == ReliefAxis::east ? across * stride + along : along * stride + across;
                lattice_[along * stride + across] = static_cast<float>(lattice[at] - record.min_quanta);
            }
        RidgeSearch::Ground ground;
        if (has_voids) ground = GroundMask(heights, axis, quads_ / shape.steps);
        ridges_.find(shape, quads_, lattice_, ground);
        for (int band = 0; band < shape.bands; ++band) find_silhouette(axis, band, record, relief);
    }
}

void ReliefMaker::find_silhouette(ReliefAxis axis, int band, const NodeRecord& record, ReliefView relief) {
    const ReliefShape& shape = relief.shape();
    const auto places = ridges_.chain(band);
    const auto steps = static_cast<std::size_t>(shape.steps);
    const int length = quads_ / shape.steps;
    limits_.resize(steps);
    chain_.assign(steps + 1, std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < steps; ++i) {
        Limits& limits = limits_[i];
        limits.clear();
        if (places[i] == RidgeSearch::kNowhere || places[i + 1] == RidgeSearch::kNowhere) continue;
        const int from = static_cast<int>(i) * length, to = from + length;
        envelope_.trace(axis == ReliefAxis::east ? Envelope::Line{from, places[i], to, places[i + 1]}
                                                 : Envelope::Line{places[i], from, places[i + 1], to},
                        limits);
        for (Envelope::Point& point : limits)
            point.quanta = std::max(point.quanta, double(record.min_quanta));
        chain_[i] = std::min(chain_[i], limits.front().quanta);
        chain_[i + 1] = std::min(chain_[i + 1], limits.back().quanta);
    }
    lower(record.min_quanta);
    const HeightSteps steps_of_height(record, chain_step::kSteps);
    int across = band_range(shape, quads_, band).first;
    for (std::size_t i = 0; i <= steps; ++i) {
        if (places[i] != RidgeSearch::kNowhere) across = places[i];
        relief.across(axis, band)[i] = static_cast<std::uint8_t>(across);
        relief.heights(axis, band)[i] = std::isinf(chain_[i])
                                            ? chain_height::kHidesNothing
                                            : chain_code(chain_[i], steps_of_height, record);
    }
}

// Lowers the chain until every segment lies under its limits, but no vertex under `floor`, where none of
// them is. Then every vertex rises as far as the limits of its two segments let it.
void ReliefMaker::lower(double floor) {
    for (std::size_t i = 0; i < limits_.size(); ++i)
        if (!limits_[i].empty()) lower_segment(limits_[i], floor, chain_[i], chain_[i + 1]);
    for (std::size_t i = 0; i < chain_.size(); ++i) {
        if (std::isinf(chain_[i])) continue;
        double highest = std::numeric_limits<double>::infinity();
        if (i > 0) highest = std::min(highest, highest_end(limits_[i - 1], chain_[i - 1]));
        if (i < limits_.size()) highest = std::min(highest, highest_start(limits_[i], chain_[i + 1]));
        chain_[i] = std::max(chain_[i], highest);
    }
}

}  // namespace ridgeline::io
