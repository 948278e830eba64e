// One slice's horizon in the making: lines of ground raise it, squares of ground are held against it.
// Internal to the room; one thread a slice; nothing allocates.
//
// Two horizons in one: the exact one, and the same lines lowered by what the eye may rise until a tile asked
// for now is there.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "ridgeline/select/horizon.h"

namespace ridgeline::select {

// What decides how far below the horizon is hidden.
struct HorizonTolerance {
    // Radians that a pixel covers, times the share of it within which rasterisers move things.
    float margin = 0.0f;
    float rise_m = 0.0f;
};

// Heights over the eye as codes: base + code * step.
struct CodedHeights {
    double base_m = 0.0;
    double step_m = 0.0;
    double at(double code) const { return base_m + code * step_m; }
};

// A line of ground: vertex i stands at start + i * step + across[i] * across_step, in cells of a lattice.
struct GroundLine {
    glm::dvec2 start{0.0};                 // column, row
    glm::dvec2 step{1.0, 0.0};             // a vertex on
    glm::dvec2 across_step{0.0};           // per unit of across
    const std::uint8_t* across = nullptr;  // null: straight
    const std::uint16_t* codes = nullptr;  // 0 ends segments
    int count = 0;
};

// Codes of maxima over square cells of ground.
struct GroundMaxima {
    Lattice lattice;  // of the cells
    CodedHeights heights;
    const std::uint8_t* codes = nullptr;
    int stride = 0;  // cells in a row
};
struct CellRange {
    glm::ivec2 from{0};
    glm::ivec2 size{0};
};

class SliceHorizon {
  public:
    static constexpr int kMostVertices = 129;

    // picture: what is hidden is not drawn; both horizons. zone: it only matters what may be seen soon, so
    // the lowered one serves as both.
    enum class Use { picture, zone };
    void begin(const SliceView& view, const HorizonTolerance& tolerance, Use use);
    Use use() const { return use_; }
    const SliceView& view() const { return view_; }
    // Without what is lowered; in a slice of the zone, with.
    const HorizonColumns& exact() const { return exact_; }

    // Whether some of a square on the level lies in the slice.
    bool touches(const Lattice& lattice, const glm::ivec2& from, int side) const;

    // Of some ground: seen now, and from where the eye may be soon. Soon where now.
    struct Sight {
        bool now = false;
        bool soon = false;
        bool outside = false;  // of the slice
    };
    // The horizons that lines raise from now on: those by which the ground that they lie on is seen. In the
    // others they would change nothing, for they lie under what was found hidden.
    void aim(const Sight& seen) { aim_ = seen; }

    // near: some of the line may lie within a few cells of the eye; exact there, and slower.
    enum class Reach { far, near };
    void raise(const GroundLine& line, const Lattice& lattice, const CodedHeights& heights, Reach reach);
    // The same for a row or column of a mesh: heights over the eye, metres.
    void raise(const GroundLine& line, const Lattice& lattice, std::span<const float> heights_m);

    // Ground that reaches up to `top_m` over the eye may be open here.
    void close(const Lattice& lattice, const glm::ivec2& from, int side, double top_m);

    // What of the ground in a range of cells is seen.
    Sight look(const GroundMaxima& ground, const CellRange& range) const;
    // The same of a whole square up to one height.
    Sight look(const Lattice& lattice, const glm::ivec2& from, int side, double top_m) const;

  private:
    class Feed;

    bool sees(const HorizonColumns& columns, const GroundMaxima& ground, const CellRange& range) const;
    bool sees_cells(const HorizonColumns& columns, const GroundMaxima& ground, const CellRange& range) const;
    // In doubt seen.
    bool sees(const HorizonColumns& columns, const SeenSquares::Bounds& bounds, float height_m) const;
    void raise_far(const GroundLine& line, const Lattice& lattice, const CodedHeights& heights);
    void raise_run(std::span<const float> places, std::span<const float> values, const float* nearness);

    SliceView view_;
    Use use_ = Use::picture;
    HorizonTolerance tolerance_;
    double sunk_m_ = 0.0;  // of all lines
    float widened_ = 0.0f;
    Sight aim_;
    HorizonColumns exact_, lowered_;
};

}  // namespace ridgeline::select
