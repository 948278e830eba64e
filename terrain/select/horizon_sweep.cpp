// Literature: the incremental horizon over blocks from front to back, by their potential silhouettes (horizon
// paper, 3.2 and 4.1).
//
// How we differ. What is held against the horizon is a grid of maxima, not a box; what raises it, several
// chains an axis that lie under everything that may be drawn, and near the eye the mesh itself. docs/
// selection.md says why nothing that is seen is ever left out.
#include "ridgeline/select/horizon_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace ridgeline::select {
namespace {

using io::NodeId;

// Instead of a quarter: all of them, and only about the lines between them.
constexpr int kWhole = -1, kSeams = -2;
// Steps of a chain to either side of a seam; each crosses many columns where leaves are taken by quarters.
constexpr int kSeamSteps = 2;
// Leaves this near, in their own sides, raise the horizon quarter by quarter, so that their far quarters may
// be hidden by their near ones.
constexpr double kByQuarters = 0.5;
// Farther than this, the bands that stand highest do nearly as well as all: a third of the lines saved costs
// a few of a thousand hidden nodes.
constexpr double kFewBands = 1.0;
constexpr int kFarBands = 6;
// Farther than this, floats do for their lines.
constexpr double kExactly = 0.25;
// The near set: finest leaves within half a node of the eye.
constexpr double kNearSet = 0.5;
// Every so many rows and columns of a near mesh become lines.
constexpr int kMeshStride = 2;
// Invalid cells are looked for in squares of so many a side.
constexpr int kMaskBlock = 4;

// What a slice saw of a leaf: quarters now, quarters soon, and whether the leaf lies in it at all.
constexpr unsigned kNow = 0b1111;
constexpr unsigned kSoonShift = 4;
constexpr unsigned kTouched = 1u << 8;

constexpr unsigned bit(int quarter) { return 1u << quarter; }
constexpr glm::ivec2 quarter_place(int quarter) { return {quarter & 1, quarter >> 1}; }

bool block_invalid(std::span<const std::uint32_t> mask, int quads, const glm::ivec2& from) {
    for (int y = from.y; y < from.y + kMaskBlock; ++y) {
        const auto cell = static_cast<std::uint32_t>(y * quads + from.x);
        constexpr std::uint32_t kAll = (1u << kMaskBlock) - 1;
        if ((mask[cell / 32] >> (cell % 32) & kAll) != kAll) return true;
    }
    return false;
}

// The band that stands highest, of those without gaps; of bands equally high the first.
int best_band(const io::ReliefView& relief, io::ReliefAxis axis) {
    int best = kWhole;
    std::uint64_t highest = 0;
    for (int band = 0; band < relief.shape().bands; ++band) {
        const auto codes = relief.heights(axis, band);
        if (std::ranges::find(codes, io::chain_height::kHidesNothing) != codes.end()) continue;
        const std::uint64_t sum = std::accumulate(codes.begin(), codes.end(), std::uint64_t{0});
        if (sum > highest) highest = sum, best = band;
    }
    return best;
}

}  // namespace

HorizonSweep::HorizonSweep(const TerrainFrame& frame, const FrameTree& tree, const DrawList& draw_list,
                           jobs::JobSystem* jobs)
    : frame_(frame),
      tree_(tree),
      draw_list_(draw_list),
      drawn_(frame, tree),
      jobs_(jobs),
      near_ground_(frame.grid().quads()) {
    constexpr std::size_t kUsualLeaves = 4096;
    leaves_.reserve(kUsualLeaves);
    for (auto& seen : seen_) seen.reserve(kUsualLeaves);
}

void HorizonSweep::run(const View& view, const EyeFrame& eye, Residency residency,
                       std::span<const Visit> roots, const GroundSource& source) {
    view_ = view;
    source_ = &source;
    eye_place_ = eye.cell;
    leaves_.clear();
    for (const Visit& root : roots) collect(root, nullptr);
    if (view.horizon == HorizonMode::ridges)
        for (SweptLeaf& leaf : leaves_) find_near_mesh(leaf, residency);
    pictured_ = slices_of(view.picture);
    active_ = slices_of(view.extension) | pictured_;
    const auto sweep_slice = [this](std::int64_t slice) {
        if (swept(static_cast<int>(slice))) sweep(static_cast<int>(slice));
    };
    if (jobs_ && jobs_->worker_count() > 1)
        jobs_->parallel_for(0, SliceView::kSlices, 1, sweep_slice, jobs::Priority::urgent);
    else
        for (int slice = 0; slice < SliceView::kSlices; ++slice) sweep_slice(slice);
    merge();
}

