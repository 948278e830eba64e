// Literature: the horizon paper (3.2) for potential silhouettes. We differ in what a silhouette lies under (the
// lower envelope of all morph states, not one mesh), in its course (a ridge found by dynamic programming), and
// in that it is exact: its segments are checked against the envelope at every triangle edge that they cross.
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
        : heights_(heights), axis_(axis), segment_quads_(segment_quads) {}

    bool operator()(const RidgeSearch::Segment& segment) const {
        const int last = std::min(segment.along + segment_quads_, heights_.quads - 1);
        for (int cell = std::max(segment.along - 1, 0); cell <= last; ++cell) {
            const int a = across_at(segment, std::max(cell, segment.along), Rounding::down);
            const int b = across_at(segment, std::max(cell, segment.along), Rounding::up);
            const int end = std::min(cell + 1, segment.along + segment_quads_);
            const int c = across_at(segment, end, Rounding::down), d = across_at(segment, end, Rounding::up);
            if (!all_valid(cell, std::max(std::min(b, d) - 1, 0),
                           std::min(std::max(a, c), heights_.quads - 1)))
                return false;
        }
        return true;
    }

  private:
    enum class Rounding { down, up };

    int across_at(const RidgeSearch::Segment& segment, int along, Rounding rounding) const {
        const int rise = (segment.to - segment.from) * (along - segment.along);
        const int shift = rounding == Rounding::up ? segment_quads_ - 1 : 0;
        // Division of what is never negative: places are, sums are.
        return (segment.from * segment_quads_ + rise + shift) / segment_quads_;
    }
    bool all_valid(int along, int first, int last) const {
        for (int across = first; across <= last; ++across) {
            const int at = axis_ == ReliefAxis::east ? across * heights_.quads + along
                                                     : along * heights_.quads + across;
            if (heights_.cell_valid[static_cast<std::size_t>(at)] == 0) return false;
        }
        return true;
    }

    const HeightsTile& heights_;
    ReliefAxis axis_;
    int segment_quads_;
};

// The code of the height, or of the next step under it; none under the node's lowest.
std::uint16_t chain_code(double quanta, const NodeRecord& record) {
    const double range = static_cast<double>(record.max_quanta) - record.min_quanta;
    const double share = range > 0.0 ? (quanta - record.min_quanta) / range : quanta < record.min_quanta ? -1.0 : 0.0;
    int step = static_cast<int>(std::floor(std::min(share, 1.0) * (chain_height::kMost - 1))) >> chain_step::kDroppedBits;
    while (step >= 0 && chain_height::quanta(chain_step::code(step), record) > quanta) --step;
    return step < 0 ? chain_height::kHidesNothing : chain_step::code(step);
}

std::uint8_t maximum_code(std::int32_t quanta, const NodeRecord& record) {
    int code = step_below(quanta, record, 255);
    while (code < 255 && maximum_quanta(static_cast<std::uint8_t>(code), record) < static_cast<float>(quanta)) ++code;
    return static_cast<std::uint8_t>(code);
}

}  // namespace

void ReliefBounds::add_child(const ReliefShape& shape, int quarter, const ReliefBounds& child) {
    widen(child.min_quanta);
    widen(child.max_quanta);
    const int cells = shape.cells, half = cells / 2;
    if (maxima.empty()) maxima.assign(static_cast<std::size_t>(cells * cells), kNothing);
    std::int32_t* corner = &maxima[static_cast<std::size_t>((quarter >> 1) * half * cells + (quarter & 1) * half)];
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
    find_silhouettes(heights, grid.step(node.level), record, relief);
    encode_relief(relief, record, heights, payload);
}

// The bisection's triangles and the lattice's cells are nested, so over a lattice cell the upper envelope is
// greatest at a corner or at a vertex.
void ReliefMaker::find_maxima(const Bisection& bisection, std::int64_t step, const NodeRecord& record,
                              ReliefBounds& bounds, ReliefView relief) {
    const ReliefShape& shape = relief.shape();
    const auto cells = static_cast<std::size_t>(shape.cells);
    if (bounds.maxima.empty()) bounds.maxima.assign(cells * cells, ReliefBounds::kNothing);
    const auto raise = [&](std::size_t cell, double quanta) {
        // No higher than the bounds: fans are rounded, but to heights within them.
        const auto whole = static_cast<std::int32_t>(std::ceil(quanta + envelope_.fan_rise()));
        bounds.maxima[cell] = std::max(bounds.maxima[cell], std::min(whole, bounds.max_quanta));
    };
    const auto lattice = envelope_.upper_lattice();
    for (std::size_t row = 0; row < cells; ++row)
        for (std::size_t column = 0; column < cells; ++column) {
            const LatticeRange x = cell_range(shape, quads_, static_cast<int>(column));
            const LatticeRange y = cell_range(shape, quads_, static_cast<int>(row));
            double greatest = lattice[static_cast<std::size_t>(y.first * (quads_ + 1) + x.first)];
            for (int v = y.first; v <= y.last; ++v)
                for (int u = x.first; u <= x.last; ++u)
                    greatest = std::max(greatest, lattice[static_cast<std::size_t>(v * (quads_ + 1) + u)]);
            raise(row * cells + column, greatest);
        }
    const auto cells_at = [&](std::uint32_t place) {
        const int first = static_cast<int>((place + step - 1) / step) - 1, last = static_cast<int>(place / step);
        LatticeRange range{shape.cells, -1};
        for (int cell = 0; cell < shape.cells; ++cell) {
            const LatticeRange of = cell_range(shape, quads_, cell);
            if (of.first > last || of.last <= first) continue;
            range.first = std::min(range.first, cell);
            range.last = cell;
        }
        return range;
    };
    const auto& vertices = bisection.vertices();
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        if (((vertices[v].x | vertices[v].y) & (static_cast<std::uint32_t>(step) - 1)) == 0) continue;
        const LatticeRange x = cells_at(vertices[v].x), y = cells_at(vertices[v].y);
        for (int row = y.first; row <= y.last; ++row)
            for (int column = x.first; column <= x.last; ++column)
                raise(static_cast<std::size_t>(row) * cells + static_cast<std::size_t>(column), envelope_.upper(v));
    }
    for (std::size_t cell = 0; cell < cells * cells; ++cell)
        relief.maxima()[cell] = maximum_code(bounds.maxima[cell], record);
}

