#include "ridgeline/pager/pager.h"

#include <algorithm>
#include <string>
#include <utility>

#include "ridgeline/base/log.h"
#include "ridgeline/base/thread_role.h"
#include "ridgeline/base/units.h"
#include "ridgeline/io/store.h"
#include "ridgeline/jobs/job_system.h"
#include "ridgeline/pager/pager_state.h"
#include "ridgeline/telemetry/recorder.h"

namespace ridgeline::pager {
namespace {

// Entries beyond the tiles in RAM, for failed ones.
constexpr std::uint32_t kFailedEntries = 4608;

IoThreadOptions io_options(const PagerOptions& options, const jobs::JobSystem& jobs) {
    IoThreadOptions io;
    io.fault = options.fault;
    io.recorder = options.recorder;
    const int decodes = options.max_decodes > 0 ? options.max_decodes : jobs.worker_count() + 1;
    io.max_decodes = static_cast<std::uint32_t>(decodes);
    return io;
}

Result<std::vector<std::uint8_t>> read_checked(io::ByteSource& source, const io::PayloadRef& payload) {
    std::vector<std::uint8_t> bytes(payload.size);
    RIDGELINE_TRY(source.read(payload.offset, bytes));
    if (io::payload_checksum(bytes) != payload.checksum) return Error{"the checksum does not match"};
    return bytes;
}

std::string text_of(io::NodeId tile) {
    return "tile " + std::to_string(tile.level) + "/" + std::to_string(tile.x) + "/" + std::to_string(tile.y);
}

std::uint64_t in_mebibytes(std::uint64_t bytes) { return (bytes + 1_MiB - 1) / 1_MiB; }

}  // namespace

// --- construction

Pager::State::State(const TileSource& tile_source, jobs::JobSystem& jobs, const PagerOptions& pager_options,
                    const TileDecoder* tile_decoder, RamRing&& memory)
    : source(tile_source),
      tiles(source.tiles()),
      options(pager_options),
      chunk_decoder(source.grid, source.spacing, source.relief),
      decoder(tile_decoder ? tile_decoder : &chunk_decoder),
      ring(std::move(memory)),
      residency(tiles, ring.page_count() + kFailedEntries),
      outstanding(static_cast<std::size_t>(pager_options.max_requests)),
      board(static_cast<std::uint32_t>(pager_options.max_requests)),
      io(std::make_unique<IoThread>(source, *decoder, jobs, board, io_options(options, jobs))) {
    // Selection's capacity: a frame's lists grow no further.
    constexpr std::size_t kUsualWants = 8192;
    wanted.reserve(kUsualWants);
    uploads.reserve(kUsualWants);
    for (Released& slots : released) {
        slots.now.reserve(kUsualWants);
        slots.then.reserve(kUsualWants);
    }
}

namespace {

// Calls visit(tile) for every tile of level 0 that there is, of every kind, while it returns true.
template <class Visit>
bool for_each_root(const TileSource& source, const TileSpace& tiles, Visit visit) {
    for (const TileKind kind : kEveryTileKind)
        for (NodeIndex root = 0; root < tiles.root_count(kind); ++root) {
            const NodeIndex tile = tiles.begin(kind) + root;
            if (source.has_data(tile) && !visit(tile)) return false;
        }
    return true;
}

std::uint32_t level0_pages(const TileSource& source) {
    std::uint32_t pages = 0;
    for_each_root(source, source.tiles(), [&](NodeIndex root) {
        pages += RamRing::pages_for(source.decoded_bytes(root));
        return true;
    });
    return pages;
}

Error level0_does_not_fit(const TileSource& source) {
    const auto least =
        std::to_string(in_mebibytes(std::uint64_t{level0_pages(source)} * RamRing::kPageBytes));
    return Error{source.name + ": level 0 needs " + least + " MiB of RAM cache: use --ram-cache " + least +
                 "MiB or more"};
}

}  // namespace

Pager::Pager(std::unique_ptr<State> state) : state_(std::move(state)) {}
Pager::~Pager() = default;
Pager::Pager(Pager&&) noexcept = default;
Pager& Pager::operator=(Pager&&) noexcept = default;

Result<Pager> Pager::create(const TileSource& source, jobs::JobSystem& jobs, const PagerOptions& options,
                            const TileDecoder* decoder) {
    RIDGELINE_CHECK(options.max_requests > 0);
    if (!TileSpace::fits(source.grid, source.imagery.grid, source.heights_grid()))
        return Error{source.name + ": more tiles than one program can walk: build it with larger tiles"};
    if (options.ram_bytes < RamRing::kPageBytes) return level0_does_not_fit(source);
    auto ring = RamRing::create(options.ram_bytes);
    if (!ring) return ring.error();
    return Pager(std::make_unique<State>(source, jobs, options, decoder, std::move(ring).value()));
}

// --- level 0

Result<void> Pager::State::load_level0() {
    pinned_pages = level0_pages(source);
    if (pinned_pages > ring.page_count()) return level0_does_not_fit(source);
    Result<void> all;
    for_each_root(source, tiles, [&](NodeIndex root) {
        if (auto loaded = load_now(root); !loaded)
            all = Error{source.name + ": root " + describe(root) + ": " + loaded.error().message};
        return all.ok();
    });
    return all;
}

std::string Pager::State::describe(NodeIndex node) const {
    constexpr const char* kPrefix[kTileKinds] = {"", "imagery ", "heights "};
    return kPrefix[index(tiles.kind(node))] + text_of(tiles.id(node));
}

Result<void> Pager::State::decode_now(NodeIndex node, std::span<std::byte> block) const {
    const auto [first, second] = source.payloads(node);
    DecodeScratch scratch;
    if (tiles.kind(node) == TileKind::imagery) {
        const auto payload = read_checked(*source.imagery.tiles, first);
        if (!payload) return payload.error();
        return decoder->decode_imagery({tiles.id(node), *payload}, scratch, block);
    }
    if (tiles.kind(node) == TileKind::heights) {
        const auto payload = read_checked(*source.heights, first);
        if (!payload) return payload.error();
        return decoder->decode_heights(
            {tiles.id(node), source.grid.quads(), source.heights_filter(tiles.id(node)), *payload}, scratch,
            block);
    }
    const auto mesh = read_checked(*source.mesh, first);
    if (!mesh) return mesh.error();
    const auto heights = read_checked(*source.heights, second);
    if (!heights) return heights.error();
    return decoder->decode({tiles.id(node), &source.record(node), *mesh, *heights}, scratch, block);
}

Result<void> Pager::State::load_now(NodeIndex node) {
    const RamBlock block = ring.allocate(source.decoded_bytes(node));
    RIDGELINE_CHECK(block);
    if (auto decoded = decode_now(node, ring.bytes(block)); !decoded) {
        ring.free(block);
        return decoded.error();
    }
    residency.become_ready(residency.queue(node, block));
    ++roots_to_upload;
    return {};
}

// --- the frame

void Pager::State::begin_frame(std::uint32_t frame_number, Seconds time) {
    ++frame;
    now = time;
    io->advance(frame_number);
    Completion completion;
    while (io->receive(completion)) take_in(completion);
    residency.advance_fades(now);
    restart_gpu_victims();
}

void Pager::State::take_in(const Completion& completion) {
    Outstanding& finished = outstanding[completion.ticket.slot];
    // What was completed had passed the point where it can be cancelled.
    RIDGELINE_CHECK(board.close(completion.ticket));
    changed();
    TileEntry& entry = *residency.find(std::exchange(finished.node, kNoNode));
    if (completion.outcome == TileState::ready) {
        residency.become_ready(entry);
        ++counts_of(entry).loaded;
        if (options.recorder)
            options.recorder->request_to_ready_ns().record(
                std::chrono::nanoseconds(completion.time - finished.since).count());
        return;
    }
    ++counts_of(entry).failed;
    if (residency.report_once(entry.node))
        log_line(LogLevel::warn, source.name + ": " + describe(entry.node) + ": " + completion.message +
                                     ": drawn from its parent");
    ring.free(completion.outcome == TileState::damaged ? residency.condemn(entry)
                                                       : residency.fail(entry, now + options.retry_after));
}

io::ChunkView Pager::State::view(const TileEntry& entry) const {
    return {ring.bytes(entry.block), source.record(entry.node), source.chunk_shape()};
}

Upload Pager::State::upload_of(const TileEntry& entry) const {
    if (entry.kind == TileKind::imagery) {
        const auto texels = ring.bytes(entry.block).first(io::kImageryTileBytes);
        return {entry.node, entry.kind, {}, texels, texels.size()};
    }
    if (entry.kind == TileKind::heights) {
        const auto texels = ring.bytes(entry.block).first(heights_texels_bytes(source.grid.quads()));
        return {entry.node, entry.kind, {}, texels, texels.size()};
    }
    const io::ChunkView chunk = view(entry);
    // Everything before the ranges goes to the GPU: geometry and normals.
    return {entry.node, entry.kind, chunk, {}, chunk.layout().ranges};
}

// Where a kind's budget is used up, the rest of it waits; the other kind goes on, because what finds no room
// on the GPU stays ready and would keep the other's tiles out for good.
void Pager::State::list_upload(NodeIndex node, std::size_t budget_bytes) {
    TileEntry* entry = residency.find(node);
    if (!entry || entry->state != TileState::ready || entry->listing == listing || !may_upload(*entry))
        return;
    Listed& listed = uploads_listed[index(entry->kind)];
    if (listed.full) return;
    const Upload upload = upload_of(*entry);
    listed.full = listed.bytes > 0 && listed.bytes + upload.bytes > budget_bytes;
    if (listed.full) return;
    listed.bytes += upload.bytes;
    entry->listing = listing;
    uploads.push_back(upload);
}

bool Pager::State::listing_is_full() const {
    return std::ranges::all_of(uploads_listed, [](const Listed& listed) { return listed.full; });
}

std::span<const Upload> Pager::State::list_uploads(std::size_t budget_bytes) {
    ++listing;
    uploads.clear();
    for (const TileKind kind : kEveryTileKind) uploads_listed[index(kind)] = {0, tiles.root_count(kind) == 0};
    if (roots_to_upload > 0)
        for_each_root(source, tiles, [&](NodeIndex root) {
            list_upload(root, budget_bytes);
            return true;
        });
    for (const NodeIndex node : wanted) {
        if (listing_is_full()) break;
        list_upload(node, budget_bytes);
    }
    return uploads;
}

// Nothing is drawn without its parent's data.
bool Pager::State::may_upload(const TileEntry& entry) const {
    if (entry.id.level == 0) return true;
    const TileEntry* parent = residency.find(parent_of(entry));
    return parent && (parent->state == TileState::resident || parent->listing == listing);
}

void Pager::State::mark_resident(NodeIndex node, GpuSlot slot) {
    TileEntry& entry = *residency.find(node);
    residency.become_resident(entry, slot, now, was_drawn_over(entry) ? options.fade : Seconds::zero());
    if (entry.id.level == 0) --roots_to_upload;
    changed();
}

bool Pager::State::was_drawn_over(const TileEntry& entry) const {
    if (entry.id.level == 0) return false;
    const TileEntry* parent = residency.find(parent_of(entry));
    return parent && parent->last_used_frame + 1 >= frame;
}

void Pager::State::record_first_use(NodeIndex node) {
    TileEntry* entry = residency.find(node);
    if (!options.recorder || !entry || entry->requested_frame == 0) return;
    options.recorder->request_to_drawn_frames().record(frame - std::exchange(entry->requested_frame, 0));
}

// What the last frame used, and so what may leave, follows two frames behind a change; then all is told.
bool Pager::State::settled() const {
    if (frame < last_change + 3 || roots_to_upload > 0) return false;
    for (std::uint32_t place = 0; place < wanted.size(); ++place)
        if (in_progress(place)) return false;
    return true;
}

bool Pager::State::in_progress(std::uint32_t place) const {
    const NodeIndex node = wanted[place];
    const TileEntry* entry = residency.find(node);
    if (!entry) return place < refused_from && asks_for(node);
    if (entry->state == TileState::queued) return true;
    if (entry->state != TileState::ready) return false;
    // Refused in this frame or the one before: the last request may have come in between.
    const GpuRefusal& refusal = gpu_refusals[index(entry->kind)];
    if (refusal.stamp + 1 >= stamp && place >= refusal.from) return false;
    // Below a parent that stays out nothing happens; whether it does is its own matter.
    return entry->id.level == 0 || residency.state(parent_of(*entry)) == TileState::resident;
}

NodeIndex Pager::State::parent_of(const TileEntry& entry) const {
    return tiles.index(entry.kind, entry.id.parent());
}

// --- the public face

Result<void> Pager::load_level0() {
    RIDGELINE_ASSERT_ROLE(render);
    return state_->load_level0();
}

void Pager::begin_frame(std::uint32_t frame, Seconds now) {
    RIDGELINE_ASSERT_ROLE(render);
    state_->begin_frame(frame, now);
}

std::span<const Upload> Pager::ready_to_upload(std::size_t budget_bytes) {
    RIDGELINE_ASSERT_ROLE(render);
    return state_->list_uploads(budget_bytes);
}

void Pager::mark_resident(NodeIndex node, GpuSlot slot) { state_->mark_resident(node, slot); }
std::optional<GpuVictim> Pager::gpu_victim(NodeIndex node) { return state_->gpu_victim(node); }
std::optional<GpuVictim> Pager::unwanted_gpu_victim(TileKind kind) {
    return state_->gpu_victim(kind, static_cast<std::uint32_t>(state_->wanted.size()));
}
Residency& Pager::residency() const { return state_->residency; }

void Pager::touch(std::span<const NodeIndex> used) {
    RIDGELINE_ASSERT_ROLE(render);
    for (const NodeIndex node : used) {
        state_->residency.use(node, state_->frame);
        state_->record_first_use(node);
    }
}

void Pager::hold_back(std::span<const NodeIndex> nodes) {
    for (const NodeIndex node : nodes)
        if (TileEntry* entry = state_->residency.find(node); entry && entry->state == TileState::resident)
            state_->residency.restart_fade(*entry, state_->now, state_->options.fade);
}

void Pager::request(std::span<const NodeIndex> wanted) {
    RIDGELINE_ASSERT_ROLE(render);
    state_->request(wanted);
}

bool Pager::settled() const { return state_->settled(); }

std::span<const GpuSlot> Pager::take_released_gpu_slots(TileKind kind) {
    RIDGELINE_ASSERT_ROLE(render);
    State::Released& slots = state_->released[index(kind)];
    std::swap(slots.now, slots.then);
    slots.now.clear();
    return slots.then;
}

io::ChunkView Pager::chunk(NodeIndex node) const {
    const TileEntry* entry = state_->residency.find(node);
    const bool there = entry && entry->kind == TileKind::chunk &&
                       (entry->state == TileState::ready || entry->state == TileState::resident);
    return there ? state_->view(*entry) : io::ChunkView();
}

std::span<const std::byte> Pager::heights(NodeIndex tile) const {
    const TileEntry* entry = state_->residency.find(tile);
    const bool there = entry && entry->kind == TileKind::heights &&
                       (entry->state == TileState::ready || entry->state == TileState::resident);
    return there ? state_->upload_of(*entry).texels : std::span<const std::byte>();
}

TileState Pager::state(NodeIndex node) const {
    const TileState state = state_->residency.state(node);
    if (state != TileState::queued) return state;
    return state_->board.state(state_->outstanding_of(*state_->residency.find(node)).ticket);
}

GpuSlot Pager::gpu_slot(NodeIndex node) const {
    const TileEntry* entry = state_->residency.find(node);
    RIDGELINE_CHECK(entry && entry->state == TileState::resident);
    return entry->gpu_slot;
}

bool Pager::fading() const { return state_->residency.fading(); }
float Pager::fade(NodeIndex node) const { return state_->residency.snapshot()[node].fade; }

const TileSpace& Pager::tiles() const { return state_->tiles; }

PagerCounters Pager::counters(TileKind kind) const {
    PagerCounters counts = state_->counts[index(kind)];
    const IoCounters io = state_->io->counters(kind);
    counts.retried += io.retried;
    counts.reads = io.reads;
    counts.bytes_read = io.bytes_read;
    return counts;
}

PagerCounters Pager::counters() const {
    PagerCounters sum;
    for (const TileKind kind : kEveryTileKind) {
        const PagerCounters counts = counters(kind);
        sum.requested += counts.requested;
        sum.loaded += counts.loaded;
        sum.cancelled += counts.cancelled;
        sum.failed += counts.failed;
        sum.retried += counts.retried;
        sum.evicted += counts.evicted;
        sum.reads += counts.reads;
        sum.bytes_read += counts.bytes_read;
    }
    return sum;
}

std::uint64_t Pager::ram_bytes_used() const { return state_->ring.used_bytes(); }
std::uint64_t Pager::ram_bytes_capacity() const { return state_->ring.capacity_bytes(); }

}  // namespace ridgeline::pager
