// The pager: brings wanted tiles from the store into RAM, hands them to the renderer for upload, and decides
// what leaves RAM and GPU when room is needed.
//
// Chunks, imagery and heights go the same way: one order of urgency, which is the wanted list's, one RAM
// ring, one I/O thread. Only their GPU memories are separate, each with its own victims.
//
// Everything here is called by the render thread, which never waits in it (load_level0 and the destructor
// aside). The pager owns the RAM ring, the residency table, the I/O thread and the requests; the renderer
// owns the GPU memory and names its parts by opaque slots. GPU is a subset of RAM: every chunk that can be
// drawn also has its CPU copy, so that the eye and the pointer meet the very triangles on the screen; a tile
// of imagery that left the GPU comes back without the disk.
// docs/threads.md.
//
// A frame, in this order:
//
//   begin_frame(frame, now)
//   for (upload : ready_to_upload(budget))           room = gpu_victim(upload.node) where GPU memory is short
//       mark_resident(upload.node, slot)             not called where no room could be made, nor for any less
//                                                    urgent tile of the kind in this frame
//   { auto lease = lend_to_selection(); run selection on lease.snapshot(), wait for it }
//   touch(nodes used), hold_back(nodes left out)
//   request(wanted, most urgent first)
//   retire take_released_gpu_slots() after their fence
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "ridgeline/base/result.h"
#include "ridgeline/io/chunk.h"
#include "ridgeline/pager/fault.h"
#include "ridgeline/pager/residency.h"
#include "ridgeline/pager/tile_source.h"

namespace ridgeline::jobs {
class JobSystem;
}
namespace ridgeline::telemetry {
class Recorder;
}

namespace ridgeline::pager {

struct PagerOptions {
    // What decoded tiles may take in RAM (--ram-cache).
    std::uint64_t ram_bytes = std::uint64_t{256} << 20;
    FaultSpec fault{};
    // Tiles under way at a time: enough that neighbours in the file are found and read together; each holds
    // a block of the ring.
    int max_requests = 256;
    // Decodes handed to the workers at a time; 0: one more than there are workers. Few, so that nothing
    // urgent queues behind them.
    int max_decodes = 0;
    // Over which a tile that arrives late morphs or sharpens in; 0 where pictures must not depend on time
    // (--wait-for-tiles).
    Seconds fade{0.5};
    // After which a failed tile is tried again while it is wanted.
    Seconds retry_after{2.0};
    // Takes latencies, the I/O thread's CPU time and trace events; null: nobody does. Must outlive the pager.
    // Tile counters are not written there but kept here: counters().
    telemetry::Recorder* recorder = nullptr;
};

// Since construction.
struct PagerCounters {
    std::uint64_t requested = 0;
    std::uint64_t loaded = 0;
    std::uint64_t cancelled = 0;
    std::uint64_t failed = 0;
    std::uint64_t retried = 0;  // reads repeated at once by the I/O thread, and failed tiles asked for again
    std::uint64_t evicted = 0;  // from RAM
    std::uint64_t reads = 0;
    std::uint64_t bytes_read = 0;
};

struct Upload {
    NodeIndex node = kNoNode;
    TileKind kind = TileKind::chunk;
    // The one or the other; valid until the next call that may evict: request(), load_level0().
    io::ChunkView chunk;
    // io::kImageryTileBytes of imagery, heights_texels_bytes of heights.
    std::span<const std::byte> texels;
    std::size_t bytes = 0;
};

struct GpuVictim {
    NodeIndex node = kNoNode;
    GpuSlot slot{};
};

class Pager {
  public:
    // `decoder` may be null: chunks as stores hold them. Source, decoder and jobs must outlive the pager.
    static Result<Pager> create(const TileSource& source, jobs::JobSystem& jobs, const PagerOptions& options,
                                const TileDecoder* decoder = nullptr);
    // Joins the I/O thread and the decodes under way, in under a second.
    ~Pager();
    Pager(Pager&&) noexcept;
    Pager& operator=(Pager&&) noexcept;

    // Reads and decodes level 0 on this thread, without injected faults; before the first frame. It stays in
    // RAM. Fails where it is damaged or does not fit, naming the least size that does.
    Result<void> load_level0();

    // Takes in what the I/O thread and the workers finished. `frame` is the one that is to be shown, as
    // FaultSpec counts them; it stands still while a frame is made ready in several rounds. `now` is the
    // clock of fades and of the retry of failed chunks, and may stand still.
    void begin_frame(std::uint32_t frame, Seconds now);

    // Tiles in RAM that the last request() wanted on the GPU (and level 0), most urgent first, parents before
    // children, of each kind within a budget of bytes but for its first: the renderer spends the budget on
    // those of either kind for which it has room. Valid until the next call of request() or this.
    std::span<const Upload> ready_to_upload(std::size_t budget_bytes);
    // The tile is on the GPU from now on, and fades in if what it replaces was drawn in the last frame.
    void mark_resident(NodeIndex node, GpuSlot slot);
    // The tile of its kind that should leave the GPU for `node`, by age of last use: never one that the last
    // frame used, that has descendants on the GPU, of level 0, or wanted more urgently. Its slot is the
    // renderer's from then on; it stays in RAM. Nothing: `node` does not fit; it and what is wanted less of
    // its kind count as settled, and are not to be uploaded before it, or uploads and evictions take turns
    // for ever.
    std::optional<GpuVictim> gpu_victim(NodeIndex node);
    // One that nobody wants, for something of the renderer's own; nothing is settled by there being none.
    std::optional<GpuVictim> unwanted_gpu_victim(TileKind kind);

    // What selection may read while the render thread does other things; nothing may change meanwhile
    // (asserted).
    SelectionLease lend_to_selection() { return residency().lend(); }

    // The nodes on which this frame's picture rests. What the current and the last frame used is never
    // evicted.
    void touch(std::span<const NodeIndex> used);
    // Tiles on the GPU that selection had to leave out although the view asks for them: they fade in when
    // they are let in.
    void hold_back(std::span<const NodeIndex> nodes);
    // The whole wanted set, of both kinds, most urgent first, ancestors before descendants. Tiles on their
    // way that it does not name are cancelled.
    void request(std::span<const NodeIndex> wanted);
    // Nothing of the last request() can still change: all of it is on the GPU, has failed, or does not fit.
    bool settled() const;
    // Slots of tiles of a kind that were evicted from RAM since the last call: the renderer's, to be freed
    // after their fence.
    std::span<const GpuSlot> take_released_gpu_slots(TileKind kind = TileKind::chunk);

    // The chunk's CPU copy where it is in RAM (ready or on the GPU), else empty. Valid until request().
    io::ChunkView chunk(NodeIndex node) const;
    // The same of a tile of heights: heights_texels_bytes.
    std::span<const std::byte> heights(NodeIndex tile) const;
    TileState state(NodeIndex node) const;
    // Where the node's data lies on the GPU; it must be resident.
    GpuSlot gpu_slot(NodeIndex node) const;
    bool fading() const;
    // How far the node still looks like its parent: 1 when it has just arrived, 0 in the end.
    float fade(NodeIndex node) const;

    const TileSpace& tiles() const;
    PagerCounters counters(TileKind kind) const;
    // Of both kinds.
    PagerCounters counters() const;
    std::uint64_t ram_bytes_used() const;
    std::uint64_t ram_bytes_capacity() const;

  private:
    struct State;
    explicit Pager(std::unique_ptr<State> state);
    Residency& residency() const;

    std::unique_ptr<State> state_;
};

}  // namespace ridgeline::pager