// --- leaves

// Front to back as DrawList walks, but through the whole zone.
void HorizonSweep::collect(const Visit& v, const Visit* known_by) {
    if (!tree_.has(v.index, FrameTree::kInZone)) return;
    if (!frame_.record(v.index).has_data()) return add(v, nullptr, 0b1111);
    if (tree_.has(v.index, FrameTree::kResident)) known_by = &v;
    unsigned own = 0, existing = 0;
    for (int q = 0; q < io::kQuarters; ++q) {
        if (!frame_.quarter_exists(v.node, q)) continue;
        existing |= bit(q);
        if (!drawn_.child_drawn(v.node, q)) own |= bit(q);
    }
    if (own == existing) return add(v, known_by, own);
    for (const int turn : DrawnTree::kTurns) {
        const int quarter = drawn_.nearest_quarter(v.node, eye_place_) ^ turn;
        if ((own & bit(quarter)) != 0)
            add(v, known_by, bit(quarter));
        else if ((existing & bit(quarter)) != 0)
            collect(visit(frame_.grid(), v.node.child(quarter)), known_by);
    }
}

void HorizonSweep::add(const Visit& v, const Visit* known_by, unsigned quarters) {
    using Kind = SweptLeaf::Kind;
    SweptLeaf leaf;
    leaf.node = v;
    leaf.known_by = known_by ? *known_by : v;
    leaf.kind = !known_by ? Kind::nothing : known_by->index == v.index ? Kind::ground : Kind::assumed;
    leaf.quarters = static_cast<std::uint8_t>(quarters);
    leaf.whole = quarters == 0b1111;
    if (tree_.has(v.index, FrameTree::kInView))
        for (int q = 0; q < io::kQuarters; ++q)
            if ((quarters & bit(q)) != 0 && drawn_.quarter_in_view(v, q, view_.visible))
                leaf.in_view = static_cast<std::uint8_t>(leaf.in_view | bit(q));
    leaves_.push_back(leaf);
}

double HorizonSweep::sides_away(const SweptLeaf& leaf) const {
    const Lattice square = frame_.lattice(leaf.node.node, 1);
    const double east = std::max({square.corner_m.x, -square.corner_m.x - square.cell_m.x, 0.0});
    const double south = std::max({-square.corner_m.y, square.corner_m.y - square.cell_m.y, 0.0});
    return std::max(east / square.cell_m.x, south / square.cell_m.y);
}

void HorizonSweep::find_near_mesh(SweptLeaf& leaf, Residency residency) {
    const Visit& v = leaf.node;
    if (leaf.kind != SweptLeaf::Kind::ground || v.node.level != frame_.grid().finest() || !leaf.whole ||
        frame_.record(v.index).has_mask() || sides_away(leaf) > kNearSet || !is_unmorphed(leaf, residency))
        return;
    const io::LatticePoint origin = frame_.grid().origin(v.node);
    const std::int64_t extent = frame_.grid().extent(v.node.level);
    if (origin.x + extent > frame_.grid().width() - 1 || origin.y + extent > frame_.grid().height() - 1)
        return;
    leaf.near_mesh = static_cast<std::int8_t>(near_ground_.find(v.index, source_->chunk(v.index)));
}

bool HorizonSweep::is_unmorphed(const SweptLeaf& leaf, Residency residency) const {
    EyeFrame eye;
    eye.cell = eye_place_;
    const MorphTable morph = draw_list_.entry(leaf.node, 0b1111, eye, residency).morph;
    const auto far_m = static_cast<float>(frame_.distance_m(leaf.node) + frame_.diagonal_m(leaf.node));
    return std::all_of(morph.begin(), morph.end(), [&](const MorphParameters& m) {
        return m.fade <= 0.0f && far_m * m.scale + m.bias <= 0.0f;
    });
}

// --- slices

