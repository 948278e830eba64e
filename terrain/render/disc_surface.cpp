#include "ridgeline/render/disc_surface.h"

#include <algorithm>
#include <span>
#include <utility>

#include "ridgeline/base/contract.h"
#include "ridgeline/gl/debug_output.h"

namespace ridgeline::render {
namespace {

constexpr GLuint kVertexBinding = 0;
// Where passes/disc.vert has it.
constexpr GLint kRingLocation = 2;

// From a place to the farthest of the lattice's corners, in samples.
double farthest_corner(const shaders::DiscUniforms& disc) {
    const glm::dvec2 cell(disc.eye_cell_and_size.x, disc.eye_cell_and_size.y);
    const glm::dvec2 last(disc.eye_cell_and_size.z - 1, disc.eye_cell_and_size.w - 1);
    return glm::length(glm::max(cell + 1.0, last - cell));
}

}  // namespace

Result<DiscSurface> DiscSurface::create(const io::TerrainInfo& info) {
    DiscSurface surface(info);
    RIDGELINE_TRY(surface.create_grid());
    auto programs = GroundPrograms::create("passes/disc.vert");
    if (!programs) return programs.error();
    surface.programs_ = std::move(programs).value();
    return surface;
}

Result<void> DiscSurface::create_grid() {
    const DiscGrid grid = make_disc_grid(shaders::kDiscRadius);
    const auto vertex_bytes = std::as_bytes(std::span(grid.vertices));
    const auto index_bytes = std::as_bytes(std::span(grid.indices));
    auto vertices = gl::Buffer::create({.size_bytes = vertex_bytes.size(), .label = "disc"}, vertex_bytes);
    if (!vertices) return vertices.error();
    auto indices =
        gl::Buffer::create({.size_bytes = index_bytes.size(), .label = "disc indices"}, index_bytes);
    if (!indices) return indices.error();
    vertices_ = std::move(vertices).value();
    indices_ = std::move(indices).value();
    sectors_ = grid.sectors;
    const std::array<gl::VertexAttribute, 1> attributes = {
        {{0, kVertexBinding, 2, GL_SHORT, gl::AttributeKind::integer, 0}}};
    array_ = gl::VertexArray::create(attributes, "disc");
    array_.set_vertex_buffer(kVertexBinding, vertices_, 0, sizeof(DiscVertex));
    array_.set_index_buffer(indices_);
    return {};
}

void DiscSurface::draw_ring(const DiscScene& scene, const gl::Program& program, int ring, RingHole hole) {
    const glm::ivec2 centre = ring_centre(scene.eye.cell, ring);
    program.set(kRingLocation, glm::ivec3(centre, ring));
    const double spacing = static_cast<double>(std::int64_t{1} << ring);
    for (const RingSector& sector : sectors_[static_cast<std::size_t>(hole)]) {
        const glm::dvec2 north_west = glm::dvec2(centre + sector.least) * spacing;
        const glm::dvec2 south_east = glm::dvec2(centre + sector.most) * spacing;
        const glm::dvec2 begin = info_.world(north_west.x, south_east.y),
                         end = info_.world(south_east.x, north_west.y);
        const Box box{{begin, scene.terrain_m.min.z}, {end, scene.terrain_m.max.z}};
        const bool over_terrain = end.x >= info_.min_east_m() && begin.x <= info_.max_east_m() &&
                                  end.y >= info_.min_north_m() && begin.y <= info_.max_north_m();
        if (!over_terrain || contains(scene.visible, box) == Containment::outside) continue;
        const auto offset = static_cast<std::uintptr_t>(sector.first) * sizeof(std::uint32_t);
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(sector.count), GL_UNSIGNED_INT,
                       reinterpret_cast<const void*>(offset));
        counters_.triangles += sector.count / 3;
        ++counters_.draws;
    }
}

// From the eye outwards, so that what is near hides what is far before that is shaded.
void DiscSurface::draw(const DiscScene& scene, Lighting lighting, Cover cover) {
    const gl::DebugGroup group("disc");
    const gl::Program& drawn_with = programs_.program(lighting, cover);
    RIDGELINE_CHECK(!drawn_with.empty());
    counters_ = {};
    drawn_with.use();
    array_.bind();
    if (programs_.culls_fragments()) glDisable(GL_CULL_FACE);
    const RingRange rings = ring_range(static_cast<double>(scene.disc.middle.z), farthest_corner(scene.disc));
    for (int ring = rings.innermost; ring <= rings.outermost; ++ring)
        draw_ring(scene, drawn_with, ring, ring_hole(scene.eye.cell, ring, rings.innermost));
    glEnable(GL_CULL_FACE);
}

}  // namespace ridgeline::render
