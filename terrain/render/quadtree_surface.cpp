#include "ridgeline/render/quadtree_surface.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "ridgeline/base/contract.h"
#include "ridgeline/gl/debug_output.h"
#include "ridgeline/io/detail_info.h"
#include "ridgeline/render/quadtree_patch.h"
#include "ridgeline/shaders/lib/quadtree.h"
#include "ridgeline/shaders/shared/disc_uniforms.h"

namespace ridgeline::render {
namespace {

// Where the passes have them.
constexpr GLint kSlotQuadsLevelLocation = 0;
constexpr GLint kUnfilteredAndShiftLocation = 1;
constexpr GLint kPassLocation = 0;
constexpr GLint kQuadsLocation = 2;
constexpr GLbitfield kWritten = GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT;

static_assert(sizeof(shaders::QuadtreeCommands::groups) ==
              3 * sizeof(std::uint32_t) * (shaders::kMostBalancePasses + 1));

// Cells of the finest octave beside chunks.
static_assert((io::DetailInfo::kMostOctaves + 1) * shaders::kLodSteps < 1 << shaders::kBorderBits);

// The draw, and what it leaves out.
constexpr std::size_t kCounted_bytes = offsetof(shaders::QuadtreeCommands, groups);

int cell_quads(const io::Grid& grid) { return grid.quads() / shaders::kQuadtreeSide; }

template <class T>
void copy_bytes(std::span<const T> values, const gl::StagingRing::Allocation& room) {
    std::memcpy(room.bytes.data(), values.data(), values.size_bytes());
}

}  // namespace

shaders::QuadtreeUniforms quadtree_uniforms(const io::Grid& grid, const QuadtreeBlocks& blocks,
                                            const QuadtreeScene& scene) {
    const select::EyeFrame& eye = scene.eye;
    shaders::QuadtreeUniforms view{};
    view.eye_cell = {eye.cell, eye.quanta, std::countr_zero(static_cast<unsigned>(cell_quads(grid)))};
    view.blocks = {blocks.place_bits(), grid.finest(), scene.made_octaves,
                   scene.region ? scene.made_octaves : shaders::kQuadtreeAnyLevel};
    view.eye_rest = {eye.cell_rest, eye.quanta_rest, eye.quantum_m / 16.0f};
    view.scale = {eye.spacing_m, static_cast<float>(scene.rule.by_error),
                  static_cast<float>(scene.rule.by_spacing)};
    view.reach = {static_cast<float>(scene.terrain_m.min.z - scene.eye_m.z),
                  static_cast<float>(scene.terrain_m.max.z - scene.eye_m.z),
                  static_cast<float>(scene.made_unit_m), 0.0f};
    for (auto& plane : view.planes) plane = {0.0f, 0.0f, 0.0f, 1.0f};
    for (std::size_t i = 0; i < scene.visible.planes.size(); ++i) {
        const Frustum::Plane& plane = scene.visible.planes[i];
        view.planes[i] = glm::vec4(plane.normal, plane.offset + glm::dot(plane.normal, scene.eye_m));
    }
    return view;
}

Result<QuadtreeSurface> QuadtreeSurface::create(const io::TerrainInfo& info, int layers,
                                                const QuadtreeOptions& options) {
    QuadtreeSurface surface(info, layers, options);
    RIDGELINE_TRY(surface.create_buffers());
    RIDGELINE_TRY(surface.create_passes());
    return surface;
}

QuadtreeSurface::QuadtreeSurface(const io::TerrainInfo& info, int layers, const QuadtreeOptions& options)
    : grid_(info.grid()),
      layers_(layers),
      quads_(cell_quads(grid_)),
      options_(options),
      blocks_(grid_, static_cast<std::size_t>(layers)),
      turns_(grid_, layers),
      held_(static_cast<std::size_t>(layers), -1),
      contents_(static_cast<std::size_t>(layers)),
      shapes_by_slot_(static_cast<std::size_t>(layers)),
      shape_known_(static_cast<std::size_t>(layers)) {
    shapeless_.reserve(2 * static_cast<std::size_t>(layers));
}

Result<void> QuadtreeSurface::create_buffers() {
    const std::size_t entries = blocks_.capacity() * shaders::kQuadtreeEntries;
    const auto indices = quadtree_patch(quads_);
    index_count_ = static_cast<std::uint32_t>(indices.size());
    struct Wanted {
        gl::Buffer& buffer;
        gl::BufferOptions options;
    };
    const Wanted wanted[] = {
        {shapes_,
         {static_cast<std::uint64_t>(layers_) * sizeof(shaders::QuadtreeShape), gl::BufferUse::gpu,
          "cells' shapes"}},
        {cells_,
         {entries * sizeof(shaders::QuadtreeCell),
          options_.lod == LodBy::cpu ? gl::BufferUse::update : gl::BufferUse::gpu, "level matrix"}},
        {instances_,
         {std::min<std::size_t>(entries, options_.most_cells) * sizeof(shaders::QuadtreeInstance),
          gl::BufferUse::update, "drawn cells"}},
        {commands_, {sizeof(shaders::QuadtreeCommands), gl::BufferUse::update, "quadtree commands"}},
    };
    for (const Wanted& one : wanted) {
        auto buffer = gl::Buffer::create(one.options);
        if (!buffer) return buffer.error();
        one.buffer = std::move(buffer).value();
    }
    auto index_buffer =
        gl::Buffer::create({indices.size() * sizeof(std::uint16_t), gl::BufferUse::gpu, "cell"},
                           std::as_bytes(std::span(indices)));
    if (!index_buffer) return index_buffer.error();
    indices_ = std::move(index_buffer).value();
    array_ = gl::VertexArray::create({}, "cell");
    array_.set_index_buffer(indices_);
    auto counts = gl::ReadbackRing::create({.slot_bytes = kCounted_bytes, .label = "drawn cells' number"});
    if (!counts) return counts.error();
    counts_ = std::move(counts).value();
    return {};
}

Result<void> QuadtreeSurface::create_passes() {
    auto programs = GroundPrograms::create("passes/quadtree.vert");
    if (!programs) return programs.error();
    programs_ = std::move(programs).value();
    const std::pair<gl::Program&, const char*> passes[] = {{shapes_pass_, "passes/quadtree_shapes.comp"},
                                                           {levels_, "passes/quadtree_levels.comp"},
                                                           {balance_, "passes/quadtree_balance.comp"},
                                                           {turn_, "passes/quadtree_turn.comp"},
                                                           {emit_, "passes/quadtree_emit.comp"}};
    for (const auto& [program, path] : passes) {
        auto built = gl::Program::create({{path}, {}});
        if (!built) return built.error();
        program = std::move(built).value();
    }
    return {};
}

void QuadtreeSurface::hold(std::uint32_t slot, std::int64_t tile, const shaders::ShapeTile& content) {
    held_[slot] = tile;
    contents_[slot] = content;
    shape_known_[slot] = 0;
    if (options_.lod == LodBy::gpu) shapeless_.push_back(slot);
}

// Not before the heights are bound.
void QuadtreeSurface::find_shapes() {
    shapes_pass_.use();
    for (const std::uint32_t slot : shapeless_) {
        const shaders::ShapeTile& tile = contents_[slot];
        shapes_pass_.set(kSlotQuadsLevelLocation, glm::ivec3(static_cast<int>(slot), tile.quads, tile.level));
        shapes_pass_.set(kUnfilteredAndShiftLocation, glm::ivec2(tile.unfiltered, tile.made_shift));
        glDispatchCompute(1, 1, 1);
    }
    shapeless_.clear();
}

const shaders::QuadtreeShape& QuadtreeSurface::shape(std::uint32_t slot, const HeightTexture& heights,
                                                     const pager::Pager& pager) {
    if (!shape_known_[slot]) {
        shapes_by_slot_[slot] = quadtree_shape(heights.texels(slot, pager), contents_[slot]);
        shape_known_[slot] = 1;
    }
    return shapes_by_slot_[slot];
}

void QuadtreeSurface::look_from(const QuadtreeScene& scene) {
    blocks_.build(scene.tiles);
    blocks_.fade(turns_.turn(scene.tiles, scene.fades, scene.moment,
                             {scene.eye, scene.eye_m, scene.visible, scene.terrain_m}));
    if (scene.region)
        blocks_.show_only(*scene.region);
    else
        blocks_.show_all();
    uniforms_ = quadtree_uniforms(grid_, blocks_, scene);
}

bool QuadtreeSurface::prepare(const QuadtreeScene& scene, gl::StagingRing& ring) {
    look_from(scene);
    const auto uniforms = ring.allocate(sizeof uniforms_);
    const auto blocks = ring.allocate(blocks_.blocks().size_bytes());
    const auto places = ring.allocate(blocks_.places().size_bytes());
    const auto commands = ring.allocate(sizeof(shaders::QuadtreeCommands));
    if (!uniforms || !blocks || !places || !commands) return false;
    if (!prepare_seams(scene, ring)) return false;
    shaders::QuadtreeCommands start{};
    start.index_count = index_count_;
    for (int pass = 0; pass <= shaders::kMostBalancePasses; ++pass) {
        start.groups[3 * pass] = pass == 0 ? static_cast<std::uint32_t>(blocks_.blocks().size()) : 0;
        start.groups[3 * pass + 1] = start.groups[3 * pass + 2] = 1;
    }
    copy_bytes(std::span<const shaders::QuadtreeUniforms>(&uniforms_, 1), *uniforms);
    copy_bytes(blocks_.blocks(), *blocks);
    copy_bytes(blocks_.places(), *places);
    copy_bytes(std::span<const shaders::QuadtreeCommands>(&start, 1), *commands);
    gl::copy(ring.buffer(), commands->offset_bytes, commands_, 0, sizeof start);
    ring.buffer().bind_range(GL_UNIFORM_BUFFER, shaders::kQuadtreeUniformsBinding, uniforms->offset_bytes,
                             sizeof uniforms_);
    ring.buffer().bind_range(GL_SHADER_STORAGE_BUFFER, shaders::kQuadtreeBlocksBinding, blocks->offset_bytes,
                             blocks_.blocks().size_bytes());
    ring.buffer().bind_range(GL_SHADER_STORAGE_BUFFER, shaders::kQuadtreePlacesBinding, places->offset_bytes,
                             blocks_.places().size_bytes());
    return true;
}

bool QuadtreeSurface::prepare_seams(const QuadtreeScene& scene, gl::StagingRing& ring) {
    seam_bytes_ = 0;
    if (!scene.region) return true;
    const auto seams = blocks_.seams(*scene.region);
    const auto room = ring.allocate(seams.size_bytes());
    if (!room) return false;
    copy_bytes(seams, *room);
    seams_at_ = room->offset_bytes;
    seam_bytes_ = seams.size_bytes();
    return true;
}

void QuadtreeSurface::bind_buffers() const {
    shapes_.bind_base(GL_SHADER_STORAGE_BUFFER, shaders::kQuadtreeShapesBinding);
    cells_.bind_base(GL_SHADER_STORAGE_BUFFER, shaders::kQuadtreeCellsBinding);
    instances_.bind_base(GL_SHADER_STORAGE_BUFFER, shaders::kQuadtreeInstancesBinding);
    commands_.bind_base(GL_SHADER_STORAGE_BUFFER, shaders::kQuadtreeCommandsBinding);
}

// As many passes as could be needed; after the one that changes nothing the others have no work groups.
void QuadtreeSurface::balance() const {
    balance_.use();
    commands_.bind(GL_DISPATCH_INDIRECT_BUFFER);
    for (int pass = 0; pass < most_balance_passes(uniforms_.blocks.y); ++pass) {
        balance_.set(kPassLocation, pass);
        const std::size_t groups =
            offsetof(shaders::QuadtreeCommands, groups) + 12 * static_cast<std::size_t>(pass);
        glDispatchComputeIndirect(static_cast<GLintptr>(groups));
        glMemoryBarrier(kWritten);
    }
}

void QuadtreeSurface::divide_here(const HeightTexture& heights, const pager::Pager& pager) {
    for (const shaders::QuadtreeBlock& block : blocks_.blocks())
        shape(shaders::block_slot(block), heights, pager);
    lod_.run(uniforms_, blocks_, shapes_by_slot_);
    const auto count =
        std::min(lod_.instances().size(), instances_.size_bytes() / sizeof(shaders::QuadtreeInstance));
    const auto number = static_cast<std::uint32_t>(count);
    const auto left_out = static_cast<std::uint32_t>(lod_.instances().size() - count);
    instances_.write(0, std::as_bytes(lod_.instances().first(count)));
    commands_.write(offsetof(shaders::QuadtreeCommands, cells), gl::bytes_of(number));
    commands_.write(offsetof(shaders::QuadtreeCommands, left_out), gl::bytes_of(left_out));
}

template <class Work>
void QuadtreeSurface::run_pass(QuadtreePass pass, Work work) {
    if (pass_clock_) return pass_clock_->time(pass, work);
    work();
}

void QuadtreeSurface::divide(const HeightTexture& heights, const pager::Pager& pager) {
    const gl::DebugGroup group("quadtree");
    if (options_.lod == LodBy::cpu) return divide_here(heights, pager);
    const auto for_every_block = [&](const gl::Program& pass) {
        pass.use();
        glDispatchCompute(static_cast<GLuint>(blocks_.blocks().size()), 1, 1);
        glMemoryBarrier(kWritten);
    };
    bind_buffers();
    run_pass(QuadtreePass::shapes, [&] {
        find_shapes();
        glMemoryBarrier(kWritten);
    });
    run_pass(QuadtreePass::levels, [&] { for_every_block(levels_); });
    run_pass(QuadtreePass::balance, [&] { balance(); });
    run_pass(QuadtreePass::turn, [&] { for_every_block(turn_); });
    run_pass(QuadtreePass::emit, [&] { for_every_block(emit_); });
}

Result<void> QuadtreeSurface::allow_level_matrix() {
    if (levels_reader_) return {};
    auto reader = LevelMatrixReader::create();
    if (!reader) return reader.error();
    levels_reader_.emplace(std::move(reader).value());
    return {};
}

void QuadtreeSurface::request_level_matrix() {
    RIDGELINE_CHECK(levels_reader_);
    if (options_.lod == LodBy::cpu) put_cells();
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    levels_reader_->request(uniforms_, blocks_, cells_);
}

// The CPU's levels take the way of the GPU's, so that there is one.
void QuadtreeSurface::put_cells() {
    cells_here_.clear();
    for (std::size_t i = 0; i < lod_.levels().size(); ++i)
        cells_here_.push_back({lod_.levels()[i], lod_.lods()[i]});
    cells_.write(0, std::as_bytes(std::span(cells_here_)));
}

void QuadtreeSurface::draw(Lighting lighting, Cover cover, const gl::StagingRing& ring) {
    const gl::DebugGroup group("quadtree");
    const gl::Program& program = programs_.program(lighting, cover);
    RIDGELINE_CHECK(!program.empty());
    program.use();
    program.set(kQuadsLocation, quads_);
    array_.bind();
    instances_.bind_base(GL_SHADER_STORAGE_BUFFER, shaders::kQuadtreeInstancesBinding);
    if (seam_bytes_ > 0)
        ring.buffer().bind_range(GL_SHADER_STORAGE_BUFFER, shaders::kQuadtreeSeamsBinding, seams_at_,
                                 seam_bytes_);
    commands_.bind(GL_DRAW_INDIRECT_BUFFER);
    if (programs_.culls_fragments()) glDisable(GL_CULL_FACE);
    glDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_SHORT, nullptr);
    glEnable(GL_CULL_FACE);
    count_cells();
}

