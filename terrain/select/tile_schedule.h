// Which tiles of a texture over the ground a frame wants: imagery, or heights for a surface that samples
// them.
//
// Those that the picture's ground touches, or may soon, and whose parents' texels would cover more than the tolerated
// pixels there; of them those that something samples, the finest tile winning everywhere; and no more of them
// than the cache has slots (scheduling paper, 3.1). Level 0 has slots of its own, is always there, and is
// never among them.
//
// One thread at a time (a job). The result lives in the schedule until the next run(). Memory grows with what
// is chosen, not with the tree; after the first frames run() allocates nothing.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "ridgeline/io/grid.h"
#include "ridgeline/io/imagery_record.h"
#include "ridgeline/select/ground_bounds.h"
#include "ridgeline/select/ground_mask.h"
#include "ridgeline/select/view.h"

namespace ridgeline::select {

// A quadtree of tiles and where it lies.
struct TileTree {
    // A node's quads are a tile's texels, its cells the texels themselves.
    io::Grid grid;
    // The north-western corner of the lattice, and the size of a finest texel; world metres.
    double west_m = 0.0, north_m = 0.0;
    double spacing_x_m = 1.0, spacing_y_m = 1.0;
    // By place in linear order: whether there is such a tile. A tile that is there has an ancestor at every
    // level. Empty: all are there.
    std::vector<bool> present;
    // So many of the finest levels have a tile wherever the level above them has one: they are made, and `present`
    // says nothing of them.
    int made_levels = 0;

    bool is_made(int level) const { return level > grid.finest() - made_levels; }
    bool has(std::size_t index) const { return present.empty() || present[index]; }
    GroundRectangle area(io::NodeId node) const;
};

// The tiles of a store's heights. made: octaves of ground below them, which have tiles as well.
TileTree heights_tree(const io::TerrainInfo& info, std::span<const io::NodeRecord> records, int made = 0);

// The tiles of a store's imagery.
TileTree imagery_tree(const io::ImageryInfo& info, std::span<const io::ImageryRecord> records);

// What a frame sees of the ground, and from where.
struct GroundView {
    // Holds all that is seen, but for what only may be soon; empty where that is nothing.
    GroundRectangle rectangle;
    // What is seen in any of them is; without masks all of the rectangle is.
    std::span<const GroundMask> seen;
    // As in View.
    glm::dvec3 eye_m{0.0};
    // Along it tiles' distances are measured, but for what the picture's corners see, whose cosine to it this
    // is. By default they are distances to the eye.
    glm::dvec3 forward{0.0};
    double least_cosine = 1.0;
    double projection_px = 512.0;
    double pixel_error_px = 1.0;
    double exaggeration = 1.0;
    // The eye's over the ground: made tiles' ground is no nearer than half of it, but for cliffs.
    double eye_above_ground_m = 0.0;
    // Ground in the picture that is no farther than this may be seen before its tiles have come, whatever hides it now: it
    // counts as seen.
    ExtensionZone picture;
    double soon_m = 0.0;

    bool sees(const GroundRectangle& area) const;
    // A box about ground.
    bool may_see_soon(const Box& box) const;
};

struct ScheduledTile {
    io::NodeId node;
    std::int64_t index = 0;   // in linear order
    float distance_m = 0.0f;  // to the nearest of its ground in the rectangle
};

struct TileScheduleCounters {
    std::uint32_t passing = 0;  // tiles that the threshold chose, at all levels
    std::uint32_t sampled = 0;  // ... of them those that something samples: level 0 left out
    std::uint32_t merges = 0;
    int finest_level = 0;  // of the tiles
};

struct TileScheduleResult {
    // Coarse before fine, near before far: the order of urgency. Never level 0.
    std::span<const ScheduledTile> tiles;
    TileScheduleCounters counters;
};

class TileSchedule {
  public:
    // capacity: slots, the N of the paper. ground: outlives the schedule.
    TileSchedule(TileTree tree, const GroundBounds& ground, std::size_t capacity);

    const TileScheduleResult& run(const GroundView& view);
    // How many pixels a parent's texels may cover before made tiles take its place, from the next run() on; nothing: no
    // made tile is chosen, as at first.
    void choose_made(std::optional<double> pixel_error_px) { made_pixel_error_px_ = pixel_error_px; }
    const TileScheduleResult& result() const { return result_; }
    const TileTree& tree() const { return tree_; }
    std::size_t capacity() const { return capacity_; }

    // The distance within which a level's tiles are too coarse for a view.
    double reach_m(int level, const GroundView& view) const;
    // From the eye to the nearest ground that part of a level's tile may have; at the eye's height where it
    // has none.
    double distance_m(const GroundRectangle& area, int level, const GroundView& view) const;
    // Whether the view may soon see such ground.
    bool may_see_soon(const GroundRectangle& area, int level, const GroundView& view) const;

  private:
    Box box_about(const GroundRectangle& area, int level, const GroundView& view) const;
    // A tile that the threshold chose.
    struct Passing {
        io::NodeId node;
        std::int64_t index = 0;
        std::uint32_t parent = 0;  // in passing_
        std::uint32_t first_child = 0, children = 0;
        double distance_m = 0.0;
        bool chosen = false;
    };

    int finest() const { return tree_.grid.finest() - (made_pixel_error_px_ ? 0 : tree_.made_levels); }
    void divide(const GroundView& view);
    void divide(std::uint32_t place, const GroundView& view);
    void merge();
    void merge_into_parent(std::uint32_t place);
    bool is_nearer(std::uint32_t a, std::uint32_t b) const;
    void push_farthest(std::uint32_t place);
    void publish();

    TileTree tree_;
    const GroundBounds& ground_;
    std::size_t capacity_;
    std::optional<double> made_pixel_error_px_;
    std::array<int, io::Grid::kMaxLevels> ground_level_{};  // whose nodes bound a level's tiles

    std::vector<Passing> passing_;         // level by level; children of one tile together
    std::vector<std::uint32_t> farthest_;  // a heap
    std::size_t chosen_ = 0;
    std::vector<ScheduledTile> tiles_;
    TileScheduleResult result_;
};

}  // namespace ridgeline::select
