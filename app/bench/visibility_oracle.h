// What of a frame can truly be seen: the reference against which the horizon is measured.
//
// Vertical half planes through the eye, many to a pixel, cut the drawn triangles themselves, morphed as the
// vertex shader morphs them. In such a slice a place is seen where no nearer one stands as steeply above the
// eye, so what a slice says is exact; what lies between two slices goes unseen. Far too slow to draw with.
// Memory is kept from view to view. One thread at a time.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <unordered_set>
#include <vector>

#include "ridgeline/io/grid.h"
#include "ridgeline/io/node_record.h"
#include "ridgeline/select/ground_source.h"
#include "ridgeline/select/selection.h"

namespace ridgeline::app {

// What a camera sees that looks level.
struct LevelView {
    glm::dvec2 heading{0.0, 1.0};         // unit length, east and north
    glm::dvec2 half_tangents{1.0, 0.75};  // of half the field, across and up
};

// In order: of several parts, the greatest holds for the whole.
enum class Sight : std::uint8_t {
    outside,  // no slice has any of it in the picture
    hidden,   // no slice sees any of it, for ground that stands before it
    unknown,  // no slice surely sees it, but in some a ray may have got under the ground through a hole
    seen,
};

// A quarter of a draw entry.
struct JudgedQuarter {
    const select::DrawEntry* entry = nullptr;
    int quarter = 0;
    Sight sight = Sight::outside;
    std::uint32_t triangles = 0;
    // Of what is seen: a ray that meets it first, as tangents across and up, and the least distance to either
    // side, up and down, at which another one does not.
    glm::dvec2 ray{0.0};
    double clearance = 0.0;
};

struct OracleOptions {
    // Four to a pixel, where a picture is 1024 wide.
    int slices = 4096;
};

class VisibilityOracle {
  public:
    // The references outlive the oracle. records: as in Store::records().
    VisibilityOracle(const io::Grid& grid, std::span<const io::NodeRecord> records,
                     const select::GroundSource& chunks, const OracleOptions& options = {});

    // draws: all that the view draws where nothing is left out; it outlives the result, which stays until the
    // next call. The eye is over ground that is drawn.
    std::span<const JudgedQuarter> judge(const select::EyeFrame& eye,
                                         std::span<const select::DrawEntry> draws, const LevelView& view);

  private:
    // Ground, or a square that has none: front to back by its key.
    struct Item {
        std::uint64_t key = 0;
        io::NodeId square;
        const select::DrawEntry* entry = nullptr;  // null: a hole
        int quarter = 0;
    };
    // Along the view, to its right, and up; metres from the eye.
    struct Point {
        double along = 0.0, right = 0.0, up = 0.0;
    };
    // One slice: how steep the ground so far stands, and how steep the item at hand lies in it.
    struct Slice {
        double horizon, least, most;
        bool open;  // rays may be under the ground
    };

    void collect(std::span<const select::DrawEntry> draws);
    void collect_holes(io::NodeId node);
    std::uint64_t key_of(io::NodeId square) const;
    Point turned(const glm::dvec3& from_eye_m) const;

    void cut_hole(io::NodeId square);
    std::uint32_t cut_quarter(const Item& item);
    void place_vertices(const select::DrawEntry& entry);
    void cut_edge(const Point& a, const Point& b);
    void take(int slice, double slope);
    JudgedQuarter look(const Item& item, std::uint32_t triangles);
    void open_touched();
    void forget_touched();

    const io::Grid& grid_;
    std::span<const io::NodeRecord> records_;
    const select::GroundSource& chunks_;
    bool has_holes_ = false;

    select::EyeFrame eye_;
    LevelView view_;
    std::vector<Item> items_;
    std::unordered_set<std::int64_t> drawn_;  // nodes, by linear place; kept where there are holes
    std::vector<Slice> slices_;
    int first_touched_ = 0, last_touched_ = -1;
    const select::DrawEntry* placed_ = nullptr;  // whose vertices these are
    std::vector<Point> vertices_;
    std::vector<JudgedQuarter> judged_;
};

}  // namespace ridgeline::app
