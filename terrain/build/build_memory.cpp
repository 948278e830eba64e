#include "ridgeline/build/build_memory.h"

#include <algorithm>
#include <string>

#include "ridgeline/base/units.h"
#include "ridgeline/build/blocks.h"
#include "ridgeline/build/error_code.h"
#include "ridgeline/io/node_record.h"

namespace ridgeline::build {
namespace {

// The program with its libraries, before it does anything.
constexpr std::uint64_t kProgramBytes = 40_MiB;
// What one computing thread takes: a TileMaker's arrays and two slots.
constexpr std::uint64_t kThreadBytes = 24_MiB;
// The calling thread, and the one worker that a job system has at least.
constexpr int kFewestThreads = 2;
// Enough for GDAL, little beside the caches.
constexpr std::int64_t kBandBytes = 8 << 20;
constexpr std::uint64_t kMostRasterCache = 128_MiB;

// Bytes a point of the lattice of every eighth sample: its samples (4) and codes (1, while coarser ones are
// found), a third of that for the coarser lattices, whose codes come in growing arrays that may be twice as
// large as what they hold.
constexpr double kLatticeBytes = (4.0 + 1.5) * 4.0 / 3.0 + 1.0;
// Means and weights of the fill, and a third for its coarser lattices.
constexpr double kFillBytes = 8.0 * 4.0 / 3.0;
// By block: its histogram, the copy from which coarse levels are counted and a third for those; the fine
// vertices of coarse nodes, a quarter of a node's budget (2 000 of 12 bytes), in arrays grown likewise, with
// its list; a corner's surface in every coarse level, over roots that reach past the raster.
constexpr double kBlockBytes = kErrorCodes * 4 * 7.0 / 3.0 + 2000 / 4 * 12 * 2 + 24 + 16 * 8 * 4;
// By node: the record, its error and whether it has data; then its place on the curve, sorted, in a growing
// array, and the result.
constexpr double kNodeBytes = sizeof(io::NodeRecord) + 4 + 1 + 2 * 24 + 2 * 12;
// By row: where it lies in the scratch file, in a growing array.
constexpr double kRowBytes = 2 * 16;

double raster_bytes(const BuildShape& shape) {
    const io::Grid& grid = shape.grid;
    const auto eighths = [](std::int64_t samples) { return static_cast<double>((samples - 2) / 8 + 2); };
    const double points = eighths(grid.width()) * eighths(grid.height());
    return points * (kLatticeBytes + (shape.may_have_nodata ? kFillBytes : 0.0)) +
           static_cast<double>(BlockGrid(grid).count()) * kBlockBytes +
           static_cast<double>(grid.node_count()) * kNodeBytes +
           static_cast<double>(grid.height()) * kRowBytes;
}

// All but threads and caches: a band is held as it came and, below it, packed.
std::uint64_t fixed_bytes(const BuildShape& shape) {
    const std::int64_t band = std::min(band_rows(shape), shape.grid.height()) * shape.grid.width() * 4 * 2;
    return kProgramBytes + static_cast<std::uint64_t>(band) + static_cast<std::uint64_t>(raster_bytes(shape));
}

constexpr std::uint64_t in_whole_mib(std::uint64_t bytes) { return (bytes + 1_MiB - 1) / 1_MiB * 1_MiB; }

}  // namespace

std::int64_t band_rows(const BuildShape& shape) {
    const std::int64_t fitting = kBandBytes / (shape.grid.width() * std::int64_t{sizeof(std::int32_t)});
    const std::int64_t natural = shape.natural_rows;
    return std::max<std::int64_t>(fitting / natural * natural, std::min(natural, 4 * fitting + 1));
}

std::uint64_t raster_cache_bytes(std::uint64_t memory_bytes) {
    return std::min(kMostRasterCache, memory_bytes / 4);
}

std::uint64_t least_memory_bytes(const BuildShape& shape) {
    const std::uint64_t without_cache = fixed_bytes(shape) + kFewestThreads * kThreadBytes;
    // The cache is a quarter of all, so a third of the rest.
    return in_whole_mib(without_cache + std::min(kMostRasterCache, (without_cache + 2) / 3));
}

Result<int> affordable_threads(const BuildShape& shape, std::uint64_t memory_bytes) {
    const std::uint64_t least = least_memory_bytes(shape);
    if (memory_bytes < least)
        return Error{std::to_string(shape.grid.width()) + " x " + std::to_string(shape.grid.height()) +
                     " samples cannot be built in " + format_bytes(memory_bytes) + ": use --memory " +
                     std::to_string(least / 1_MiB) + "MiB or more"};
    const std::uint64_t left = memory_bytes - raster_cache_bytes(memory_bytes) - fixed_bytes(shape);
    return static_cast<int>(std::clamp<std::uint64_t>(left / kThreadBytes, kFewestThreads, 4096));
}

}  // namespace ridgeline::build