// Those that a cone about the eye touches, whatever its margin.
unsigned HorizonSweep::slices_of(const ExtensionZone& cone) const {
    constexpr unsigned kAll = (1u << SliceView::kSlices) - 1;
    const glm::dvec2 level(cone.direction.x, cone.direction.y);
    const double length = glm::length(level);
    if (!(cone.cos_half_angle > 0.0) || cone.sin_half_angle >= length) return kAll;
    const double reach = std::asin(cone.sin_half_angle / length);
    const glm::dvec2& heading = view_.heading;
    const double middle = std::atan2(level.x * heading.y - level.y * heading.x, glm::dot(level, heading));
    constexpr double kSlice = std::numbers::pi / 4.0;
    unsigned slices = 0;
    for (int slice = 0; slice < SliceView::kSlices; ++slice) {
        const double centre = (slice - 0.5) * kSlice;
        const double away = std::remainder(centre - middle, 2.0 * std::numbers::pi);
        // A hair more, for the rounding of angles.
        if (std::abs(away) <= reach + kSlice / 2.0 + 1e-6) slices |= 1u << slice;
    }
    return slices;
}

void HorizonSweep::sweep(int slice) {
    const auto at = static_cast<std::size_t>(slice);
    SliceHorizon& horizon = slices_[at];
    horizon.begin(SliceView(view_.heading, slice),
                  {static_cast<float>(view_.horizon_margin_px / view_.projection_px),
                   static_cast<float>(view_.expected_rise_m)},
                  pictured(slice) ? SliceHorizon::Use::picture : SliceHorizon::Use::zone);
    seen_[at].clear();
    for (const SweptLeaf& leaf : leaves_)
        seen_[at].push_back(static_cast<std::uint16_t>(sweep(horizon, leaf)));
}

unsigned HorizonSweep::sweep(SliceHorizon& slice, const SweptLeaf& leaf) const {
    const Lattice square = frame_.lattice(leaf.node.node, 1);
    if (leaf.kind == SweptLeaf::Kind::nothing) {
        if (!slice.touches(square, {0, 0}, 1)) return 0;
        const NodeId node = leaf.node.node;
        const double top = node.level == 0 ? std::numeric_limits<double>::infinity()
                                           : top_m(visit(frame_.grid(), node.parent()).index);
        slice.close(square, {0, 0}, 1, top);
        return kTouched | leaf.quarters | static_cast<unsigned>(leaf.quarters) << kSoonShift;
    }
    // Most that is hidden is so as a box; its maxima and chains are not even read.
    const SliceHorizon::Sight box = slice.look(
        square, {0, 0}, 1, std::max(top_m(leaf.node.index), top_m(leaf.known_by.index)) + beside_m(leaf));
    if (box.outside) return 0;
    return box.soon ? kTouched | sweep_quarters(slice, leaf) : kTouched;
}

unsigned HorizonSweep::sweep_quarters(SliceHorizon& slice, const SweptLeaf& leaf) const {
    const bool by_quarters = !leaf.whole || sides_away(leaf) < kByQuarters;
    const bool is_ground = leaf.kind == SweptLeaf::Kind::ground;
    const int nearest = drawn_.nearest_quarter(leaf.node.node, eye_place_);
    const Lattice halves = frame_.lattice(leaf.node.node, 2);
    unsigned seen = 0;
    SliceHorizon::Sight whole;
    for (const int turn : DrawnTree::kTurns) {
        const int quarter = nearest ^ turn;
        if ((leaf.quarters & bit(quarter)) == 0 || !slice.touches(halves, quarter_place(quarter), 1))
            continue;
        const SliceHorizon::Sight sight = look(slice, leaf, quarter);
        if (sight.now) seen |= bit(quarter);
        if (sight.soon) seen |= bit(quarter) << kSoonShift;
        whole = {whole.now || sight.now, whole.soon || sight.soon};
        if (by_quarters && is_ground && sight.soon) raise_quarter(slice, leaf, quarter, sight);
    }
    if (!is_ground || !leaf.whole || !whole.soon) return seen;
    if (!by_quarters) close_invalid(slice, leaf, leaf.quarters);
    slice.aim(whole);
    // The quarters' ends leave columns open where they meet.
    raise(slice, leaf, by_quarters ? kSeams : kWhole);
    return seen;
}

void HorizonSweep::raise_quarter(SliceHorizon& slice, const SweptLeaf& leaf, int quarter,
                                 const SliceHorizon::Sight& seen) const {
    close_invalid(slice, leaf, bit(quarter));
    slice.aim(seen);
    raise(slice, leaf, quarter);
    // Sunk by what the eye may rise, what is so near hides nothing.
    if (slice.use() == SliceHorizon::Use::zone || !seen.now) return;
    slice.aim({true, false});
    raise_mesh(slice, leaf, quarter);
}

