// The residency table: for every tile of the store, whether it is in RAM and on the GPU, since when it was
// not used, and what hangs below it. The map from tiles to slots; the slots' storage is elsewhere (ram_ring.h
// and the renderer).
//
// Owned by the render thread. Selection reads the flat snapshot while a lease is out; until it comes back,
// nothing here may change (asserted). Per tile the table holds 20 bytes, which cost no memory before they are
// first touched; per tile in RAM one entry.
//
// A tile's life:
//
//             request            I/O thread          I/O thread           worker              renderer
//   absent ───────────► queued ────────────► reading ──────────► decoding ────────► ready ◄──────────►
//   resident
//     ▲  ▲                │                    │  │ read fails:     │ the bytes      │     GPU victim      │
//     │  └── cancelled ───┴────────────────────┘  │ two retries,    │ are damaged    │                     │
//     │                                           │ then            ▼                │                     │
//     │                                           │              damaged             │                     │
//     │                                           ▼              (for good)          │                     │
//     │         2 s later, if wanted: queued ◄── failed                              │                     │
//     └──────────────────────────────────── evicted from RAM ◄───────────────────────┴─────────────────────┘
//
// failed: a read error or a checksum that does not match, which may be the disk's mood. damaged: the checksum
// matches but the chunk does not decode, so reading it again cannot help. Both are drawn from the parent.
// reading and decoding live in the request (request.h) while it is under way; this table then says queued.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <vector>

#include "ridgeline/base/contract.h"
#include "ridgeline/io/node_residency.h"
#include "ridgeline/pager/ram_ring.h"
#include "ridgeline/pager/tile_space.h"

namespace ridgeline::pager {

using Seconds = std::chrono::duration<double>;

enum class TileState : std::uint8_t { absent, queued, reading, decoding, ready, resident, failed, damaged };
const char* name(TileState state);

// A place in GPU memory; what it means is the renderer's business.
enum class GpuSlot : std::uint32_t {};

class Residency;

// While it lives, the residency table stands still. Movable, given back on the render thread.
class SelectionLease {
  public:
    explicit SelectionLease(Residency& residency);
    ~SelectionLease();
    SelectionLease(SelectionLease&& other) noexcept : residency_(other.residency_) {
        other.residency_ = nullptr;
    }
    SelectionLease& operator=(SelectionLease&&) = delete;
    // Of the chunks, which are what selection is about.
    std::span<const io::NodeResidency> snapshot() const { return snapshot_; }

  private:
    Residency* residency_;
    std::span<const io::NodeResidency> snapshot_;
};

// Zeroed memory that the system provides page by page as it is first touched.
template <class T>
class LazyArray {
  public:
    explicit LazyArray(std::size_t count)
        : data_(static_cast<T*>(std::calloc(count, sizeof(T)))), count_(count) {}
    explicit operator bool() const { return data_ != nullptr; }
    T& operator[](std::size_t i) { return data_.get()[i]; }
    const T& operator[](std::size_t i) const { return data_.get()[i]; }
    std::span<const T> span() const { return {data_.get(), count_}; }

  private:
    struct Free {
        void operator()(T* data) const { std::free(data); }
    };
    std::unique_ptr<T, Free> data_;
    std::size_t count_;
};

// What the table knows of a tile that is in RAM, on its way there, or failed.
struct TileEntry {
    NodeIndex node = kNoNode;
    TileKind kind = TileKind::chunk;
    io::NodeId id;
    TileState state = TileState::absent;
    RamBlock block;
    GpuSlot gpu_slot{};
    std::uint32_t last_used_frame = 0;  // last drawn; 0 before
    std::uint32_t requested_frame = 0;  // 0 once its first use is recorded
    // The request() that last wanted the node, and the node's place in it.
    std::uint32_t wanted_stamp = 0;
    std::uint32_t priority = 0;
    std::uint32_t listing = 0;       // the ready_to_upload() that last listed it
    std::uint32_t request_slot = 0;  // queued
    Seconds retry_at{};              // failed
    Seconds fade_start{};            // resident
    Seconds fade_length{};
    // Neighbours by age among the entries that hold RAM.
    std::uint32_t older = 0;
    std::uint32_t newer = 0;
};

// Walks over the entries, one for each cache that makes room: RAM for all, and the GPU's for each kind.
enum class AgeWalk : std::uint8_t { ram, gpu_chunks, gpu_imagery, gpu_heights };
constexpr AgeWalk gpu_walk(TileKind kind) {
    if (kind == TileKind::chunk) return AgeWalk::gpu_chunks;
    return kind == TileKind::imagery ? AgeWalk::gpu_imagery : AgeWalk::gpu_heights;
}

class Residency {
  public:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    // max_entries: tiles that may be in RAM, under way or failed at one time.
    Residency(const TileSpace& tiles, std::uint32_t max_entries);