void ReliefMaker::find_silhouettes(const HeightsTile& heights, std::int64_t step, const NodeRecord& record,
                                   ReliefView relief) {
    const ReliefShape& shape = relief.shape();
    const auto lattice = envelope_.lower_lattice();
    const auto stride = static_cast<std::size_t>(quads_) + 1;
    lattice_.resize(lattice.size());
    for (const ReliefAxis axis : {ReliefAxis::east, ReliefAxis::south}) {
        for (std::size_t along = 0; along < stride; ++along)
            for (std::size_t across = 0; across < stride; ++across) {
                const std::size_t at = axis == ReliefAxis::east ? across * stride + along : along * stride + across;
                lattice_[along * stride + across] = static_cast<float>(lattice[at] - record.min_quanta);
            }
        RidgeSearch::Ground ground;
        if (!heights.cell_valid.empty()) ground = GroundMask(heights, axis, quads_ / shape.steps);
        ridges_.find(shape, quads_, lattice_, ground);
        for (int band = 0; band < shape.bands; ++band) find_silhouette(axis, band, step, record, relief);
    }
}

void ReliefMaker::find_silhouette(ReliefAxis axis, int band, std::int64_t step, const NodeRecord& record,
                                  ReliefView relief) {
    const ReliefShape& shape = relief.shape();
    const auto places = ridges_.chain(band);
    const auto steps = static_cast<std::size_t>(shape.steps);
    const double length = static_cast<double>(quads_ / shape.steps * step);
    limits_.resize(steps);
    chain_.assign(steps + 1, std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < steps; ++i) {
        Limits& limits = limits_[i];
        limits.points.clear();
        limits.ground = places[i] != RidgeSearch::kNowhere && places[i + 1] != RidgeSearch::kNowhere;
        if (!limits.ground) continue;
        const double from = static_cast<double>(i) * length, to = from + length;
        const auto start = static_cast<double>(places[i] * step), end = static_cast<double>(places[i + 1] * step);
        envelope_.trace(axis == ReliefAxis::east ? Envelope::Line{from, start, to, end}
                                                 : Envelope::Line{start, from, end, to},
                        limits.points);
        for (Envelope::Point& point : limits.points) point.quanta = std::max(point.quanta, double(record.min_quanta));
        chain_[i] = std::min(chain_[i], limits.points.front().quanta);
        chain_[i + 1] = std::min(chain_[i + 1], limits.points.back().quanta);
    }
    lower();
    int across = band_range(shape, quads_, band).first;
    for (std::size_t i = 0; i <= steps; ++i) {
        if (places[i] != RidgeSearch::kNowhere) across = places[i];
        relief.across(axis, band)[i] = static_cast<std::uint8_t>(across);
        relief.heights(axis, band)[i] =
            std::isinf(chain_[i]) ? chain_height::kHidesNothing : chain_code(chain_[i], record);
    }
}

double ReliefMaker::excess(const Limits& limits, double from, double to) const {
    double most = 0.0;
    for (const Envelope::Point& point : limits.points)
        most = std::max(most, from + point.along * (to - from) - point.quanta);
    return most;
}

// Lowers the chain until every segment lies under its limits. The end that is nearer to where a segment
// sticks out sinks more; lowering never hurts the neighbour.
void ReliefMaker::lower() {
    constexpr int kRounds = 4;
    for (std::size_t i = 0; i < limits_.size(); ++i) {
        if (!limits_[i].ground) continue;
        double &from = chain_[i], &to = chain_[i + 1];
        for (int round = 0; round < kRounds; ++round) {
            double most = 0.0, where = 0.0;
            for (const Envelope::Point& point : limits_[i].points) {
                const double over = from + point.along * (to - from) - point.quanta;
                if (over > most) most = over, where = point.along;
            }
            if (most <= 0.0) break;
            const double share = most / (where * where + (1.0 - where) * (1.0 - where));
            from -= share * (1.0 - where);
            to -= share * where;
        }
        const double rest = excess(limits_[i], from, to);
        from -= rest;
        to -= rest;
    }
}

}  // namespace ridgeline::io
