// zstd, one call each way, with a context kept per thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/base/result.h"

namespace ridgeline::io {

// Level 3 is where heights and meshes stop shrinking for the time spent (docs/benchmarks.md).
constexpr int kUsualLevel = 3;

// Appends the compressed bytes to `out`.
void compress(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& out, int level = kUsualLevel);
// Fails unless the whole of `compressed` is one frame of exactly bytes.size() bytes.
Result<void> decompress(std::span<const std::uint8_t> compressed, std::span<std::uint8_t> bytes);

// The same for the frame that `compressed` begins with, which is taken off it.
Result<void> decompress_front(std::span<const std::uint8_t>& compressed, std::span<std::uint8_t> bytes);

}  // namespace ridgeline::io
