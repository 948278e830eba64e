#include "ridgeline/pager/residency.h"

#include <algorithm>
#include <new>
#include <utility>

#include "ridgeline/base/thread_role.h"

namespace ridgeline::pager {

const char* name(TileState state) {
    switch (state) {
        case TileState::absent:
            return "absent";
        case TileState::queued:
            return "queued";
        case TileState::reading:
            return "reading";
        case TileState::decoding:
            return "decoding";
        case TileState::ready:
            return "ready";
        case TileState::resident:
            return "resident";
        case TileState::failed:
            return "failed";
        case TileState::damaged:
            return "damaged";
    }
    return "";
}

SelectionLease::SelectionLease(Residency& residency)
    : residency_(&residency),
      snapshot_(residency.snapshot().first(residency.tiles().begin(TileKind::imagery))) {
    ++residency.leases_;
}

SelectionLease::~SelectionLease() {
    if (!residency_) return;
    RIDGELINE_ASSERT_ROLE(render);
    --residency_->leases_;
}

Residency::Residency(const TileSpace& tiles, std::uint32_t max_entries)
    : tiles_(tiles),
      words_(tiles.count()),
      ram_below_(words_.span().size()),
      gpu_below_(words_.span().size()),
      residency_(words_.span().size()),
      max_entries_(max_entries),
      entries_(max_entries) {
    RIDGELINE_CHECK(max_entries < kEntryMask);
    RIDGELINE_CHECK(words_ && ram_below_ && gpu_below_ && residency_ && entries_);
    free_.reserve(max_entries);
    fading_.reserve(max_entries);
    failed_.reserve(kMaxFailed);
}

void Residency::assert_mutable() const {
    RIDGELINE_ASSERT_ROLE(render);
    RIDGELINE_ASSERT(leases_ == 0);  // selection is reading the snapshot
}

TileEntry* Residency::find(NodeIndex node) {
    const std::uint32_t entry = words_[node] & kEntryMask;
    return entry ? &entries_[entry - 1] : nullptr;
}

const TileEntry* Residency::find(NodeIndex node) const { return const_cast<Residency*>(this)->find(node); }

TileState Residency::state(NodeIndex node) const {
    if (words_[node] & kDamaged) return TileState::damaged;
    const TileEntry* entry = find(node);
    return entry ? entry->state : TileState::absent;
}

bool Residency::report_once(NodeIndex node) {
    const bool first = (words_[node] & kReported) == 0;
    words_[node] |= kReported;
    return first;
}

// --- entries

TileEntry& Residency::create(NodeIndex node) {
    RIDGELINE_CHECK(!full());
    std::uint32_t index = fresh_;
    if (free_.empty()) {
        ++fresh_;
    } else {
        index = free_.back();
        free_.pop_back();
    }
    TileEntry& entry = *new (&entries_[index]) TileEntry;
    entry.node = node;
    entry.kind = tiles_.kind(node);
    entry.id = tiles_.id(node);
    words_[node] = (words_[node] & ~kEntryMask) | (index + 1);
    return entry;
}

void Residency::destroy(TileEntry& entry) {
    words_[entry.node] &= ~kEntryMask;
    free_.push_back(index_of(entry));
    entry.state = TileState::absent;
    entry.node = kNoNode;
}

void Residency::add_below(LazyArray<std::uint32_t>& counts, const TileEntry& entry, std::uint32_t change) {
    io::NodeId id = entry.id;
    while (id.level > 0) {
        id = id.parent();
        counts[tiles_.index(entry.kind, id)] += change;
    }
}

RamBlock Residency::release_block(TileEntry& entry) {
    if (!entry.block) return {};
    add_below(ram_below_, entry, ~0u);
    unlink(entry);
    --in_ram_;
    return std::exchange(entry.block, {});
}

// --- transitions

TileEntry& Residency::queue(NodeIndex node, RamBlock block) {
    assert_mutable();
    RIDGELINE_CHECK(block && (words_[node] & kDamaged) == 0);
    TileEntry* entry = find(node);
    RIDGELINE_CHECK(!entry || entry->state == TileState::failed);
    if (!entry) entry = &create(node);
    entry->state = TileState::queued;
    entry->block = block;
    add_below(ram_below_, *entry, 1);
    link_newest(*entry);
    ++in_ram_;
    return *entry;
}

void Residency::become_ready(TileEntry& entry) {
    assert_mutable();
    RIDGELINE_CHECK(entry.state == TileState::queued);
    entry.state = TileState::ready;
}

void Residency::become_resident(TileEntry& entry, GpuSlot slot, Seconds now, Seconds fade) {
    assert_mutable();
    RIDGELINE_CHECK(entry.state == TileState::ready);
    entry.state = TileState::resident;
    entry.gpu_slot = slot;
    add_below(gpu_below_, entry, 1);
    residency_[entry.node] = {0.0f, true};
    restart_fade(entry, now, fade);
}

GpuSlot Residency::leave_gpu(TileEntry& entry) {
    assert_mutable();
    RIDGELINE_CHECK(entry.state == TileState::resident);
    entry.state = TileState::ready;
    add_below(gpu_below_, entry, ~0u);
    stop_fading(entry);
    residency_[entry.node] = {};
    return entry.gpu_slot;
}

RamBlock Residency::fail(TileEntry& entry, Seconds retry_at) {
    assert_mutable();
    RIDGELINE_CHECK(entry.state == TileState::queued);
    if (failed_.size() == kMaxFailed) forget_oldest_failed();
    if (failed_.size() < kMaxFailed)
        failed_.push_back(entry.node);
    else
        failed_[std::exchange(failed_begin_, (failed_begin_ + 1) % kMaxFailed)] = entry.node;
    entry.state = TileState::failed;
    entry.retry_at = retry_at;
    return release_block(entry);
}

void Residency::forget_oldest_failed() {
    TileEntry* oldest = find(failed_[failed_begin_]);
    if (oldest && oldest->state == TileState::failed) destroy(*oldest);
}

RamBlock Residency::condemn(TileEntry& entry) {
    words_[entry.node] |= kDamaged;
    return remove(entry);
}

RamBlock Residency::remove(TileEntry& entry) {
    assert_mutable();
    RIDGELINE_CHECK(entry.state != TileState::resident && entry.state != TileState::absent);
    const RamBlock block = release_block(entry);
    destroy(entry);
    return block;
}

// --- fades

void Residency::restart_fade(TileEntry& entry, Seconds now, Seconds fade) {
    assert_mutable();
    RIDGELINE_CHECK(entry.state == TileState::resident);
    if (fade <= Seconds::zero()) return;
    if (residency_[entry.node].fade == 0.0f) fading_.push_back(index_of(entry));
    residency_[entry.node].fade = 1.0f;
    entry.fade_start = now;
    entry.fade_length = fade;
}

void Residency::advance_fades(Seconds now) {
    assert_mutable();
    std::erase_if(fading_, [&](std::uint32_t index) {
        const TileEntry& entry = entries_[index];
        const double past = (now - entry.fade_start) / entry.fade_length;
        residency_[entry.node].fade = static_cast<float>(std::clamp(1.0 - past, 0.0, 1.0));
        // As the snapshot has it: a fade that is 0 there must not be in the list.
        return residency_[entry.node].fade == 0.0f;
    });
}

void Residency::stop_fading(TileEntry& entry) {
    if (residency_[entry.node].fade == 0.0f) return;
    residency_[entry.node].fade = 0.0f;
    std::erase(fading_, index_of(entry));
}

// --- age

void Residency::use(NodeIndex node, std::uint32_t frame) {
    assert_mutable();
    const TileKind kind = tiles_.kind(node);
    for (io::NodeId id = tiles_.id(node);; id = id.parent()) {
        if (TileEntry* entry = find(tiles_.index(kind, id)); entry && entry->block) {
            entry->last_used_frame = frame;
            renew(*entry);
        }
        if (id.level == 0) return;
    }
}

void Residency::renew(TileEntry& entry) {
    unlink(entry);
    link_newest(entry);
}

void Residency::link_newest(TileEntry& entry) {
    const std::uint32_t index = index_of(entry);
    entry.older = newest_;
    entry.newer = kNone;
    (newest_ == kNone ? oldest_ : entries_[newest_].newer) = index;
    newest_ = index;
}

TileEntry* Residency::step(AgeWalk walk) {
    std::uint32_t& next = walks_[static_cast<std::size_t>(walk)];
    if (next == kNone) return nullptr;
    TileEntry& entry = entries_[next];
    next = entry.newer;
    return &entry;
}

void Residency::unlink(TileEntry& entry) {
    for (std::uint32_t& next : walks_)
        if (next == index_of(entry)) next = entry.newer;
    (entry.older == kNone ? oldest_ : entries_[entry.older].newer) = entry.newer;
    (entry.newer == kNone ? newest_ : entries_[entry.newer].older) = entry.older;
}

}  // namespace ridgeline::pager
