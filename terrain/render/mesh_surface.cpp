#include "ridgeline/render/mesh_surface.h"

#include <utility>

#include "ridgeline/base/contract.h"

namespace ridgeline::render {
namespace {

constexpr const char* kFragmentStage = "passes/terrain.frag";

}  // namespace

Result<MeshSurface> MeshSurface::create(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                                        const GpuSlots& slots) {
    auto programs = chunk_programs(kFragmentStage, slots.shape(), {});
    if (!programs) return programs.error();
    return MeshSurface(std::move(programs).value(), ChunkBatch(info, records, slots, 1));
}

MeshSurface::MeshSurface(ChunkPrograms unshadowed, ChunkBatch batch)
    : unshadowed_(std::move(unshadowed)), batch_(std::move(batch)) {}

Result<void> MeshSurface::allow_shadows(const GpuSlots& slots) {
    if (!shadowed_.whole.empty()) return {};
    auto programs = chunk_programs(kFragmentStage, slots.shape(), {{"RIDGELINE_SHADOWS", "1"}});
    if (!programs) return programs.error();
    shadowed_ = std::move(programs).value();
    return {};
}

bool MeshSurface::prepare(const select::SelectionResult& selection, const ChunkPlaces& places,
                          gl::StagingRing& ring) {
    batch_.clear();
    for (const select::DrawEntry& entry : selection.draws) batch_.append(entry, places, 1u);
    return batch_.upload(ring);
}

void MeshSurface::draw(const GpuSlots& slots, const gl::StagingRing& ring, Lighting lighting) {
    const ChunkPrograms& programs = lighting == Lighting::shadowed ? shadowed_ : unshadowed_;
    RIDGELINE_CHECK(!programs.whole.empty());
    batch_.bind(slots, ring);
    batch_.draw(0, programs);
}

}  // namespace ridgeline::render