double HorizonSweep::top_m(NodeIndex index) const {
    return frame_.over_eye_m(frame_.record(index).max_quanta);
}

SliceHorizon::Sight HorizonSweep::look(const SliceHorizon& slice, const SweptLeaf& leaf, int quarter) const {
    const glm::ivec2 place = quarter_place(quarter);
    if (view_.horizon == HorizonMode::boxes)
        return slice.look(frame_.lattice(leaf.node.node, 2), place, 1,
                          std::max(top_m(leaf.node.index), top_m(leaf.known_by.index)) + beside_m(leaf));
    const io::NodeRecord& record = frame_.record(leaf.known_by.index);
    const io::ReliefView relief = source_->chunk(leaf.known_by.index).relief();
    const int cells = relief.shape().cells;
    const double range = static_cast<double>(record.max_quanta) - record.min_quanta;
    const GroundMaxima ground{
        frame_.lattice(leaf.known_by.node, cells),
        {frame_.over_eye_m(record.min_quanta) + beside_m(leaf), range * frame_.quantum_m() / 255.0},
        relief.maxima().data(),
        cells};
    // The quarter as one of so many squares a side of the node whose maxima these are.
    const int depth = leaf.node.node.level - leaf.known_by.node.level + 1;
    const NodeId square = leaf.node.node.child(quarter);
    const glm::ivec2 at(square.x - (leaf.known_by.node.x << depth),
                        square.y - (leaf.known_by.node.y << depth));
    const glm::ivec2 from = at * cells >> depth;
    const glm::ivec2 to = ((at + 1) * cells + (1 << depth) - 1) >> depth;
    return slice.look(ground, {from, to - from});
}

void HorizonSweep::close_invalid(SliceHorizon& slice, const SweptLeaf& leaf, unsigned quarters) const {
    if (!frame_.record(leaf.node.index).has_mask()) return;
    const auto mask = source_->chunk(leaf.node.index).mask();
    const int quads = frame_.grid().quads(), half = quads / 2;
    const Lattice lattice = frame_.lattice(leaf.node.node, quads);
    for (int y = 0; y < quads; y += kMaskBlock)
        for (int x = 0; x < quads; x += kMaskBlock)
            if ((quarters & bit((x >= half ? 1 : 0) + (y >= half ? 2 : 0))) != 0 &&
                block_invalid(mask, quads, {x, y}))
                slice.close(lattice, {x, y}, kMaskBlock, top_m(leaf.node.index) + beside_m(leaf));
}

// --- what raises the horizon

void HorizonSweep::raise(SliceHorizon& slice, const SweptLeaf& leaf, int quarter) const {
    const io::ReliefView relief = source_->chunk(leaf.node.index).relief();
    const io::ReliefShape& shape = relief.shape();
    const io::NodeRecord& record = frame_.record(leaf.node.index);
    const int quads = frame_.grid().quads();
    const Lattice lattice = frame_.lattice(leaf.node.node, quads);
    const double range = static_cast<double>(record.max_quanta) - record.min_quanta;
    const double step_m = range * frame_.quantum_m() / 65534.0;
    const CodedHeights heights{frame_.over_eye_m(record.min_quanta) - step_m - beside_m(leaf), step_m};
    const auto reach = sides_away(leaf) < kExactly ? SliceHorizon::Reach::near : SliceHorizon::Reach::far;
    for (const io::ReliefAxis axis : {io::ReliefAxis::east, io::ReliefAxis::south}) {
        const bool east = axis == io::ReliefAxis::east;
        const glm::ivec2 place = quarter < 0 ? glm::ivec2(0) : quarter_place(quarter);
        const int along = east ? place.x : place.y, across = east ? place.y : place.x;
        const int parts = quarter < 0 ? 1 : 2;
        const int bands = shape.bands / parts;
        const int segments = quarter == kSeams ? std::min(2 * kSeamSteps, shape.steps) : shape.steps / parts;
        const double step = static_cast<double>(quads) / shape.steps;
        const int first = quarter == kSeams ? (shape.steps - segments) / 2 : along * segments;
        GroundLine line;
        line.start = (east ? glm::dvec2(1.0, 0.0) : glm::dvec2(0.0, 1.0)) * (first * step);
        line.step = east ? glm::dvec2(step, 0.0) : glm::dvec2(0.0, step);
        line.across_step = east ? glm::dvec2(0.0, 1.0) : glm::dvec2(1.0, 0.0);
        line.count = segments + 1;
        std::array<int, kMostBands> chosen;
        const int count = choose_bands(leaf, relief, axis, across * bands, (across + 1) * bands, chosen);
        for (const int band : std::span(chosen.data(), static_cast<std::size_t>(count))) {
            line.codes = relief.heights(axis, band).data() + first;
            line.across = relief.across(axis, band).data() + first;
            slice.raise(line, lattice, heights, reach);
        }
    }
}

