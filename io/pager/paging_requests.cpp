// How the pager turns the wanted set into requests, and makes room for them.
//
// Every frame sends the whole wanted set. What fell out of it is cancelled first, which also gives its blocks
// back; then, most urgent first, what is missing gets a block and a request slot, at the expense of what is
// wanted less. The first tile for which no room can be made ends the round: smaller ones behind it must not
// take, frame by frame, the room that gathers for it.
#include <algorithm>
#include <utility>

#include "ridgeline/pager/pager_state.h"

namespace ridgeline::pager {

void Pager::State::request(std::span<const NodeIndex> nodes) {
    adopt(nodes);
    cancel_unwanted();
    ram_victims.restart(residency, wants());
    restart_gpu_victims();
    refused_from = wanted.size();
    for (std::uint32_t place = 0; place < wanted.size(); ++place) {
        if (!asks_for(wanted[place])) continue;
        if (board.full() && !preempt(place)) break;
        if (!issue(wanted[place], place)) {
            refused_from = place;
            break;
        }
    }
    publish();
}

void Pager::State::adopt(std::span<const NodeIndex> nodes) {
    ++stamp;
    wanted.assign(nodes.begin(), nodes.end());
    // From the least urgent on: so ancestors end up newer than descendants, and of a node that is named twice
    // the more urgent place counts.
    for (std::size_t place = wanted.size(); place-- > 0;) {
        TileEntry* entry = residency.find(wanted[place]);
        if (!entry) continue;
        entry->wanted_stamp = stamp;
        entry->priority = static_cast<std::uint32_t>(place);
        if (entry->block) residency.renew(*entry);
    }
}

void Pager::State::cancel_unwanted() {
    for (Outstanding& request : outstanding)
        if (request.node != kNoNode && residency.find(request.node)->wanted_stamp != stamp) cancel(request);
}

bool Pager::State::cancel(Outstanding& request) {
    if (!board.cancel(request.ticket)) return false;
    TileEntry& entry = *residency.find(std::exchange(request.node, kNoNode));
    ++counts_of(entry).cancelled;
    ring.free(residency.remove(entry));
    changed();
    return true;
}

// Whether the node is missing and could be had: a tile that can never fit beside level 0 counts as if it
// failed.
bool Pager::State::asks_for(NodeIndex node) const {
    if (const TileEntry* entry = residency.find(node))
        return entry->state == TileState::failed && now >= entry->retry_at;
    return residency.state(node) == TileState::absent && source.has_data(node) &&
           RamRing::pages_for(source.decoded_bytes(node)) <= ring.page_count() - pinned_pages;
}

bool Pager::State::issue(NodeIndex node, std::uint32_t priority) {
    const RamBlock block = make_room(source.decoded_bytes(node), priority);
    if (!block) return false;
    const bool again = residency.find(node) != nullptr;
    TileEntry& entry = residency.queue(node, block);
    if (again) ++counts_of(entry).retried;
    const RequestTicket ticket = board.open();
    entry.request_slot = ticket.slot;
    entry.requested_frame = frame;
    entry.wanted_stamp = stamp;
    entry.priority = priority;
    outstanding[ticket.slot] = {node, ticket, Clock::now()};
    ++counts_of(entry).requested;
    changed();
    return true;
}

// Takes a request slot from the least urgent request, if that is less urgent.
bool Pager::State::preempt(std::uint32_t priority) {
    Outstanding* least = nullptr;
    std::uint32_t least_priority = priority;
    for (Outstanding& request : outstanding) {
        if (request.node == kNoNode || board.state(request.ticket) != TileState::queued) continue;
        const std::uint32_t its = residency.find(request.node)->priority;
        if (its <= least_priority) continue;
        least = &request;
        least_priority = its;
    }
    return least && cancel(*least);
}

// All that still stands, since the I/O thread forgets the batch before.
void Pager::State::publish() {
    IoThread::Batch& batch = io->draft();
    batch.clear();
    for (const NodeIndex node : wanted) {
        const TileEntry* entry = residency.find(node);
        if (!entry || entry->state != TileState::queued) continue;
        const RequestTicket ticket = outstanding_of(*entry).ticket;
        if (board.state(ticket) == TileState::queued)
            batch.push_back({ticket, node, ring.bytes(entry->block)});
    }
    if (!batch.empty()) io->publish();
}

// --- making room

RamBlock Pager::State::make_room(std::size_t bytes, std::uint32_t priority) {
    for (;;) {
        if (const RamBlock block = ring.allocate(bytes)) return block;
        TileEntry* victim = ram_victims.next(residency, wants(), priority);
        if (!victim) return {};
        if (victim->state != TileState::queued)
            evict(*victim);
        else
            cancel(outstanding_of(*victim));
    }
}

void Pager::State::evict(TileEntry& entry) {
    if (entry.state == TileState::resident)
        released[index(entry.kind)].now.push_back(residency.leave_gpu(entry));
    ++counts_of(entry).evicted;
    ring.free(residency.remove(entry));
    changed();
}

std::uint32_t Pager::State::priority_of(NodeIndex node) const {
    const TileEntry* entry = residency.find(node);
    return entry && entry->wanted_stamp == stamp && entry->id.level > 0 ? entry->priority : 0;
}

std::optional<GpuVictim> Pager::State::gpu_victim(TileKind kind, std::uint32_t priority) {
    TileEntry* victim = gpu_victims[index(kind)].next(residency, wants(), priority);
    if (!victim) return {};
    changed();
    return GpuVictim{victim->node, residency.leave_gpu(*victim)};
}

std::optional<GpuVictim> Pager::State::gpu_victim(NodeIndex node) {
    const std::uint32_t priority = priority_of(node);
    if (const auto victim = gpu_victim(tiles.kind(node), priority)) return victim;
    GpuRefusal& refusal = gpu_refusals[index(tiles.kind(node))];
    refusal = {refusal.stamp == stamp ? std::min(refusal.from, priority) : priority, stamp};
    return {};
}

}  // namespace ridgeline::pager
