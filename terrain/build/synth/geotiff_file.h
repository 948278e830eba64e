// A GeoTIFF of heights or colours that is written strip after strip and appears at its place when it is
// complete.
//
// One thread writes; GDAL compresses on threads of its own. Until finish() the file has a name of its own
// beside its place; whatever does not get that far leaves nothing there.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "ridgeline/base/result.h"
#include "ridgeline/synth/synth.h"

namespace ridgeline::synth {

// What a sample is: a float in metres; red, green and blue in a byte each.
enum class Samples { heights, colours };

struct GeoTiffShape {
    Samples samples = Samples::heights;
    int size = 0;  // samples along either side
    double spacing_m = 1.0;
    int tile = 256;  // samples along a tile's side
    int threads = 1;
};

class GeoTiffFile {
  public:
    // Fails at once where something stands at `path` that must not be replaced.
    static Result<GeoTiffFile> create(const std::string& path, Replace replace, const GeoTiffShape& shape);

    GeoTiffFile(GeoTiffFile&&) noexcept;
    GeoTiffFile& operator=(GeoTiffFile&&) noexcept;
    ~GeoTiffFile();

    // The next full-width rows, northmost first.
    Result<void> write_rows(int row, int rows, std::span<const float> heights_m);
    Result<void> write_rows(int row, int rows, std::span<const std::uint8_t> colours);
    // Closes the file and moves it to its place, if that is still free or may be replaced.
    Result<void> finish();

  private:
    struct State;
    explicit GeoTiffFile(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace ridgeline::synth
