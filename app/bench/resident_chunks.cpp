#include "ridgeline/app/bench/resident_chunks.h"

#include <algorithm>

namespace ridgeline::app {
namespace {

// About a hundred kilobytes each.
constexpr std::size_t kMany = 8192;

}  // namespace

ResidentChunks::ResidentChunks(const io::Store& store)
    : grid_(store.grid()),
      reader_(store),
      residency_(store.records().size()),
      chunks_(store.records().size()) {}

Result<std::size_t> ResidentChunks::bring(const select::SelectionResult& selected) {
    const std::size_t before = count_;
    for (const select::WantedTile& tile : selected.wanted)
        if (!residency_[tile.index].resident) RIDGELINE_TRY(load(tile.index));
    return count_ - before;
}

Result<void> ResidentChunks::load(select::NodeIndex index) {
    auto chunk = std::make_unique<io::OwnedChunk>();
    RIDGELINE_TRY(reader_.read(grid_.node_at(index), *chunk));
    chunks_[index] = std::move(chunk);
    residency_[index].resident = true;
    ++count_;
    return {};
}

void ResidentChunks::trim() {
    if (count_ <= kMany) return;
    for (auto& chunk : chunks_) chunk.reset();
    std::ranges::fill(residency_, io::NodeResidency{});
    count_ = 0;
}

}  // namespace ridgeline::app
