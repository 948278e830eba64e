// A geometry clipmap, as far as its bytes go: what it would send to the GPU while an eye moves.
//
// Literature: Tanner et al. 1998, Losasso and Hoppe 2004, Asirvatham and Hoppe 2005. Each level of a pyramid
// is a window of fixed size about the eye, kept in a texture that is addressed round its edges (toroidally):
// when the eye moves, only what enters the window is sent, an L of two strips, and written over what left it.
//
// A window lies on its level's lattice of blocks (one texel, or the 4 x 4 that a compressed format codes
// together) and only whole blocks are sent. A level whose window could show nothing that needs it, because
// the eye is too high over the ground, rests where it is, as Losasso and Hoppe leave such levels out; when it
// is needed again, what still lies inside counts as there. What lies outside the data is never sent. The
// coarsest level is there as a whole from the start: an engine of tiles keeps it resident too.
//
// Plain values, no GL; one thread at a time.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace ridgeline::app {

using BlockPlace = glm::vec<2, std::int64_t>;

// Blocks [first, end) along both axes.
struct BlockRectangle {
    BlockPlace first{0}, end{0};

    BlockRectangle within(const BlockRectangle& other) const;
    std::int64_t area() const;  // 0 where it is empty
};

// What of a texture is sent together.
struct ClipmapFormat {
    int block_texels = 1;  // a block's side
    int block_bytes = 3;
};

// One level: how much of it there is, and from how far its texels are asked for.
struct ClipmapLevel {
    BlockPlace texels{0};
    // World metres a texel.
    glm::dvec2 texel_m{1.0};
    // Ground nearer to the eye than this needs the level. The window holds all of it, wherever the eye stands
    // in its block.
    double reach_m = 0.0;
};

class ClipmapWindow {
  public:
    ClipmapWindow(const ClipmapLevel& level, const ClipmapFormat& format);

    // Moves to an eye at this place, counted in texels of the level from the data's north-western corner.
    // Returns the bytes sent for it.
    std::int64_t move_to(const glm::dvec2& eye_texels);

    // The window's sides.
    BlockPlace size_texels() const { return size_ * std::int64_t{format_.block_texels}; }
    double reach_m() const { return reach_m_; }
    const BlockRectangle& window() const { return window_; }
    // The data's.
    const BlockRectangle& extent() const { return extent_; }

  private:
    ClipmapFormat format_;
    BlockRectangle extent_;
    glm::dvec2 reach_texels_;
    double reach_m_;
    BlockPlace size_;
    BlockRectangle window_;  // empty before the first move
};

class Clipmap {
  public:
    // levels: coarsest first.
    Clipmap(const std::vector<ClipmapLevel>& levels, const ClipmapFormat& format);

    // The coarsest level's bytes, before the first move.
    std::int64_t base_bytes() const { return base_bytes_; }
    // from_corner_m: eastwards and southwards from the data's north-western corner. above_ground_m: of the
    // eye over the ground under it. Returns the bytes sent.
    std::int64_t move_to(const glm::dvec2& from_corner_m, double above_ground_m);

    // Without the coarsest.
    const std::vector<ClipmapWindow>& windows() const { return windows_; }

  private:
    std::vector<ClipmapWindow> windows_;
    std::vector<glm::dvec2> texel_m_;
    std::int64_t base_bytes_ = 0;
};

}  // namespace ridgeline::app
