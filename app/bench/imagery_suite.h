// Suite `imagery`: how fast each encoder is and how near its blocks come to the picture, and what a store's imagery
// takes beside its source.
//
// The source is decoded into memory first. Variants take turns, round by round, so that they meet the same load; a
// variant's time is that of its best round. One thread at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ridgeline/app/bench/decoded_texels.h"
#include "ridgeline/app/bench/figures.h"
#include "ridgeline/base/result.h"
#include "ridgeline/build/imagery/image_encoder.h"
#include "ridgeline/io/store.h"

namespace ridgeline::app {

struct ImagerySuiteOptions {
    int threads = 0;  // that make texels, and encode where the CPU does; 0: one a core
    int rounds = 5;
    // Of the source, the northmost: what is held in memory, 9 bytes each.
    std::int64_t most_texels = std::int64_t{1} << 28;
    // Called with rounds done and in all.
    std::function<void(std::int64_t done, std::int64_t total)> progress;
};

struct NamedEncoder {
    std::string name;
    build::ImageEncoder& encoder;
};

// Variants encoder/NAME: from texels to blocks and nothing else, over the source's whole squares of 256² texels (of
// less where it is smaller), which is what psnr_db is of; layer/NAME: from texels in memory to the layer's files, all
// levels, gutters and mips in. Metrics: mpixel_per_s by the clock and mpixel_per_cpu_s by the CPU time of all the
// process's threads, source texels counted once; psnr_db; of a layer bytes and bytes_per_texel. Where the store has
// imagery, store/imagery: bytes, bytes_per_texel and, on the source's lattice alone, psnr_db of the finest level. Where
// the sources are files, bytes_ratio: layer's or store's to theirs, which is source_bytes.
Result<Figures> compare_encoders(const io::Store& store, const std::vector<std::string>& sources,
                                 const std::vector<NamedEncoder>& encoders,
                                 const ImagerySuiteOptions& options);

}  // namespace ridgeline::app