void QuadtreeSurface::count_cells() {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    counts_.request(commands_, 0, kCounted_bytes, ++frame_);
    while (const auto arrived = counts_.take()) {
        shaders::QuadtreeCommands drawn{};
        std::memcpy(&drawn, arrived->bytes.data(), kCounted_bytes);
        counters_ = {.triangles = std::uint64_t{drawn.cells} * index_count_ / 3,
                     .draws = 1,
                     .left_out = drawn.left_out};
    }
}

std::vector<shaders::QuadtreeCell> QuadtreeSurface::read_cells() const {
    std::vector<shaders::QuadtreeCell> cells(blocks_.blocks().size() * shaders::kQuadtreeEntries);
    glGetNamedBufferSubData(cells_.id(), 0, static_cast<GLsizeiptr>(cells.size() * sizeof cells[0]),
                            cells.data());
    return cells;
}

shaders::QuadtreeCommands QuadtreeSurface::read_commands() const {
    shaders::QuadtreeCommands commands;
    glGetNamedBufferSubData(commands_.id(), 0, sizeof commands, &commands);
    return commands;
}

std::vector<shaders::QuadtreeShape> QuadtreeSurface::read_shapes() const {
    std::vector<shaders::QuadtreeShape> shapes(static_cast<std::size_t>(layers_));
    glGetNamedBufferSubData(shapes_.id(), 0, static_cast<GLsizeiptr>(shapes.size() * sizeof shapes[0]),
                            shapes.data());
    return shapes;
}

}  // namespace ridgeline::render
