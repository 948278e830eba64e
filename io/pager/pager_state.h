// The inside of the pager: what it owns, and the steps of a frame. Internal; render thread.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ridgeline/pager/io_thread.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/pager/ram_ring.h"
#include "ridgeline/pager/request.h"
#include "ridgeline/pager/residency.h"
#include "ridgeline/pager/victims.h"

namespace ridgeline::pager {

struct Pager::State {
    using Clock = std::chrono::steady_clock;

    // A request slot's side on this thread.
    struct Outstanding {
        NodeIndex node = kNoNode;  // none: the slot is free
        RequestTicket ticket;
        Clock::time_point since;
    };

    State(const TileSource& tiles, jobs::JobSystem& jobs, const PagerOptions& pager_options,
          const TileDecoder* tile_decoder, RamRing&& memory);

    // pager.cpp: the frame
    Result<void> load_level0();
    Result<void> load_now(NodeIndex node);
    Result<void> decode_now(NodeIndex node, std::span<std::byte> block) const;
    void begin_frame(std::uint32_t frame_number, Seconds time);
    void take_in(const Completion& completion);
    std::span<const Upload> list_uploads(std::size_t budget_bytes);
    void list_upload(NodeIndex node, std::size_t budget_bytes);
    bool listing_is_full() const;
    bool may_upload(const TileEntry& entry) const;
    void mark_resident(NodeIndex node, GpuSlot slot);
    NodeIndex parent_of(const TileEntry& entry) const;
    void record_first_use(NodeIndex node);
    bool was_drawn_over(const TileEntry& entry) const;
    std::string describe(NodeIndex node) const;
    io::ChunkView view(const TileEntry& entry) const;
    Upload upload_of(const TileEntry& entry) const;
    bool settled() const;
    bool in_progress(std::uint32_t place) const;

    // paging_requests.cpp: the wanted set
    void request(std::span<const NodeIndex> nodes);
    void adopt(std::span<const NodeIndex> nodes);
    void cancel_unwanted();
    bool asks_for(NodeIndex node) const;
    bool issue(NodeIndex node, std::uint32_t priority);
    bool preempt(std::uint32_t priority);
    bool cancel(Outstanding& outstanding);
    void publish();

    // paging_requests.cpp: making room
    RamBlock make_room(std::size_t bytes, std::uint32_t priority);
    void evict(TileEntry& entry);
    std::optional<GpuVictim> gpu_victim(NodeIndex node);
    std::optional<GpuVictim> gpu_victim(TileKind kind, std::uint32_t priority);
    std::uint32_t priority_of(NodeIndex node) const;

    Wants wants() const { return {wanted, stamp, frame}; }
    void restart_gpu_victims() {
        for (VictimSearch& victims : gpu_victims) victims.restart(residency, wants());
    }
    PagerCounters& counts_of(const TileEntry& entry) { return counts[index(entry.kind)]; }
    Outstanding& outstanding_of(const TileEntry& entry) { return outstanding[entry.request_slot]; }
    void changed() { last_change = frame; }

    TileSource source;
    TileSpace tiles;
    PagerOptions options;
    ChunkDecoder chunk_decoder;
    const TileDecoder* decoder;
    RamRing ring;
    Residency residency;
    std::uint32_t pinned_pages = 0;  // level 0's
    std::uint32_t roots_to_upload = 0;

    // Counts begin_frame() calls, from 2 on: 0 is never used, and 1 is before the first frame.
    std::uint32_t frame = 1;
    Seconds now{};
    std::uint32_t stamp = 1;        // counts request() calls, from 1 on
    std::uint32_t last_change = 1;  // the frame in which a tile last changed its state
    std::vector<NodeIndex> wanted;
    // Wanted from this place on was refused for want of room in RAM.
    std::size_t refused_from = 0;
    // The same on the GPU, as of this request.
    struct GpuRefusal {
        std::uint32_t from = 0;
        std::uint32_t stamp = 0;
    };
    std::array<GpuRefusal, kTileKinds> gpu_refusals;

    std::uint32_t listing = 0;  // counts ready_to_upload() calls
    std::vector<Upload> uploads;
    struct Listed {
        std::size_t bytes = 0;
        bool full = false;
    };
    std::array<Listed, kTileKinds> uploads_listed;  // in this listing
    struct Released {
        std::vector<GpuSlot> now;   // since the last take_released_gpu_slots()
        std::vector<GpuSlot> then;  // what that call returned
    };
    std::array<Released, kTileKinds> released;
    VictimSearch ram_victims{AgeWalk::ram};
    std::array<VictimSearch, kTileKinds> gpu_victims{VictimSearch(AgeWalk::gpu_chunks),
                                                     VictimSearch(AgeWalk::gpu_imagery),
                                                     VictimSearch(AgeWalk::gpu_heights)};

    std::vector<Outstanding> outstanding;  // by request slot
    std::array<PagerCounters, kTileKinds> counts;
    RequestBoard board;
    // Last, so that its thread is gone before what it uses.
    std::unique_ptr<IoThread> io;
};

}  // namespace ridgeline::pager
