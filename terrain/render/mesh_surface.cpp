#include "ridgeline/render/mesh_surface.h"

#include <utility>
#include <vector>

#include "ridgeline/base/contract.h"
#include "ridgeline/gl/capabilities.h"

namespace ridgeline::render {
namespace {

constexpr const char* kFragmentStage = "passes/terrain.frag";

// A hole in a crest shows what is behind it, which the horizon has left out as hidden. Where culling makes
// such holes, fragments of back faces are dropped instead: facing is that of what is rasterised then. (Both
// faces drawn would show slivers of hidden ground seen edge-on, whose depths are anything.)
bool must_cull_fragments() { return gl::query_capabilities().culls_before_snapping; }

}  // namespace

Result<MeshSurface> MeshSurface::create(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                                        const GpuSlots& slots) {
    MeshSurface surface(ChunkBatch(info, records, slots, 1));
    surface.culls_fragments_ = must_cull_fragments();
    RIDGELINE_TRY(surface.build(slots));
    return surface;
}

// Whatever is allowed by now, in every combination, and not yet there.
Result<void> MeshSurface::build(const GpuSlots& slots) {
    for (const Lighting lighting : {Lighting::unshadowed, Lighting::shadowed})
        for (const Cover cover : {Cover::tint, Cover::imagery}) {
            if (lighting > most_lighting_ || cover > most_cover_ || !programs(lighting, cover).whole.empty())
                continue;
            std::vector<gl::ShaderDefine> defines;
            if (lighting == Lighting::shadowed) defines.push_back({"RIDGELINE_SHADOWS", "1"});
            if (cover == Cover::imagery) defines.push_back({"RIDGELINE_IMAGERY", "1"});
            if (cover == Cover::imagery && coverage_ == Coverage::wholly)
                defines.push_back({"RIDGELINE_IMAGERY_WHOLE", "1"});
            if (culls_fragments_) defines.push_back({"RIDGELINE_CULL_FRAGMENTS", "1"});
            auto built = chunk_programs(kFragmentStage, slots.shape(), defines);
            if (!built) return built.error();
            programs(lighting, cover) = std::move(built).value();
        }
    return {};
}

Result<void> MeshSurface::allow_shadows(const GpuSlots& slots) {
    most_lighting_ = Lighting::shadowed;
    return build(slots);
}

Result<void> MeshSurface::allow_imagery(const GpuSlots& slots, Coverage coverage) {
    most_cover_ = Cover::imagery;
    coverage_ = coverage;
    return build(slots);
}

bool MeshSurface::prepare(const select::SelectionResult& selection, const MadeRegion* region,
                          const ChunkPlaces& places, gl::StagingRing& ring) {
    batch_.clear();
    for (const select::DrawEntry& entry : selection.draws) {
        if (!region)
            batch_.append(entry, places, 1u);
        else if (!region->node(entry.node))
            batch_.append(region->beside(entry), places, 1u);
    }
    return batch_.upload(ring);
}

void MeshSurface::draw(const GpuSlots& slots, const gl::StagingRing& ring, Lighting lighting, Cover cover) {
    const ChunkPrograms& drawn_with = programs(lighting, cover);
    RIDGELINE_CHECK(!drawn_with.whole.empty());
    batch_.bind(slots, ring);
    if (culls_fragments_) glDisable(GL_CULL_FACE);
    batch_.draw(0, drawn_with);
    glEnable(GL_CULL_FACE);
}

}  // namespace ridgeline::render
