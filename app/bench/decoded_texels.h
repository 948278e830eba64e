// A picture's texels in memory, so that what is measured is what becomes of them and not how a file is read; and
// what BC1 makes of them, texel by texel.
//
// Thread rules: immutable once read; read() one thread at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/build/imagery/image_encoder.h"
#include "ridgeline/build/imagery/texel_rows.h"

namespace ridgeline::app {

class DecodedTexels final : public build::TexelRows {
  public:
    // All rows, or the northmost that have no more than so many texels.
    static Result<std::unique_ptr<DecodedTexels>> read_from(build::TexelRows& rows, std::int64_t most_texels);

    const io::ImageryInfo& info() const override { return info_; }
    Result<void> read(std::int64_t row, std::int64_t rows, std::span<build::Texel> texels) override;

    const build::Texel& at(std::int64_t x, std::int64_t y) const {
        return texels_[static_cast<std::size_t>(y * info_.width + x)];
    }
    std::int64_t count() const { return info_.width * info_.height; }

  private:
    io::ImageryInfo info_;
    std::vector<build::Texel> texels_;
};

// What a block shows.
build::BlockTexels shown_texels(const io::Bc1Block& block);

// Squared differences of opaque texels, red, green and blue.
class SquaredErrors {
  public:
    // Both count only where both have a colour.
    void add(const build::Texel& is, const build::Texel& shown);
    // Peak signal to noise ratio over all three channels, decibels; infinite without any difference.
    double psnr_db() const;
    std::int64_t texels() const { return texels_; }

  private:
    double squares_ = 0.0;
    std::int64_t texels_ = 0;
};

}  // namespace ridgeline::app
