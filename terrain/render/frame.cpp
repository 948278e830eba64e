#include "ridgeline/render/frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "ridgeline/gl/capabilities.h"
#include "ridgeline/gl/debug_output.h"

namespace ridgeline::render {
namespace {

// The imagery's part of --gpu-cache, and the chunks' where the disc may not be drawn.
constexpr std::uint64_t kCacheParts = 2;
// Else the chunks' and the heights'.
constexpr std::uint64_t kSharedCacheParts = 4;
// A frame's instances, morphs and commands, for every chunk that the GPU can hold (a chunk takes some 300
// bytes, with all its fans 600) and for the frames that the GPU may lag behind; a usual frame takes a
// fiftieth.
constexpr std::uint64_t kLeastFrameRingBytes = 16_MiB;
constexpr std::uint64_t kFrameBytesPerChunk = 1800;
// Frames whose uploads the staging ring holds at once.
constexpr std::uint64_t kUploadFrames = 4;
// The largest chunk there can be, twice: 65534 vertices, and as many triangles again as a dense mesh has.
constexpr std::uint64_t kLeastStagingBytes = 4_MiB;
// As swap chains have it: one frame on the GPU and one waiting. Without a window nothing else holds the CPU
// back.
constexpr std::size_t kFramesInFlight = 2;
constexpr GLint kFullscreenDepthLocation = 0;

pager::TileSource tiles_of(const io::Store& store, const FrameOptions& options) {
    return pager::tile_source(
        store, options.surfaces == Surfaces::all ? pager::HeightsTiles::paged : pager::HeightsTiles::none);
}

Result<GpuSlots> create_slots(const io::Store& store, const FrameOptions& options) {
    const gl::Capabilities gpu = gl::query_capabilities();
    const pager::TileSource source = tiles_of(store, options);
    const bool both = options.surfaces == Surfaces::all;
    const std::uint64_t parts = both ? kSharedCacheParts : kCacheParts;
    const std::uint64_t imagery =
        store.info().imagery ? least_bytes(imagery_demand(source)) * kCacheParts : 0;
    const std::uint64_t heights =
        both ? least_bytes(heights_demand(source, options.detail_octaves)) * kSharedCacheParts : 0;
    const auto shape =
        plan_gpu_slots(source, {.capacity_bytes = options.gpu_cache_bytes / parts,
                                .parts = parts,
                                .least_other_part_bytes = (std::max(imagery, heights) + parts - 1) / parts,
                                .max_layers = gpu.max_texture_layers,
                                .max_texture_size_px = gpu.max_texture_size_px});
    if (!shape) return shape.error();
    return GpuSlots::create(*shape);
}

}  // namespace

Result<Frame> Frame::create(const io::Store& store, const FrameOptions& options) {
    auto slots = create_slots(store, options);
    if (!slots) return slots.error();
    auto surface = MeshSurface::create(store.info(), store.records(), *slots);
    if (!surface) return surface.error();
    auto staging = gl::StagingRing::create(
        std::max(kUploadFrames * options.upload_budget_bytes, 2 * kLeastStagingBytes));
    if (!staging) return staging.error();
    const auto chunks = static_cast<std::uint64_t>(slots->shape().square_count());
    auto ring =
        gl::StagingRing::create(std::max(kLeastFrameRingBytes, kFrameBytesPerChunk * chunks), "frame ring");
    if (!ring) return ring.error();
    Frame frame(store, options, std::move(slots).value(), std::move(surface).value(),
                std::move(staging).value(), std::move(ring).value());
    RIDGELINE_TRY(frame.load_passes());
    RIDGELINE_TRY(frame.load_sampled());
    RIDGELINE_TRY(frame.load_imagery());
    RIDGELINE_TRY(frame.resize(options.size_px));
    return frame;
}

Frame::Frame(const io::Store& store, const FrameOptions& options, GpuSlots slots, MeshSurface surface,
             gl::StagingRing staging, gl::StagingRing ring)
    : store_(&store),
      info_(store.info()),
      grid_(info_.grid()),
      finer_(detail::finer_ground(info_, options.detail_octaves, options.detail_roughness)),
      sampled_info_(detail::finer_lattice(info_, options.detail_octaves)),
      options_(options),
      slots_(std::move(slots)),
      surface_(std::move(surface)),
      region_(grid_, store.records()),
      staging_(std::move(staging)),
      ring_(std::move(ring)),
      timer_(gl::TimerQuery::create()) {}

Result<void> Frame::load_passes() {
    auto sky = gl::Program::create({{"passes/fullscreen.vert", "passes/sky.frag"}, {}});
    if (!sky) return sky.error();
    sky_ = std::move(sky).value();
    sky_.set(kFullscreenDepthLocation, 0.0f);
    no_vertices_ = gl::VertexArray::create({}, "no vertices");
    auto noise = create_ground_noise();
    if (!noise) return noise.error();
    noise_ = std::move(noise).value();
    noise_sampler_ = gl::Sampler::create({.min_filter = GL_LINEAR_MIPMAP_LINEAR, .wrap = GL_REPEAT});
    gl::set_frame_conventions();
    return {};
}

Result<void> Frame::load_imagery() {
    if (!info_.imagery) return {};
    const gl::Capabilities gpu = gl::query_capabilities();
    ImageryTextureOptions imagery;
    imagery.slots = {.capacity_bytes = options_.gpu_cache_bytes / kCacheParts,
                     .parts = kCacheParts,
                     .max_layers = gpu.max_texture_layers};
    imagery.print_filter = gpu.software ? PrintFilter::shader : PrintFilter::sampler;
    auto texture = ImageryTexture::create(*info_.imagery, tiles_of(*store_, options_), imagery);
    if (!texture) return texture.error();
    imagery_.emplace(std::move(texture).value());
    const bool all = covers(*info_.imagery, store_->imagery_records(), info_);
    const Coverage coverage = all ? Coverage::wholly : Coverage::partly;
    if (disc_) RIDGELINE_TRY(disc_->programs().allow_imagery(coverage));
    if (quadtree_) RIDGELINE_TRY(quadtree_->programs().allow_imagery(coverage));
    return surface_.allow_imagery(slots_, coverage);
}

Result<void> Frame::load_sampled() {
    if (options_.surfaces != Surfaces::all) return {};
    auto heights = HeightTexture::create(tiles_of(*store_, options_), finer_,
                                         {.capacity_bytes = options_.gpu_cache_bytes / kSharedCacheParts,
                                          .parts = kSharedCacheParts,
                                          .max_layers = gl::query_capabilities().max_texture_layers});
    if (!heights) return heights.error();
    heights_.emplace(std::move(heights).value());
    auto disc = DiscSurface::create(sampled_info_);
    if (!disc) return disc.error();
    disc_.emplace(std::move(disc).value());
    auto quadtree =
        QuadtreeSurface::create(sampled_info_, heights_->tiles().shape().layers(), options_.quadtree);
    if (!quadtree) return quadtree.error();
    quadtree_.emplace(std::move(quadtree).value());
    slotted_.reserve(static_cast<std::size_t>(heights_->tiles().shape().layers()));
    return {};
}

Result<void> Frame::allow_shadows() {
    if (shadow_maps_) return {};
    RIDGELINE_TRY(surface_.allow_shadows(slots_));
    if (disc_) RIDGELINE_TRY(disc_->programs().allow_shadows());
    if (quadtree_) RIDGELINE_TRY(quadtree_->programs().allow_shadows());
    auto maps = ShadowMaps::create(info_, store_->records(), slots_, options_.shadow_map_px);
    if (!maps) return maps.error();
    shadow_maps_ = std::move(maps).value();
    return {};
}

Result<void> Frame::allow_readback(const select::GroundLattice& lattice) {
    if (ground_reader_) return {};
    auto reader = GroundReader::create(lattice);
    if (!reader) return reader.error();
    ground_reader_ = std::move(reader).value();
    return {};
}

Result<void> Frame::resize(const glm::ivec2& size_px) {
    auto target = gl::RenderTarget::create({.size_px = size_px});
    if (!target) return target.error();
    target_ = std::move(target).value();
    return {};
}

void Frame::begin_frame(std::uint32_t frame) {
    frame_ = frame;
    fences_.poll();
    slots_.begin_frame(fences_.completed());
    for (const pager::TileKind kind : pager::kEveryTileKind)
        if (VirtualTexture* texture = texture_of(kind)) texture->begin_frame(frame, fences_.completed());
    staging_.begin_frame();
    ring_.begin_frame();
}

// Evicts until the chunk has room now or, once the GPU has caught up, in a later frame; false where it has
// none now.
bool Frame::make_room(pager::Pager& pager, const pager::Upload& upload) {
    if (slots_.room_is_coming(upload.chunk)) return false;
    const auto victim = pager.gpu_victim(upload.node);
    if (!victim) return false;
    slots_.release(victim->slot);
    return true;
}

bool Frame::make_room(VirtualTexture& texture, pager::Pager& pager, const pager::Upload& upload) {
    if (texture.room_is_coming()) return false;
    MadeTiles* made = upload.kind == pager::TileKind::heights ? heights_->made() : nullptr;
    if (made && made->make_room(texture, MadeTiles::kOnlyUnwanted)) return true;
    const auto victim = pager.gpu_victim(upload.node);
    if (!victim) return made && made->make_room(texture, MadeTiles::kEvenWanted);
    if (made) made->forget_below(pager.tiles().id(victim->node), texture);
    texture.release(victim->slot);
    return true;
}

// A tile whose parent found no room waits: a chunk's normals and morphs rest on the parent's, and imagery
// that is wanted coarse is looked up in the parent.
bool Frame::parent_is_resident(const pager::Pager& pager, pager::NodeIndex node) const {
    const io::NodeId id = pager.tiles().id(node);
    if (id.level == 0) return true;
    return pager.state(pager.tiles().index(pager.tiles().kind(node), id.parent())) ==
           pager::TileState::resident;
}

Frame::Stored Frame::store_chunk(pager::Pager& pager, const pager::Upload& upload) {
    auto outcome = slots_.store(upload.chunk, staging_);
    while (outcome.stored == GpuSlots::Stored::no_room && make_room(pager, upload))
        outcome = slots_.store(upload.chunk, staging_);
    if (outcome.stored == GpuSlots::Stored::staging_full) return Stored::staging_full;
    if (outcome.stored == GpuSlots::Stored::no_room) return Stored::no_room;
    pager.mark_resident(upload.node, outcome.slot);
    return Stored::yes;
}

Frame::Stored Frame::store_tile(VirtualTexture& texture, pager::Pager& pager, const pager::Upload& upload) {
    auto outcome = texture.store(upload, staging_);
    while (outcome.stored == VirtualTexture::Stored::no_room && make_room(texture, pager, upload))
        outcome = texture.store(upload, staging_);
    if (outcome.stored == VirtualTexture::Stored::staging_full) return Stored::staging_full;
    if (outcome.stored == VirtualTexture::Stored::no_room) return Stored::no_room;
    pager.mark_resident(upload.node, outcome.slot);
    return Stored::yes;
}

Frame::Stored Frame::store(pager::Pager& pager, const pager::Upload& upload) {
    VirtualTexture* texture = texture_of(upload.kind);
    return texture ? store_tile(*texture, pager, upload) : store_chunk(pager, upload);
}

VirtualTexture* Frame::texture_of(pager::TileKind kind) {
    if (kind == pager::TileKind::imagery && imagery_) return &imagery_->tiles();
    if (kind == pager::TileKind::heights && heights_) return &heights_->tiles();
    return nullptr;
}

void Frame::release_left(pager::Pager& pager) {
    for (const pager::TileKind kind : pager::kEveryTileKind) {
        VirtualTexture* texture = texture_of(kind);
        for (const pager::GpuSlot slot : pager.take_released_gpu_slots(kind)) {
            if (kind == pager::TileKind::heights) forget_made_of(slot, pager);
            texture ? texture->release(slot) : slots_.release(slot);
        }
    }
}

void Frame::forget_made_of(pager::GpuSlot slot, const pager::Pager& pager) {
    if (!heights_ || !heights_->made()) return;
    const pager::NodeIndex tile = heights_->tiles().tile(static_cast<std::uint32_t>(slot));
    heights_->made()->forget_below(pager.tiles().id(tile), heights_->tiles());
}

void Frame::make_detail(std::span<const select::ScheduledTile> wanted, const MadeMoment& moment,
                        pager::Pager& pager) {
    RIDGELINE_CHECK(heights_ && heights_->made());
    const gl::DebugGroup group("detail");
    heights_->made()->make(wanted, moment, heights_->tiles(), pager);
}

// The first tile without room ends its kind's uploads: a smaller one behind it would take the room that was
// made for it, only to be evicted for it in the next frame, and so for ever.
UploadCounters Frame::upload(pager::Pager& pager, std::uint64_t budget_bytes) {
    release_left(pager);
    // The page table went with the last frame's drawing.
    const std::uint64_t table_bytes = imagery_ ? imagery_->tiles().take_table_bytes() : 0;
    const std::uint64_t heights_table_bytes = heights_ ? heights_->tiles().take_table_bytes() : 0;
    UploadCounters counters{.bytes = table_bytes + heights_table_bytes,
                            .imagery_bytes = table_bytes,
                            .heights_bytes = heights_table_bytes};
    std::array<bool, pager::kTileKinds> full{};
    for (const pager::Upload& upload : pager.ready_to_upload(budget_bytes)) {
        bool& no_room = full[pager::index(upload.kind)];
        if (no_room || !parent_is_resident(pager, upload.node)) continue;
        if (counters.tiles > 0 && counters.bytes + upload.bytes > budget_bytes) break;
        const Stored stored = store(pager, upload);
        if (stored == Stored::staging_full) break;
        no_room = stored == Stored::no_room;
        if (no_room) continue;
        counters.bytes += upload.bytes;
        if (upload.kind == pager::TileKind::imagery) counters.imagery_bytes += upload.bytes;
        if (upload.kind == pager::TileKind::heights) counters.heights_bytes += upload.bytes;
        ++counters.tiles;
    }
    return counters;
}

UploadCounters Frame::upload_all(pager::Pager& pager) {
    UploadCounters sum;
    while (true) {
        const UploadCounters counters = upload(pager, staging_.size_bytes() / 2);
        sum.bytes += counters.bytes;
        sum.imagery_bytes += counters.imagery_bytes;
        sum.heights_bytes += counters.heights_bytes;
        if (counters.tiles == 0) return sum;
        sum.tiles += counters.tiles;
        staging_.end_frame();
        glFinish();
        staging_.begin_frame();
    }
}

// Runs what needs room in the frame's ring; where there is none, the GPU is many frames behind, and only
// waiting can help.
template <class Prepare>
void Frame::with_room(Prepare prepare) {
    if (prepare()) return;
    glFinish();
    ring_.begin_frame();
    RIDGELINE_CHECK(prepare());
}

void Frame::bind_uniforms(const FrameView& view, const io::TerrainInfo& info) {
    const shaders::FrameUniforms uniforms = frame_uniforms(view, info);
    std::optional<gl::StagingRing::Allocation> room;
    with_room([&] {
        room = ring_.allocate(sizeof uniforms);
        return room.has_value();
    });
    std::memcpy(room->bytes.data(), &uniforms, sizeof uniforms);
    ring_.buffer().bind_range(GL_UNIFORM_BUFFER, shaders::kFrameUniformsBinding, room->offset_bytes,
                              sizeof uniforms);
}

void Frame::bind_sampled_uniforms(const FrameScene& scene) {
    if (finer_.octaves() == 0) return;
    FrameView view = scene.view;
    view.eye = (scene.disc ? scene.disc : scene.made)->eye;
    view.finer_octaves = finer_.octaves();
    bind_uniforms(view, sampled_info_);
}

void Frame::draw_shadow_maps(const FrameScene& scene) {
    shadows_drawn_ = scene.shadows != nullptr && scene.shadows->sun_is_up;
    if (!shadows_drawn_) return;
    RIDGELINE_CHECK(shadow_maps_);
    with_room([&] {
        return shadow_maps_->prepare(*scene.shadows, scene.selection->casters, {scene.pager, &slots_, frame_},
                                     ring_);
    });
    shadow_maps_->draw(slots_, ring_);
}

SurfaceCounters Frame::shadow_counters() const {
    return shadows_drawn_ ? shadow_maps_->counters() : SurfaceCounters{};
}

void Frame::prepare_imagery(const FrameScene& scene) {
    with_room([&] { return imagery_->prepare(scene.view.camera, *scene.pager, ring_); });
    imagery_->bind(ring_);
}

void Frame::draw_terrain(const FrameScene& scene) {
    const gl::DebugGroup group("terrain");
    const Cover cover = imagery_ ? scene.cover : Cover::tint;
    if (shadows_drawn_) shadow_maps_->bind(ring_);
    if (cover == Cover::imagery) prepare_imagery(scene);
    noise_.bind(shaders::kNoiseUnit);
    noise_sampler_.bind(shaders::kNoiseUnit);
    glPolygonMode(GL_FRONT_AND_BACK, scene.fill == Fill::wireframe ? GL_LINE : GL_FILL);
    if (scene.disc && scene.disc->rule)
        draw_quadtree(scene, cover);
    else if (scene.disc)
        draw_disc(scene, cover);
    else
        draw_mesh(scene, cover);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

void Frame::draw_mesh(const FrameScene& scene, Cover cover) {
    const Lighting lighting = shadows_drawn_ ? Lighting::shadowed : Lighting::unshadowed;
    ChunkPlaces places{scene.pager, &slots_, frame_};
    if (scene.made) {
        prepare_made(scene);
        places.finer_octaves = finer_.octaves();
        places.source_eye = scene.selection->eye.cell;
        places.finer_eye = scene.made->eye.cell;
    }
    with_room(
        [&] { return surface_.prepare(*scene.selection, scene.made ? &region_ : nullptr, places, ring_); });
    counters_ = surface_.counters();
    const bool has_cells = scene.made && !region_.nodes().empty();
    // The nearer first: it hides ground that then need not be shaded.
    if (has_cells) quadtree_->draw(lighting, cover, ring_);
    slots_.normals().bind(shaders::kNormalsUnit);
    surface_.draw(slots_, ring_, lighting, cover);
    if (!has_cells) return;
    counters_.triangles += quadtree_->counters().triangles;
    counters_.draws += quadtree_->counters().draws;
    counters_.left_out = quadtree_->counters().left_out;
}

// Before the chunks, which leave out what cells draw.
void Frame::prepare_made(const FrameScene& scene) {
    prepare_heights(*scene.made, *scene.pager);
    region_.find(scene.selection->draws, scene.made->near, *heights_, *scene.pager);
    const QuadtreeScene divided =
        quadtree_scene(scene.view.camera.pose.eye_m, *scene.made, &region_, *scene.pager);
    // What comes next turns from what chunks show now.
    if (region_.nodes().empty()) return quadtree_->look_from(divided);
    with_room([&] { return quadtree_->prepare(divided, ring_); });
    quadtree_->divide(*heights_, *scene.pager);
}

DiscLook Frame::look_at_disc(const DiscSight& sight, const pager::Pager& pager) {
    RIDGELINE_CHECK(heights_);
    heights_->look_from({sight.eye, sight.eye_above_ground_m, sight.projection_px}, pager);
    disc_eye_ = sight.eye;
    return disc_look(pager);
}

void Frame::prepare_heights(const DiscSight& sight, const pager::Pager& pager) {
    RIDGELINE_CHECK(heights_);
    const DiscView view{sight.eye, sight.eye_above_ground_m, sight.projection_px};
    disc_eye_ = view.eye;
    with_room([&] { return heights_->prepare(view, pager, ring_); });
    heights_->bind(ring_);
}

void Frame::draw_disc(const FrameScene& scene, Cover cover) {
    RIDGELINE_CHECK(disc_);
    prepare_heights(*scene.disc, *scene.pager);
    const DiscSight& sight = *scene.disc;
    disc_->draw({heights_->uniforms(), sight.eye, sight.visible, sight.terrain_m},
                shadows_drawn_ ? Lighting::shadowed : Lighting::unshadowed, cover);
    counters_ = disc_->counters();
}

// All of level 0, and those of the frame's tiles that are there; of them those with which a region has to do.
void Frame::gather_tiles(std::span<const pager::NodeIndex> wanted, const MadeRegion* region,
                         const pager::Pager& pager) {
    const auto counts = [region](io::NodeId tile) { return !region || region->concerns(tile); };
    const pager::TileSpace& tiles = pager.tiles();
    slotted_.clear();
    for (std::int64_t root = 0; root < grid_.first(1); ++root)
        add_tile(pager, tiles.index(pager::TileKind::heights, grid_.node_at(root)));
    for (const pager::NodeIndex tile : wanted)
        if (tiles.id(tile).level > 0 && counts(tiles.id(tile))) add_tile(pager, tile);
    if (const MadeTiles* made = heights_->made())
        made->for_each_wanted([&](io::NodeId node, std::uint32_t slot) {
            if (counts(node)) add_made_tile(node, slot);
        });
}

// What has come since the last frame gets its shape.
void Frame::add_tile(const pager::Pager& pager, pager::NodeIndex tile) {
    if (pager.state(tile) != pager::TileState::resident) return;
    const auto slot = static_cast<std::uint32_t>(pager.gpu_slot(tile));
    slotted_.push_back({pager.tiles().id(tile), slot});
    if (!quadtree_->holds(slot, tile))
        quadtree_->hold(slot, tile, {grid_.quads(), slotted_.back().node.level, 0, -1});
}

void Frame::add_made_tile(io::NodeId node, std::uint32_t slot) {
    // Beside the pager's numbers.
    const std::int64_t name = std::int64_t{1} << 62 | detail::tile_name(node);
    slotted_.push_back({node, slot});
    if (!quadtree_->holds(slot, name))
        quadtree_->hold(slot, name, {grid_.quads(), node.level, node.level - grid_.finest(), finer_.shift});
}

QuadtreeScene Frame::quadtree_scene(const glm::dvec3& eye_m, const DiscSight& sight, const MadeRegion* region,
                                    const pager::Pager& pager) {
    gather_tiles(sight.tiles, region, pager);
    return {sight.eye,
            eye_m,
            sight.visible,
            sight.terrain_m,
            *sight.rule,
            finer_.octaves(),
            std::ldexp(static_cast<double>(sight.eye.quantum_m), -finer_.shift),
            slotted_,
            heights_->tiles().fades(),
            {frame_, sight.now, sight.fade},
            region};
}

QuadtreeLook Frame::look_at_quadtree(const glm::dvec3& eye_m, const DiscSight& sight,
                                     const pager::Pager& pager) {
    RIDGELINE_CHECK(quadtree_ && heights_);
    heights_->look_from({sight.eye, sight.eye_above_ground_m, sight.projection_px}, pager);
    disc_eye_ = sight.eye;
    quadtree_->look_from(quadtree_scene(eye_m, sight, nullptr, pager));
    return quadtree_look(pager);
}

std::optional<QuadtreeLook> Frame::look_at_made(const glm::dvec3& eye_m, const DiscSight& sight,
                                                std::span<const select::DrawEntry> draws,
                                                const pager::Pager& pager) {
    RIDGELINE_CHECK(quadtree_ && heights_ && heights_->made());
    heights_->look_from({sight.eye, sight.eye_above_ground_m, sight.projection_px}, pager);
    disc_eye_ = sight.eye;
    region_.find(draws, sight.near, *heights_, pager);
    if (!region_.concerns_place(info_.lattice(eye_m.x, eye_m.y))) return {};
    quadtree_->look_from(quadtree_scene(eye_m, sight, &region_, pager));
    return quadtree_look(pager);
}

void Frame::draw_quadtree(const FrameScene& scene, Cover cover) {
    RIDGELINE_CHECK(quadtree_);
    prepare_heights(*scene.disc, *scene.pager);
    const QuadtreeScene divided =
        quadtree_scene(scene.view.camera.pose.eye_m, *scene.disc, nullptr, *scene.pager);
    with_room([&] { return quadtree_->prepare(divided, ring_); });
    quadtree_->divide(*heights_, *scene.pager);
    if (scene.reads_levels) quadtree_->request_level_matrix();
    quadtree_->draw(shadows_drawn_ ? Lighting::shadowed : Lighting::unshadowed, cover, ring_);
    counters_ = quadtree_->counters();
}

void Frame::draw_sky() {
    const gl::DebugGroup group("sky");
    // Where nothing was drawn, depth is still 0: infinitely far.
    glDepthFunc(GL_GEQUAL);
    sky_.use();
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_GREATER);
}

void Frame::draw(const FrameScene& scene) {
    timer_.begin(scene.number);
    bind_uniforms(scene.view, info_);
    draw_shadow_maps(scene);
    // Chunks cast the shadows of every surface, on the source's lattice.
    if (scene.disc || scene.made) bind_sampled_uniforms(scene);
    target_.framebuffer.bind();
    const auto plain = scene.view.background.value_or(PlainBackground{});
    const std::array<float, 4> color = {static_cast<float>(plain.red) / 255.0f,
                                        static_cast<float>(plain.green) / 255.0f,
                                        static_cast<float>(plain.blue) / 255.0f, 1.0f};
    glClearNamedFramebufferfv(target_.framebuffer.id(), GL_COLOR, 0, color.data());
    constexpr float kInfinitelyFar = 0.0f;
    glClearNamedFramebufferfv(target_.framebuffer.id(), GL_DEPTH, 0, &kInfinitelyFar);
    draw_terrain(scene);
    if (scene.sight) ground_reader_->read(target_.depth, {scene.number, &scene.view.camera, *scene.sight});
    if (!scene.view.background) draw_sky();
    timer_.end();
}

void Frame::end_frame() {
    staging_.end_frame();
    ring_.end_frame();
    fences_.end_frame(frame_);
    glFlush();
    fences_.limit(kFramesInFlight);
}

void Frame::finish() {
    glFinish();
    fences_.poll();
}

}  // namespace ridgeline::render
