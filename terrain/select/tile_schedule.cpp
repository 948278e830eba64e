// Literature: the four steps of tile selection (scheduling paper, 3.1): the visible rectangle, subdivision
// level by level, regularisation, merging of the farthest tiles.
//
// How we differ. The distance is to the ground's bounding box, in space and along the view: beside the
// picture's middle a pixel is as wide on the ground as its depth says, not its distance. A mask of seen
// cells narrows the rectangle; what a moving eye may soon see counts besides, whatever hides it. A tile
// is chosen for the part of it where its parent is too coarse, not with all its siblings: what of the
// parent is far enough keeps sampling the parent, which is what "finest wins" is for. So a tile is needed
// where some of its children are seen and not chosen, or where there are no finer ones, and
// regularisation is one flag set on the way down. Merging keeps it: a tile whose child is merged into it
// is sampled there, and nothing becomes superfluous but what is removed. (A tile is superfluous when each
// of its seen children is chosen or itself superfluous; a merge only turns a chosen child into a chosen
// parent.) The heap finds the farthest tile in logarithmic time, where the paper searches the list.
#include "ridgeline/select/tile_schedule.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ridgeline/base/contract.h"
#include "ridgeline/base/geometry.h"
#include "ridgeline/detail/finer_ground.h"

namespace ridgeline::select {
namespace {

constexpr std::size_t kUsualPassing = 4096;
// Of the eye's height over the ground: how near slopes of up to 60 degrees come.
constexpr double kNearestShare = 0.5;

double level_distance_m(const GroundRectangle& area, const GroundView& view) {
    const glm::dvec2 eye(view.eye_m);
    return view.least_cosine * glm::distance(eye, glm::clamp(eye, area.min, area.max));
}

// The least depth of what the picture shows of a box: of any of it, and never less than at the picture's
// corner.
double least_depth_m(const Box& box, const GroundView& view) {
    const glm::dvec3 nearest(view.forward.x > 0.0 ? box.min.x : box.max.x,
                             view.forward.y > 0.0 ? box.min.y : box.max.y,
                             view.forward.z > 0.0 ? box.min.z : box.max.z);
    return std::max(view.least_cosine * distance(view.eye_m, box),
                    glm::dot(nearest - view.eye_m, view.forward));
}

// A layer's frame and which of its nodes hold a tile.
template <class Info, class Record>
TileTree tree_of(const Info& info, std::span<const Record> records) {
    TileTree tree{.grid = info.grid(),
                  .west_m = info.west_m,
                  .north_m = info.north_m,
                  .spacing_x_m = info.spacing_x_m,
                  .spacing_y_m = info.spacing_y_m,
                  .present = std::vector<bool>(records.size())};
    for (std::size_t i = 0; i < records.size(); ++i) tree.present[i] = records[i].has_data();
    return tree;
}

}  // namespace

GroundRectangle TileTree::area(io::NodeId node) const {
    const double side = static_cast<double>(grid.extent(node.level));
    const glm::dvec2 size = side * glm::dvec2(spacing_x_m, spacing_y_m);
    const double west = west_m + node.x * size.x, north = north_m - node.y * size.y;
    return {{west, north - size.y}, {west + size.x, north}};
}

TileTree heights_tree(const io::TerrainInfo& info, std::span<const io::NodeRecord> records, int made) {
    TileTree tree = tree_of(info, records);
    const io::TerrainInfo finer = detail::finer_lattice(info, made);
    tree.grid = finer.grid();
    tree.spacing_x_m = finer.spacing_x_m;
    tree.spacing_y_m = finer.spacing_y_m;
    tree.made_levels = made;
    return tree;
}

TileTree imagery_tree(const io::ImageryInfo& info, std::span<const io::ImageryRecord> records) {
    return tree_of(info, records);
}

bool GroundView::sees(const GroundRectangle& area) const {
    // Tiles share borders, so an area's eastern and northern ones are not its own; a rectangle without width
    // has nothing but borders.
    const GroundRectangle both = area.within(rectangle);
    if (both.empty() || both.min.x >= area.max.x || both.min.y >= area.max.y) return false;
    return seen.empty() ||
           std::any_of(seen.begin(), seen.end(), [&](const GroundMask& mask) { return mask.any(both); });
}

bool GroundView::may_see_soon(const Box& box) const {
    if (!(distance(eye_m, box) < soon_m)) return false;
    const glm::dvec3 centre_m = 0.5 * (box.min + box.max);
    return touches(picture, eye_m, centre_m, glm::distance(centre_m, box.max));
}

TileSchedule::TileSchedule(TileTree tree, const GroundBounds& ground, std::size_t capacity)
    : tree_(std::move(tree)), ground_(ground), capacity_(capacity) {
    RIDGELINE_CHECK(tree_.present.empty() ||
                    tree_.present.size() ==
                        static_cast<std::size_t>(tree_.grid.first(tree_.grid.levels() - tree_.made_levels)));
    for (int level = 0; level < tree_.grid.levels(); ++level) {
        const GroundRectangle area = tree_.area({level, 0, 0});
        ground_level_[static_cast<std::size_t>(level)] = ground_.level_for(area.max - area.min);
    }
    // What passes before merging is rarely more: a chain of ancestors above each chosen tile, or with few
    // slots what a usual view would have.
    const auto most = static_cast<std::size_t>(tree_.grid.node_count());
    passing_.reserve(std::min(most, std::max(kUsualPassing, 2 * capacity_)));
    farthest_.reserve(passing_.capacity());
    tiles_.reserve(capacity_);
}

double TileSchedule::reach_m(int level, const GroundView& view) const {
    const double texel_m =
        static_cast<double>(tree_.grid.step(level)) * std::max(tree_.spacing_x_m, tree_.spacing_y_m);
    const bool made = tree_.is_made(level + 1) && made_pixel_error_px_;
    return texel_m * view.projection_px / (made ? *made_pixel_error_px_ : view.pixel_error_px);
}

Box TileSchedule::box_about(const GroundRectangle& area, int level, const GroundView& view) const {
    const auto quanta = ground_.of(area, ground_level_[static_cast<std::size_t>(level)]);
    const double lowest_m = quanta ? ground_.height_m(quanta->lowest, view.exaggeration) : view.eye_m.z;
    const double highest_m = quanta ? ground_.height_m(quanta->highest, view.exaggeration) : view.eye_m.z;
    return {{area.min, lowest_m}, {area.max, highest_m}};
}

double TileSchedule::distance_m(const GroundRectangle& area, int level, const GroundView& view) const {
    return least_depth_m(box_about(area, level, view), view);
}

// Heights are asked for only where the map alone does not say that it is too far.
bool TileSchedule::may_see_soon(const GroundRectangle& area, int level, const GroundView& view) const {
    const glm::dvec2 eye(view.eye_m);
    return glm::distance(eye, glm::clamp(eye, area.min, area.max)) < view.soon_m &&
           view.may_see_soon(box_about(area, level, view));
}

const TileScheduleResult& TileSchedule::run(const GroundView& view) {
    RIDGELINE_CHECK(view.projection_px > 0.0 && view.pixel_error_px > 0.0 && view.exaggeration > 0.0);
    passing_.clear();
    farthest_.clear();
    chosen_ = 0;
    result_.counters = {};
    divide(view);
    result_.counters.passing = static_cast<std::uint32_t>(passing_.size());
    result_.counters.sampled = static_cast<std::uint32_t>(chosen_);
    merge();
    publish();
    return result_;
}

// --- steps 2 and 3: subdivision, regularised on the way

void TileSchedule::divide(const GroundView& view) {
    if (view.rectangle.empty() && !(view.soon_m > 0.0)) return;
    for (std::int32_t y = 0; y < tree_.grid.nodes_y(0); ++y)
        for (std::int32_t x = 0; x < tree_.grid.nodes_x(0); ++x) {
            const io::NodeId root{0, x, y};
            const std::int64_t index = tree_.grid.linear(root);
            const GroundRectangle area = tree_.area(root);
            if (tree_.has(static_cast<std::size_t>(index)) &&
                (view.sees(area) || may_see_soon(area, root.level, view)))
                passing_.push_back({root, index});
        }
    for (std::uint32_t place = 0; place < passing_.size(); ++place) divide(place, view);
}

void TileSchedule::divide(std::uint32_t place, const GroundView& view) {
    const Passing parent = passing_[place];
    const double reach = reach_m(parent.node.level, view);
    const auto first_child = static_cast<std::uint32_t>(passing_.size());
    bool sampled = parent.node.level == finest();
    for (int q = 0; q < io::kQuarters && parent.node.level < finest(); ++q) {
        const io::NodeId child = parent.node.child(q);
        if (!tree_.grid.contains(child)) continue;
        const std::int64_t index = tree_.grid.linear(child);
        const GroundRectangle area = tree_.area(child);
        const bool made = tree_.is_made(child.level);
        if (!made && !tree_.has(static_cast<std::size_t>(index))) continue;
        const bool soon = may_see_soon(area, child.level, view);
        if (!soon && !view.sees(area)) continue;
        const GroundRectangle part = soon ? area : area.within(view.rectangle);
        // Heights need not be asked for where the map alone says that it is too far.
        double away_m = std::max(parent.distance_m, level_distance_m(part, view));
        // Heights bound the ground of a whole tile of the source, which may reach up to a high eye.
        if (made) away_m = std::max(away_m, kNearestShare * view.eye_above_ground_m);
        // Bounds of fewer records may be rounded otherwise; merging counts on descendants not being nearer.
        if (away_m < reach) away_m = std::max(away_m, distance_m(part, child.level, view));
        if (away_m < reach)
            passing_.push_back({.node = child, .index = index, .parent = place, .distance_m = away_m});
        else
            sampled = true;
    }
    Passing& tile = passing_[place];
    tile.first_child = first_child;
    tile.children = static_cast<std::uint32_t>(passing_.size()) - first_child;
    tile.chosen = sampled && parent.node.level > 0;
    chosen_ += tile.chosen;
}

// --- step 4: merging

// A total order. Of tiles equally far the coarser one counts as nearer: its descendants go first.
bool TileSchedule::is_nearer(std::uint32_t a, std::uint32_t b) const {
    const double at_a = passing_[a].distance_m, at_b = passing_[b].distance_m;
    return at_a != at_b ? at_a < at_b : a < b;
}

void TileSchedule::push_farthest(std::uint32_t place) {
    farthest_.push_back(place);
    std::push_heap(farthest_.begin(), farthest_.end(),
                   [this](std::uint32_t a, std::uint32_t b) { return is_nearer(a, b); });
}

void TileSchedule::merge() {
    if (chosen_ <= capacity_) return;
    const auto nearer = [this](std::uint32_t a, std::uint32_t b) { return is_nearer(a, b); };
    for (std::uint32_t place = 0; place < passing_.size(); ++place)
        if (passing_[place].chosen) farthest_.push_back(place);
    std::make_heap(farthest_.begin(), farthest_.end(), nearer);
    while (chosen_ > capacity_) {
        std::pop_heap(farthest_.begin(), farthest_.end(), nearer);
        const std::uint32_t place = farthest_.back();
        farthest_.pop_back();
        // Else it has gone with a sibling.
        if (passing_[place].chosen) merge_into_parent(place);
    }
}

// With the siblings; what of them has finer tiles chosen keeps these.
void TileSchedule::merge_into_parent(std::uint32_t place) {
    ++result_.counters.merges;
    const std::uint32_t above = passing_[place].parent;
    Passing& parent = passing_[above];
    for (std::uint32_t i = parent.first_child; i < parent.first_child + parent.children; ++i)
        chosen_ -= std::exchange(passing_[i].chosen, false);
    if (parent.node.level == 0 || parent.chosen) return;
    parent.chosen = true;
    ++chosen_;
    push_farthest(above);
}

void TileSchedule::publish() {
    tiles_.clear();
    for (const Passing& tile : passing_) {
        if (!tile.chosen) continue;
        tiles_.push_back({tile.node, tile.index, static_cast<float>(tile.distance_m)});
        result_.counters.finest_level = tile.node.level;
    }
    std::sort(tiles_.begin(), tiles_.end(), [](const ScheduledTile& a, const ScheduledTile& b) {
        if (a.node.level != b.node.level) return a.node.level < b.node.level;
        return a.distance_m != b.distance_m ? a.distance_m < b.distance_m : a.index < b.index;
    });
    result_.tiles = tiles_;
}

}  // namespace ridgeline::select
