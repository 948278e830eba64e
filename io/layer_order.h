// The order in which a layer's payloads lie: the one in which walking asks for them.
//
// Level by level, coarsest first, along a Hilbert curve within a level, so that children lie together.
// Payloads come to a writer in any order, wait in a scratch file and are copied into this one at the end.
// Thread rules: one thread at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/io/grid.h"
#include "ridgeline/io/output_file.h"

namespace ridgeline::io {

// The nodes of a level along the Hilbert curve.
std::vector<NodeId> hilbert_order(const Grid& grid, int level);

// A payload as its record has it; size 0: there is none.
struct WaitingPayload {
    std::uint64_t* offset = nullptr;
    std::uint32_t size = 0;
};

struct LayerCopy {
    const Grid& grid;
    const OutputFile& waiting;
    std::function<WaitingPayload(NodeId)> payload;
    // Called with the payloads copied since it was called last; false stops the writing with an Error.
    std::function<bool(std::int64_t)> progress;
};

// Makes the file at `path`, sets the records' offsets to their places in it, and returns its size; the file
// is synced.
Result<std::uint64_t> copy_in_order(const LayerCopy& copy, const std::filesystem::path& path);

// A file of `head` and `body`, synced.
Result<void> write_file(const std::filesystem::path& path, std::span<const std::byte> head,
                        std::span<const std::byte> body);

}  // namespace ridgeline::io