int HorizonSweep::choose_bands(const SweptLeaf& leaf, const io::ReliefView& relief, io::ReliefAxis axis,
                               int first, int last, std::array<int, kMostBands>& chosen) const {
    if (view_.horizon == HorizonMode::boxes) {
        chosen[0] = best_band(relief, axis);
        return first <= chosen[0] && chosen[0] < last ? 1 : 0;
    }
    const int count = last - first;
    std::iota(chosen.begin(), chosen.begin() + count, first);
    if (count <= kFarBands || sides_away(leaf) < kFewBands) return count;
    // By height over distance, in the middle of each.
    const io::NodeRecord& record = frame_.record(leaf.node.index);
    const double base_m = frame_.over_eye_m(record.min_quanta), top_m = frame_.over_eye_m(record.max_quanta);
    const Lattice square = frame_.lattice(leaf.node.node, 1);
    const int bands = relief.shape().bands;
    std::array<double, kMostBands> slopes;
    for (int band = first; band < last; ++band) {
        const auto codes = relief.heights(axis, band);
        const double sum = std::accumulate(codes.begin(), codes.end(), 0u);
        const double share = sum / (static_cast<double>(codes.size()) * io::chain_height::kMost);
        const double across = (band + 0.5) / bands;
        const glm::dvec2 middle =
            axis == io::ReliefAxis::east ? square.at(0.5, across) : square.at(across, 0.5);
        slopes[static_cast<std::size_t>(band)] = (base_m + share * (top_m - base_m)) / glm::length(middle);
    }
    std::nth_element(chosen.begin(), chosen.begin() + kFarBands, chosen.begin() + count, [&](int a, int b) {
        return slopes[static_cast<std::size_t>(a)] > slopes[static_cast<std::size_t>(b)];
    });
    return kFarBands;
}

// Rows and columns of the near set.
void HorizonSweep::raise_mesh(SliceHorizon& slice, const SweptLeaf& leaf, int quarter) const {
    if (leaf.near_mesh < 0) return;
    const std::span<const float> quanta = near_ground_.quanta(leaf.near_mesh);
    const int quads = frame_.grid().quads(), half = quads / 2, stride = quads + 1;
    const Lattice lattice = frame_.lattice(leaf.node.node, quads);
    const glm::ivec2 from = quarter_place(quarter) * half;
    std::array<float, SliceHorizon::kMostVertices> heights_m;
    const auto raise_line = [&](const glm::ivec2& start, const glm::ivec2& step) {
        for (int i = 0; i <= half; ++i) {
            const glm::ivec2 at = start + i * step;
            heights_m[static_cast<std::size_t>(i)] =
                static_cast<float>(frame_.over_eye_m(static_cast<double>(
                                       quanta[static_cast<std::size_t>(at.y * stride + at.x)])) -
                                   beside_m(leaf));
        }
        GroundLine line;
        line.start = start;
        line.step = step;
        line.count = half + 1;
        slice.raise(line, lattice, {heights_m.data(), static_cast<std::size_t>(line.count)});
    };
    for (int i = 0; i <= half; i += kMeshStride) {
        raise_line({from.x, from.y + i}, {1, 0});
        raise_line({from.x + i, from.y}, {0, 1});
    }
}

// --- results

void HorizonSweep::merge() {
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
        unsigned seen = 0;
        for (int slice = 0; slice < SliceView::kSlices; ++slice) {
            if (!swept(slice)) continue;
            const unsigned here = seen_[static_cast<std::size_t>(slice)][i];
            seen |= pictured(slice) ? here : here & ~kNow;
        }
        SweptLeaf& leaf = leaves_[i];
        // What touches no slice lies within the zone's margin of the eye.
        if ((seen & kTouched) == 0) seen = leaf.quarters | static_cast<unsigned>(leaf.quarters) << kSoonShift;
        leaf.now = static_cast<std::uint8_t>(seen & leaf.in_view);
        leaf.soon = static_cast<std::uint8_t>(seen >> kSoonShift & leaf.quarters);
    }
}

}  // namespace ridgeline::select
