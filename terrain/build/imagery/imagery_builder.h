// Rows of texels into an imagery layer: pyramid, blocks, packed tiles, on every core, deterministically.
//
// The thread that calls reads and writes and works with the others while it waits; the next rows are read
// while tiles are made of those before. What is held of the picture is a few hundred rows (imagery_levels.h).
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "ridgeline/base/result.h"
#include "ridgeline/build/imagery/image_encoder.h"
#include "ridgeline/build/imagery/texel_rows.h"
#include "ridgeline/io/imagery_writer.h"
#include "ridgeline/jobs/job_system.h"

namespace ridgeline::build {

// The memory in which such imagery is built by so many threads, GDAL's cache apart.
std::uint64_t imagery_memory_bytes(const io::ImageryInfo& info, int threads);

struct ImageryWork {
    TexelRows& rows;
    ImageEncoder& encoder;
    jobs::JobSystem& jobs;
    // Called with rows done and in all; an Error ends the work.
    std::function<Result<void>(std::int64_t, std::int64_t)> progress;
};

// Gives all tiles to the writer. The error where no texel has imagery names the first source.
Result<void> build_tiles(const ImageryWork& work, io::ImageryWriter& writer);

}  // namespace ridgeline::build