    bool full() const { return free_.empty() && fresh_ == max_entries_; }
    TileState state(NodeIndex node) const;
    // Null where the node is absent or damaged. Stays where it is until the node becomes absent.
    TileEntry* find(NodeIndex node);
    const TileEntry* find(NodeIndex node) const;

    // absent or failed → queued, holding its block.
    TileEntry& queue(NodeIndex node, RamBlock block);
    // queued → ready.
    void become_ready(TileEntry& entry);
    // ready → resident; fades in from `now` over `fade`, at once where that is 0.
    void become_resident(TileEntry& entry, GpuSlot slot, Seconds now, Seconds fade);
    // resident → ready; the slot is the caller's.
    GpuSlot leave_gpu(TileEntry& entry);
    // The following return the entry's block, to be freed; the entry dies but for a failed one.
    // queued → failed. Of very many failed nodes the longest failed are forgotten.
    RamBlock fail(TileEntry& entry, Seconds retry_at);
    // queued → damaged.
    RamBlock condemn(TileEntry& entry);
    // queued, ready or failed → absent.
    RamBlock remove(TileEntry& entry);
    // True the first time it is asked of a node: its failure has not been reported yet.
    bool report_once(NodeIndex node);

    // Marks the chunk and its ancestors as used in `frame`, and as the newest, ancestors newer than the
    // chunk.
    void use(NodeIndex node, std::uint32_t frame);
    // Makes an entry that holds RAM the newest, without use.
    void renew(TileEntry& entry);
    void advance_fades(Seconds now);
    // Back to the start of its fade.
    void restart_fade(TileEntry& entry, Seconds now, Seconds fade);
    bool fading() const { return !fading_.empty(); }

    // Tiles anywhere below the node that hold RAM; those on the GPU.
    std::uint32_t descendants_in_ram(NodeIndex node) const { return ram_below_[node]; }
    std::uint32_t descendants_on_gpu(NodeIndex node) const { return gpu_below_[node]; }
    std::uint32_t in_ram_count() const { return in_ram_; }

    // Walks the entries that hold RAM from the oldest on; null at the end. A walk survives any change.
    void restart(AgeWalk walk) { walks_[static_cast<std::size_t>(walk)] = oldest_; }
    TileEntry* step(AgeWalk walk);

    SelectionLease lend() { return SelectionLease(*this); }
    const TileSpace& tiles() const { return tiles_; }
    std::span<const io::NodeResidency> snapshot() const { return residency_.span(); }

  private:
    friend class SelectionLease;

    // What a node's word says: its entry plus 1 in the low bits, 0 without.
    static constexpr std::uint32_t kReported = 1u << 31;
    static constexpr std::uint32_t kDamaged = 1u << 30;
    static constexpr std::uint32_t kEntryMask = kDamaged - 1;
    static constexpr std::size_t kMaxFailed = 4096;

    std::uint32_t index_of(const TileEntry& entry) const {
        return static_cast<std::uint32_t>(&entry - entries_.span().data());
    }
    void assert_mutable() const;

    TileEntry& create(NodeIndex node);
    void destroy(TileEntry& entry);
    void link_newest(TileEntry& entry);
    void unlink(TileEntry& entry);
    RamBlock release_block(TileEntry& entry);
    void add_below(LazyArray<std::uint32_t>& counts, const TileEntry& entry, std::uint32_t change);
    void forget_oldest_failed();
    void stop_fading(TileEntry& entry);

    TileSpace tiles_;
    LazyArray<std::uint32_t> words_;
    LazyArray<std::uint32_t> ram_below_;
    LazyArray<std::uint32_t> gpu_below_;
    LazyArray<io::NodeResidency> residency_;

    std::uint32_t max_entries_;
    std::uint32_t fresh_ = 0;  // entries never used so far begin here
    LazyArray<TileEntry> entries_;
    std::vector<std::uint32_t> free_;
    std::vector<std::uint32_t> fading_;  // entries
    std::vector<NodeIndex> failed_;      // a ring; some may have recovered
    std::size_t failed_begin_ = 0;
    std::uint32_t oldest_ = kNone;
    std::uint32_t newest_ = kNone;
    std::array<std::uint32_t, 4> walks_{kNone, kNone, kNone, kNone};
    std::uint32_t in_ram_ = 0;
    int leases_ = 0;
};

}  // namespace ridgeline::pager
