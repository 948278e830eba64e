// Chunks of a store in memory, read when they are first wanted: what a pager would bring a selection, at once
// and without one.
//
// Reads block. One thread at a time, but chunk() on any while a selection runs. The store outlives it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "ridgeline/io/chunk_reader.h"
#include "ridgeline/select/ground_source.h"
#include "ridgeline/select/selection.h"

namespace ridgeline::app {

class ResidentChunks final : public select::GroundSource {
  public:
    explicit ResidentChunks(const io::Store& store);

    // Reads what a selection with these residents wanted, and says how much of it was not there.
    Result<std::size_t> bring(const select::SelectionResult& selected);
    // Forgets all chunks once they have become many; no selection may hold on to any.
    void trim();

    select::Residency residency() const { return residency_; }
    io::ChunkView chunk(std::uint32_t index) const override { return chunks_[index]->view; }

  private:
    Result<void> load(select::NodeIndex index);

    io::Grid grid_;
    io::ChunkReader reader_;
    std::vector<io::NodeResidency> residency_;
    std::vector<std::unique_ptr<io::OwnedChunk>> chunks_;  // by node
    std::size_t count_ = 0;
};

}  // namespace ridgeline::app
