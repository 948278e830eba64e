#include "ridgeline/render/level_matrix.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace ridgeline::render {
namespace {

constexpr std::size_t kBlockBytes = shaders::kQuadtreeEntries * sizeof(shaders::QuadtreeCell);

}  // namespace

Result<LevelMatrixReader> LevelMatrixReader::create() {
    auto ring = gl::ReadbackRing::create(
        {.slot_bytes = kMostBlocks * kBlockBytes, .slots = kInFlight, .label = "level matrix"});
    if (!ring) return ring.error();
    LevelMatrixReader reader;
    reader.ring_ = std::move(ring).value();
    return reader;
}

void LevelMatrixReader::request(const shaders::QuadtreeUniforms& view, const QuadtreeBlocks& blocks,
                                const gl::Buffer& cells) {
    // Coarse before fine.
    const auto shown = blocks.blocks().first(std::min(blocks.blocks().size(), kMostBlocks));
    if (ring_.request(cells, 0, shown.size() * kBlockBytes, requests_) == gl::ReadbackRing::Accepted::no)
        return;
    LevelMatrix& asked = asked_[requests_++ % kInFlight];
    asked.view = view;
    asked.blocks.assign(shown.begin(), shown.end());
}

const LevelMatrix* LevelMatrixReader::newest() {
    while (const auto arrived = ring_.take()) {
        if (!newest_) newest_.emplace();
        // The memory of both stays in use.
        LevelMatrix& asked = asked_[arrived->tag % kInFlight];
        newest_->view = asked.view;
        std::swap(newest_->blocks, asked.blocks);
        newest_->cells.resize(newest_->blocks.size() * shaders::kQuadtreeEntries);
        std::memcpy(newest_->cells.data(), arrived->bytes.data(),
                    newest_->cells.size() * sizeof(shaders::QuadtreeCell));
    }
    return newest_ ? &*newest_ : nullptr;
}

}  // namespace ridgeline::render
