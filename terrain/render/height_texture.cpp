#include "ridgeline/render/height_texture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <utility>

#include "ridgeline/base/contract.h"
#include "ridgeline/pager/heights_texels.h"

namespace ridgeline::render {
namespace {

static_assert(shaders::kHeightApron == io::HeightsTile::kApron);

int tile_bits(const io::Grid& grid) { return std::countr_zero(static_cast<unsigned>(grid.quads())); }

VirtualTextureOptions texture_options(const io::Grid& grid, const SlotShape& shape) {
    return {.kind = pager::TileKind::heights,
            .grid = grid,
            .tile_bits = tile_bits(grid),
            .shape = shape,
            .texels = {.format = GL_R32I,
                       .layout = {GL_RED_INTEGER, GL_INT},
                       .mips = {{pager::heights_texels_side(grid.quads()), 0}},
                       .label = "heights"},
            .bindings = {shaders::kDiscUniformsBinding, shaders::kHeightFadesBinding,
                         shaders::kHeightTableUnit, shaders::kHeightTilesUnit}};
}

}  // namespace

shaders::DiscUniforms disc_uniforms(const io::Grid& grid, const DiscView& view) {
    shaders::DiscUniforms disc{};
    disc.eye_cell_and_size =
        glm::ivec4(view.eye.cell, static_cast<int>(grid.width()), static_cast<int>(grid.height()));
    const float spacing_m = std::max(view.eye.spacing_m.x, view.eye.spacing_m.y);
    disc.eye =
        glm::vec4(view.eye.cell_rest, 1.0f / (static_cast<float>(view.projection_px) * spacing_m), 0.0f);
    // The cell is kept on the terrain, the eye need not be.
    const glm::vec2 middle = glm::clamp(view.eye.cell_rest, glm::vec2(0.0f), glm::vec2(1.0f));
    const float above = static_cast<float>(view.eye_above_ground_m) / spacing_m;
    disc.middle =
        glm::vec4(middle, glm::length(glm::vec2(above, glm::distance(middle, view.eye.cell_rest))), 0.0f);
    return disc;
}

Result<HeightTexture> HeightTexture::create(const pager::TileSource& source,
                                            const detail::FinerGround& ground, const SlotOptions& options) {
    RIDGELINE_CHECK(source.heights_tiles == pager::HeightsTiles::paged);
    const io::Grid grid = source.grid.finer(ground.octaves());
    const auto shape = plan_slots(heights_demand(source, ground.octaves()), options);
    if (!shape) return shape.error();
    auto tiles = VirtualTexture::create(source.tiles(), texture_options(grid, *shape));
    if (!tiles) return tiles.error();
    HeightTexture heights(grid, ground, std::move(tiles).value());
    if (ground.octaves() == 0) return heights;
    auto made = MadeTiles::create(ground, grid, shape->layers());
    if (!made) return made.error();
    heights.made_.emplace(std::move(made).value());
    heights.made_heights_ = std::make_unique<MadeHeights>(ground, source.grid.finest(), grid.quads());
    return heights;
}

std::span<const std::byte> HeightTexture::texels(std::uint32_t slot, const pager::Pager& pager) const {
    const pager::NodeIndex tile = tiles_.tile(slot);
    return tile == pager::kNoNode ? made_heights_->texels(made_->node(slot), pager) : pager.heights(tile);
}

std::int32_t HeightTexture::texel(const glm::ivec2& at, std::uint32_t slot, const pager::Pager& pager) const {
    const pager::NodeIndex tile = tiles_.tile(slot);
    if (tile == pager::kNoNode) return made_heights_->texel(made_->node(slot), at, pager);
    const int side = pager::heights_texels_side(grid_.quads());
    return pager::heights_texel(pager.heights(tile), static_cast<std::size_t>(at.y * side + at.x));
}

HeightTexture::HeightTexture(const io::Grid& grid, const detail::FinerGround& ground, VirtualTexture tiles)
    : grid_(grid),
      detail_(ground.octaves(), ground.shift, 0, 0),
      tiles_(std::move(tiles)),
      sampler_(gl::Sampler::create({.min_filter = GL_NEAREST, .mag_filter = GL_NEAREST})) {}

void HeightTexture::look_from(const DiscView& view, const pager::Pager& pager) {
    uniforms_ = disc_uniforms(grid_, view);
    uniforms_.detail = detail_;
    uniforms_.eye.w = std::ldexp(1.0f, -detail_.y);
    uniforms_.table = glm::ivec4(grid_.finest(), tiles_.window_bits(), tile_bits(grid_));
    tiles_.look_from(view.eye.cell, pager);
}

bool HeightTexture::prepare(const DiscView& view, const pager::Pager& pager, gl::StagingRing& ring) {
    look_from(view, pager);
    return tiles_.send(std::as_bytes(std::span(&uniforms_, 1)), ring);
}

}  // namespace ridgeline::render
