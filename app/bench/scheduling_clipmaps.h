// The clipmaps that would show a store from a walk's eye as well as the walk does.
//
// A level's window must hold all ground that needs the level, to all sides, because a clipmap knows neither
// where the eye looks nor what mountains hide. Which ground needs it, the rules of our own tiles say:
//
//   texels   a level is needed where a texel of the next coarser one would cover more than the tolerated
//            pixels (tile_schedule.h): at less than s * P / e ahead, with s the coarser level's texel in metres,
//            P the pixels of a metre at a metre's distance, e the pixel error. What is as far ahead lies farther
//            away beside the picture's middle, and the eye may turn: a window is 4 P / (e cos a) texels wide, the
//            same at every level, with a the angle from the picture's middle to the middle of its side. (To its
//            corner would be farther; a level eye sees no ground there but what is near.) So imagery, and heights
//            where they are sampled.
//   errors   heights where they are vertices: a level is needed where the next coarser one's vertical error
//            would be seen (criterion screen_error): nearer than E * P / e, with E the median of the errors of
//            that level's nodes. A grid that must be everywhere as good as our tiles would have to go by the
//            largest.
//
// As each of our tiles does, a level goes by distance in space: it rests while the ground that the store's
// records bound under the eye is farther below than that.
//
// Render thread or any other, one at a time; the store outlives it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "ridgeline/app/bench/clipmap.h"
#include "ridgeline/app/bench/cpu_lod.h"
#include "ridgeline/io/store.h"
#include "ridgeline/platform/camera.h"
#include "ridgeline/select/ground_bounds.h"

namespace ridgeline::app {

// Of a view, what says how near ground must be to need a level.
struct ClipmapView {
    double projection_px = 512.0;
    double pixel_error_px = 1.0;
    // Of the angle between the picture's middle and the middle of its side.
    double side_cosine = 1.0;
};
ClipmapView clipmap_view(const platform::Lens& lens, double pixel_error_px);

std::vector<ClipmapLevel> imagery_clipmap(const io::ImageryInfo& info, const ClipmapView& view);
// Heights as vertices: by errors.
std::vector<ClipmapLevel> vertex_clipmap(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                                         const ClipmapView& view);
// Heights as texels, at the pixels that the disc has for a sample.
std::vector<ClipmapLevel> sample_clipmap(const io::TerrainInfo& info, const ClipmapView& view);

// In what a clipmap holds its texels.
struct ClipmapFormats {
    enum class Heights { vertices, samples };

    ClipmapFormat imagery, heights;
    Heights heights_as = Heights::vertices;
};
// As our tiles hold theirs on the GPU: BC1; a vertex with its own height and the coarser level's, which is
// what Losasso and Hoppe's clipmap sends too, and a normal.
extern const ClipmapFormats kStoreFormats;
// Plain imagery, as the paper's would be.
extern const ClipmapFormats kRgb8Formats;
// Heights of 16 bits and nothing more, as a clipmap sends them whose vertices and normals are made on the
// GPU.
extern const ClipmapFormats kLeanFormats;
// As our disc holds them: BC1, and heights to be sampled.
extern const ClipmapFormats kDiscFormats;

class StoreClipmaps {
  public:
    // A store with imagery.
    StoreClipmaps(const io::Store& store, const ClipmapView& view, const ClipmapFormats& formats);

    // Everything before the first frame.
    SentBytes start(const glm::dvec3& eye_m);
    SentBytes move_to(const glm::dvec3& eye_m);

    const Clipmap& imagery() const { return imagery_; }
    const Clipmap& heights() const { return heights_; }

  private:
    double above_ground_m(const glm::dvec3& eye_m) const;

    glm::dvec2 imagery_corner_m_, heights_corner_m_;
    double highest_m_;
    int finest_;
    select::GroundBounds bounds_;
    Clipmap imagery_, heights_;
};

}  // namespace ridgeline::app
