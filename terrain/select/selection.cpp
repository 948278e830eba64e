// Literature: chunked LOD and its screen-space error (horizon paper, section 3), quadtrees whose neighbours
// keep within one level (gpu-quadtree paper, section 2), tiles chosen level by level (scheduling paper,
// section 3.1).
//
// How we differ. Balance is kept twice: once in the ideal tree, by splitting the coarser of two neighbours
// (fine to coarse, so that one pass reaches the fixpoint), and once in the drawn one, where data may be
// missing, by not splitting the finer (coarse to fine; one pass too, because a node's neighbours are decided
// before it). A missing child does not hold its siblings back: its area stays a quarter of the parent.
// Outside the frustum data counts as present, so that what is out of sight neither coarsens nor reshapes what
// is in sight.
#include "ridgeline/select/selection.h"

#include <algorithm>
#include <limits>

#include "ridgeline/base/contract.h"
#include "ridgeline/select/drawn_report.h"
#include "ridgeline/select/drawn_surface.h"
#include "ridgeline/select/selection_state.h"

namespace ridgeline::select {
namespace {

using io::NodeId;
using io::Side;

constexpr Side kAllSides[io::kSides] = {Side::west, Side::east, Side::north, Side::south};

// Enough for usual views at once; more grows by itself.
constexpr std::size_t kUsualNodes = 4096;

}  // namespace

Selection::State::State(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                        const Criterion& criterion_used, const SelectionOptions& options)
    : frame(info, records),
      tree(frame.grid().node_count()),
      criterion(criterion_used),
      visits(static_cast<std::size_t>(frame.grid().levels())),
      splits(static_cast<std::size_t>(frame.grid().levels())),
      draw_list(frame, tree),
      casters(frame, tree, draw_list),
      sweep(frame, tree, draw_list, options.jobs),
      assumed(grid().node_count()),
      hidden_quarters(static_cast<std::size_t>(grid().node_count())),
      wanted(options.wanted_capacity) {
    RIDGELINE_CHECK(records.size() == static_cast<std::size_t>(grid().node_count()));
    RIDGELINE_CHECK(records.size() <= std::numeric_limits<NodeIndex>::max());
    for (std::int32_t y = 0; y < grid().nodes_y(0); ++y)
        for (std::int32_t x = 0; x < grid().nodes_x(0); ++x) roots.push_back(visit(grid(), {0, x, y}));
    for (auto* levels : {&visits, &splits})
        for (Visits& list : *levels) list.reserve(kUsualNodes);
    beside_eye.reserve(kUsualNodes);
    used.reserve(kUsualNodes);
    held_back.reserve(kUsualNodes);
}

void Selection::State::run(const View& new_view, Residency new_residency, const GroundSource* ground) {
    RIDGELINE_CHECK(new_residency.size() == static_cast<std::size_t>(grid().node_count()));
    view = new_view;
    residency = new_residency;
    const SwitchingRule rule = criterion.rule(view, frame.info(), grid());
    frame.set_view(view, with_finest_within(rule, view.finest_within_m, grid().finest()));
    tree.begin_frame();
    result.eye = eye_frame(view, frame.info());
    result.counters = {};
    result.unsettled = false;
    hiding = false;
    used.clear();
    held_back.clear();
    wanted.clear();
    split_by_criterion();
    balance();
    descend();
    keep_fine_beside_eye();
    if (ground && view.horizon != HorizonMode::off) find_hidden(*ground);
    if (!hiding) grow_drawn(Assume::nothing);
    note_all();
    if (hiding) assume_for_next();
    publish();
}

void Selection::State::split_by_criterion() {
    for (Visits& list : splits) list.clear();
    Visits& candidates = visits.front();
    candidates = roots;
    for (int l = 0; l < grid().finest(); ++l) {
        Visits& next = level(visits, l + 1);
        next.clear();
        for (const Visit& v : level(visits, l)) {
            if (!frame.splits(v)) continue;
            tree.add(v.index, FrameTree::kSplit);
            level(splits, l).push_back(v);
            for (int q = 0; q < io::kQuarters; ++q)
                if (const NodeId child = v.node.child(q); grid().contains(child))
                    next.push_back(visit(grid(), child));
        }
    }
}

// A node that splits wants its neighbours to exist, so their parents split. Fine to coarse: what a level adds
// to the next coarser one is looked at there. (An added node's own parent is a neighbour of a split node, or
// is split.)
void Selection::State::balance() {
    for (int l = grid().finest() - 1; l > 0; --l)
        for (const Visit& v : level(splits, l))
            for (const Side side : kAllSides) {
                const NodeId neighbour = io::neighbour(v.node, side);
                if (!grid().contains(neighbour)) continue;
                const Visit parent = visit(grid(), neighbour.parent());
                if (tree.has(parent.index, FrameTree::kSplit)) continue;
                tree.add(parent.index, FrameTree::kSplit);
                level(splits, l - 1).push_back(parent);
            }
}

void Selection::State::descend() {
    beside_eye.clear();
    admit_roots();
    for (int l = 0; l < grid().levels(); ++l) {
        if (l < grid().finest()) level(visits, l + 1).clear();
        for (const Visit& v : level(visits, l)) {
            const bool ideal = tree.has(v.index, FrameTree::kSplit);
            if ((ideal && matters(v)) || is_ahead(v)) admit_children(v, !ideal);
        }
    }
}

// Nearest first: draw order starts here.
void Selection::State::admit_roots() {
    const auto away = [&](const Visit& v) {
        const Box b = frame.box(v);
        const glm::dvec3 to = 0.5 * (b.min + b.max) - view.eye_m;
        return to.x * to.x + to.y * to.y;
    };
    std::sort(roots.begin(), roots.end(), [&](const Visit& a, const Visit& b) { return away(a) < away(b); });
    visits.front() = roots;
    for (const Visit& root : roots) {
        admit(root);
        tree.add(root.index, sight_of(root, root, frame.box(root)));
    }
}

void Selection::State::admit(const Visit& v) {
    if (residency[v.index].resident) tree.add(v.index, FrameTree::kResident);
}

void Selection::State::admit_children(const Visit& parent, bool ahead) {
    tree.add(parent.index, FrameTree::kOpened);
    for (int q = 0; q < io::kQuarters; ++q) {
        const NodeId node = parent.node.child(q);
        if (!grid().contains(node)) continue;
        const Visit child = visit(grid(), node);
        admit(child);
        const unsigned sight = sight_of(child, parent, frame.quarter_box(parent, q));
        tree.add(child.index, sight | (ahead ? FrameTree::kAhead : 0u));
        if ((sight & FrameTree::kBeside) != 0 && !ahead) beside_eye.push_back(child);
        level(visits, node.level).push_back(child);
    }
}

// A child's area is tested with its parent's heights, because a quarter of the parent may be drawn there;
// that also makes what is in view closed under ancestors. parent: the node itself at level 0.
unsigned Selection::State::sight_of(const Visit& v, const Visit& parent, const Box& of_chunks) const {
    const Box area = frame.drawn_box(of_chunks);
    const unsigned beside = is_beside_eye(area) ? FrameTree::kBeside : 0u;
    const bool root = v.node.level == 0;
    const unsigned above = root ? FrameTree::kInView | FrameTree::kInZone : tree.flags_of(parent.index);
    if ((above & FrameTree::kInside) != 0)
        return beside | FrameTree::kInside | FrameTree::kInView | FrameTree::kInZone;
    if ((above & FrameTree::kInView) != 0) {
        const Containment containment = contains(view.visible, area);
        if (containment == Containment::inside)
            return beside | FrameTree::kInside | FrameTree::kInView | FrameTree::kInZone;
        if (containment == Containment::partly) return beside | FrameTree::kInView | FrameTree::kInZone;
    }
    if ((above & FrameTree::kInZone) == 0) return beside;
    const double radius_m = 0.5 * glm::length(area.max - area.min);
    const bool in_zone = touches(view.extension, view.eye_m, 0.5 * (area.min + area.max), radius_m);
    return in_zone ? beside | FrameTree::kInZone : beside;
}

// A coarse stand-in for such ground would lift the eye, in view or not.
bool Selection::State::is_beside_eye(const Box& area) const {
    // What lies deeper neither lifts the eye, which stands a metre over its ground, nor meets the near plane.
    const double close_m = 2.0 + view.near_reach_m;
    const glm::dvec2 eye(view.eye_m), reach(view.near_reach_m);
    return glm::all(glm::greaterThanEqual(eye + reach, glm::dvec2(area.min))) &&
           glm::all(glm::lessThanEqual(eye - reach, glm::dvec2(area.max))) &&
           area.max.z > view.eye_m.z - close_m;
}

// What the eye stands beside is drawn as fine as its neighbours let it be, and at heights that follow from
// theirs: its own must be there, and those of all that it hangs from, which split only beside nodes that are
// there. Fine to coarse, so that a level knows what of the level below must be there.
void Selection::State::keep_fine_beside_eye() {
    for (const Visit& v : beside_eye)
        for (const Side side : kAllSides) {
            if (tree.has(v.index, FrameTree::kSplit)) continue;
            const NodeId neighbour = io::neighbour(v.node, side);
            keep(neighbour);
            for (int q = 0; q < io::kQuarters; ++q) keep(neighbour.child(q));
        }
    for (int l = grid().finest() - 1; l > 0; --l)
        for (const Visit& v : level(splits, l))
            if (has_child_beside_eye(v))
                for (const Side side : kAllSides) keep(io::neighbour(v.node, side));
}

// With its parent. Outside the zone nothing holds anything back.
void Selection::State::keep(const NodeId& node) {
    if (!grid().contains(node)) return;
    const NodeIndex index = visit(grid(), node).index;
    if ((tree.flags_of(index) & (FrameTree::kInZone | FrameTree::kAhead)) != FrameTree::kInZone) return;
    tree.add(index, FrameTree::kBeside);
    if (node.level > 0) tree.add(visit(grid(), node.parent()).index, FrameTree::kBeside);
}

bool Selection::State::has_child_beside_eye(const Visit& v) const {
    if (!tree.has(v.index, FrameTree::kBeside)) return false;
    for (int q = 0; q < io::kQuarters; ++q)
        if (const NodeId child = v.node.child(q);
            grid().contains(child) && tree.has(visit(grid(), child).index, FrameTree::kBeside))
            return true;
    return false;
}

// Whether anything seen or wanted depends on the node's children: outside the zone they may cast shadows,
// else they only shape the borders of neighbours in view. (An ancestor of such a neighbour's neighbour is
// itself in view or beside an ancestor in view, so nothing that matters is cut off above.)
bool Selection::State::matters(const Visit& v) const {
    if ((tree.flags_of(v.index) & (FrameTree::kInZone | FrameTree::kBeside)) != 0) return true;
    if (view.sun.casters != CasterSet::none) return true;
    return std::any_of(std::begin(kAllSides), std::end(kAllSides), [&](Side side) {
        const NodeId node = io::neighbour(v.node, side);
        return grid().contains(node) && tree.has(visit(grid(), node).index, FrameTree::kInView);
    });
}

// Whether the eye could come near enough within the paging latency to split a node in the zone.
bool Selection::State::is_ahead(const Visit& v) const {
    if (!(view.extension.margin_m > 0.0) || !tree.has(v.index, FrameTree::kInZone)) return false;
    const double split_m = frame.split_m(v);
    return split_m > 0.0 && frame.distance_m(v) - view.extension.margin_m < split_m;
}

// --- what is drawn, and what is hidden

// Coarse to fine, so that a level's neighbours are decided before the level below.
void Selection::State::grow_drawn(Assume assume) {
    for (const Visits& list : visits)
        for (const Visit& v : list)
            tree.remove(v.index, FrameTree::kDrawn | FrameTree::kParted | FrameTree::kAssumed);
    for (const Visit& root : roots) tree.add(root.index, FrameTree::kDrawn);
    for (const Visits& list : visits)
        for (const Visit& v : list) {
            if (!tree.has(v.index, FrameTree::kSplit) || !may_split(v)) continue;
            tree.add(v.index, FrameTree::kParted);
            if (!tree.has(v.index, FrameTree::kOpened)) continue;
            for (int q = 0; q < io::kQuarters; ++q) {
                if (!grid().contains(v.node.child(q))) continue;
                const NodeIndex child = visit(grid(), v.node.child(q)).index;
                if (is_present(child, v, assume)) tree.add(child, FrameTree::kDrawn);
                if (tree.has(child, FrameTree::kDrawn | FrameTree::kInView) &&
                    !tree.has(child, FrameTree::kResident) && frame.record(child).has_data())
                    tree.add(child, FrameTree::kAssumed);
            }
        }
}

bool Selection::State::is_present(NodeIndex child, const Visit& parent, Assume assume) const {
    if (!tree.has(child, FrameTree::kInView) || !frame.record(child).has_data() ||
        tree.has(child, FrameTree::kResident))
        return true;
    if (assume == Assume::nothing || assumed.revealed(child)) return false;
    // What is hidden as a whole is hidden in each of its parts.
    return tree.has(parent.index, FrameTree::kAssumed) || assumed.holds(child);
}

// The drawn tree splits where all neighbours in view are as fine; their level is complete by now.
bool Selection::State::may_split(const Visit& v) const {
    if (!tree.has(v.index, FrameTree::kDrawn)) return false;
    return std::all_of(std::begin(kAllSides), std::end(kAllSides), [&](Side side) {
        const NodeId node = io::neighbour(v.node, side);
        if (!grid().contains(node)) return true;
        const NodeIndex neighbour = visit(grid(), node).index;
        return tree.has(neighbour, FrameTree::kDrawn) || !tree.has(neighbour, FrameTree::kInView);
    });
}

// In a square about the eye, at places no farther apart than a finest quarter is wide: they know every
// quarter in it. Mostly its corners.
GroundAbout Selection::State::ground_about(Residency of, const GroundSource& ground, double floor_m) const {
    const io::TerrainInfo& info = frame.info();
    const glm::dvec2 eye = info.lattice(view.eye_m.x, view.eye_m.y);
    const glm::dvec2 last(static_cast<double>(info.width - 1), static_cast<double>(info.height - 1));
    const glm::dvec2 reach = view.near_reach_m / glm::dvec2(info.spacing_x_m, info.spacing_y_m);
    const glm::ivec2 steps = 1 + glm::ivec2(2.0 * reach / (grid().quads() / 2.0));
    GroundAbout about{.highest_m = floor_m};
    for (int i = 0; i < (steps.x + 1) * (steps.y + 1); ++i) {
        const glm::dvec2 share = glm::dvec2(i % (steps.x + 1), i / (steps.x + 1)) / glm::dvec2(steps);
        const glm::dvec2 place = glm::clamp(eye + (2.0 * share - 1.0) * reach, glm::dvec2(0.0), last);
        DrawEntry entry;
        if (!entry_at(place.x, place.y, of, entry)) {
            about.complete = false;
            continue;
        }
        if (frame.over_eye_m(frame.record(entry.index).max_quanta) <= about.highest_m) continue;
        entry.quarters = static_cast<std::uint8_t>(1u << quarter_at_place(grid(), entry.node, place));
        about.highest_m = std::max(about.highest_m, highest_about_m(ground.chunk(entry.index), result.eye,
                                                                    entry, view.near_reach_m));
    }
    return about;
}

// --- what is wanted

void Selection::State::note_all() {
    for (const Visits& list : visits)
        for (const Visit& v : list) {
            if (hiding) inherit_sight(v);
            note(v);
            count(v);
        }
}

Selection::State::Demand Selection::State::demand(const Visit& v) const {
    const unsigned flags = tree.flags_of(v.index);
    if (!frame.record(v.index).has_data()) return Demand::none;
    const bool ahead = (flags & FrameTree::kAhead) != 0;
    if ((flags & FrameTree::kBeside) != 0 && !ahead) return Demand::visible;
    if ((flags & FrameTree::kInZone) == 0) return Demand::none;
    const bool seen = !hiding || (flags & FrameTree::kSeen) != 0 || assumed.revealed(v.index);
    if ((flags & FrameTree::kInView) != 0 && !ahead && seen) return Demand::visible;
    return hiding && (flags & FrameTree::kSoon) == 0 ? Demand::none : Demand::extension;
}

void Selection::State::note(const Visit& v) {
    const Demand wants = demand(v);
    if (wants == Demand::none) return;
    const unsigned flags = tree.flags_of(v.index);
    const bool visible = wants == Demand::visible;
    const NodeIndex drawn_instead = v.node.level == 0 ? v.index : visit(grid(), v.node.parent()).index;
    wanted.add(v.index, v.node.level, visible, frame.error_px(drawn_instead, frame.distance_m(v)));
    if (!visible) return;
    result.counters.ideal_finest_level = std::max(result.counters.ideal_finest_level, v.node.level);
    if ((flags & FrameTree::kResident) == 0)
        ++result.counters.missing;
    else
        ((flags & FrameTree::kDrawn) != 0 ? used : held_back).push_back(v.index);
}

void Selection::State::count(const Visit& v) {
    ++result.counters.visited;
    const unsigned flags = tree.flags_of(v.index);
    if ((flags & (FrameTree::kDrawn | FrameTree::kParted | FrameTree::kInView)) == FrameTree::kDrawn)
        ++result.counters.frustum_culled;
}

// Casters that the view itself does not ask for are wanted as the extension zone is, and kept.
void Selection::State::add_casters() {
    casters.clear();
    if (view.sun.casters == CasterSet::none) return;
    casters.find(view, roots, residency);
    for (const Visit& v : casters.nodes()) {
        if (demand(v) == Demand::none) {
            const NodeIndex stand_in = v.node.level == 0 ? v.index : visit(grid(), v.node.parent()).index;
            wanted.add(v.index, v.node.level, false, frame.error_px(stand_in, frame.distance_m(v)));
        }
        if (tree.has(v.index, FrameTree::kDrawn | FrameTree::kResident) && demand(v) != Demand::visible)
            used.push_back(v.index);
    }
}

void Selection::State::publish() {
    draw_list.build(
        view.visible, result.eye, residency, roots,
        hiding ? std::span<const std::uint8_t>(hidden_quarters) : std::span<const std::uint8_t>());
    add_casters();
    result.counters.wanted = static_cast<std::uint32_t>(wanted.size());
    result.counters.held_back = static_cast<std::uint32_t>(held_back.size());
    result.counters.drawn = static_cast<std::uint32_t>(draw_list.entries().size());
    result.counters.triangles = draw_list.triangles();
    result.counters.drawn_finest_level = draw_list.finest_level();
    result.counters.casters = static_cast<std::uint32_t>(casters.entries().size());
    result.draws = draw_list.entries();
    result.casters = casters.entries();
    result.wanted = wanted.finish(tree);
    result.used = used;
    result.held_back = held_back;
}

bool Selection::State::entry_at(double column, double row, Residency of, DrawEntry& entry) const {
    if (!(column >= 0.0 && row >= 0.0 && column <= static_cast<double>(grid().width() - 1) &&
          row <= static_cast<double>(grid().height() - 1)))
        return false;
    constexpr unsigned kThere = FrameTree::kDrawn | FrameTree::kResident;
    Visit found = visit(grid(), node_at_place(grid(), 0, column, row));
    if (!tree.has(found.index, kThere)) return false;
    for (int level = 1; level < grid().levels(); ++level) {
        const Visit next = visit(grid(), node_at_place(grid(), level, column, row));
        if (!frame.record(next.index).has_data()) return false;
        if (!tree.has(next.index, kThere)) break;
        found = next;
    }
    entry = draw_list.entry(found, 0b1111, result.eye, of);
    return true;
}

Selection::Selection(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                     const Criterion& criterion, const SelectionOptions& options)
    : state_(std::make_unique<State>(info, records, criterion, options)) {}
Selection::~Selection() = default;
Selection::Selection(Selection&&) noexcept = default;
Selection& Selection::operator=(Selection&&) noexcept = default;

const SelectionResult& Selection::run(const View& view, Residency residency, const GroundSource* ground) {
    state_->run(view, residency, ground);
    return state_->result;
}

const SelectionResult& Selection::result() const { return state_->result; }
const io::Grid& Selection::grid() const { return state_->grid(); }

bool Selection::entry_at(double column, double row, Residency residency, DrawEntry& entry) const {
    return state_->entry_at(column, row, residency, entry);
}

GroundAbout Selection::ground_about(Residency residency, const GroundSource& ground, double floor_m) const {
    return state_->ground_about(residency, ground, floor_m);
}

std::span<const float> Selection::horizon_columns(int slice) const {
    if (!state_->hiding || !state_->sweep.pictured(slice)) return {};
    return state_->sweep.slice(slice).exact().values();
}

const glm::dvec2& Selection::heading() const { return state_->view.heading; }
bool Selection::uses_horizon() const { return state_->hiding; }

void Selection::report(std::vector<NodeReport>& nodes) const {
    nodes.clear();
    DrawnReport report(state_->frame, state_->tree, state_->view.visible, nodes);
    if (state_->hiding) report.add(state_->sweep.leaves());
    const auto where = state_->hiding ? DrawnReport::Where::outside_the_zone : DrawnReport::Where::everywhere;
    for (const Visit& root : state_->roots) report.add(root, where, state_->result.eye.cell);
}

}  // namespace ridgeline::select
