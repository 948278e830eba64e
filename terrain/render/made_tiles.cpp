// Literature: tiles computed on demand live in the cache of those that are loaded (synthesis paper, 3.3). How we differ:
// a budget bounds what a frame makes, and what it may evict for it.
#include "ridgeline/render/made_tiles.h"

#include <algorithm>
#include <utility>

namespace ridgeline::render {
namespace {

float fade_of(pager::Seconds since, const MadeMoment& moment) {
    if (moment.fade <= pager::Seconds(0.0)) return 0.0f;
    return static_cast<float>(std::clamp(1.0 - (moment.now - since) / moment.fade, 0.0, 1.0));
}

}  // namespace

Result<MadeTiles> MadeTiles::create(const detail::FinerGround& ground, const io::Grid& lattice, int layers) {
    auto pass = DetailPass::create(ground, lattice.quads());
    if (!pass) return pass.error();
    return MadeTiles(std::move(pass).value(), lattice.finest() - ground.octaves(), layers);
}

MadeTiles::MadeTiles(DetailPass pass, int finest, int layers)
    : pass_(std::move(pass)), finest_(finest), held_(static_cast<std::size_t>(layers)) {
    used_.reserve(held_.size());
    wanted_.reserve(held_.size());
}

void MadeTiles::make(std::span<const select::ScheduledTile> wanted, const MadeMoment& moment,
                     VirtualTexture& tiles, pager::Pager& pager) {
    ++frame_;
    counters_ = {.held = counters_.held, .made_ever = counters_.made_ever};
    settled_ = true;
    urgency_ = 0;
    for (const select::ScheduledTile& tile : wanted) mark_wanted(tile.node, ++urgency_, tiles);
    urgency_ = 0;
    for (const select::ScheduledTile& tile : wanted) {
        ++urgency_;
        if (!is_made(tile.node)) continue;
        ++counters_.wanted;
        const Ended ended = ensure(tile.node, moment, tiles, pager);
        if (ended != Ended::there) ++counters_.missing;
        if (ended == Ended::later) settled_ = false;
    }
    if (std::exchange(unfinished_, false)) pass_.finish();
    wanted_.clear();
    for (const select::ScheduledTile& tile : wanted) wanted_.push_back(tile.node);
    collect_used();
    for (std::uint32_t slot = 0; slot < held_.size(); ++slot)
        if (!held_[slot].empty()) tiles.set_fade(slot, fade_of(held_[slot].since, moment));
}

bool MadeTiles::settled(std::span<const select::ScheduledTile> wanted) const {
    return settled_ && std::ranges::equal(wanted, wanted_, {}, &select::ScheduledTile::node);
}

// What the frame wants must not make room for the rest of it. A tile's ancestors are there where it is.
void MadeTiles::mark_wanted(io::NodeId node, std::uint32_t urgency, const VirtualTexture& tiles) {
    for (; is_made(node); node = node.parent()) {
        const auto slot = tiles.slot_of(node);
        if (!slot) continue;
        if (held_[*slot].wanted_in == frame_) return;
        held_[*slot].wanted_in = frame_;
        held_[*slot].urgency = urgency;
    }
}

MadeTiles::Ended MadeTiles::ensure(io::NodeId node, const MadeMoment& moment, VirtualTexture& tiles,
                                   pager::Pager& pager) {
    if (tiles.slot_of(node)) return Ended::there;
    if (const Ended ended = ensure_parent(node.parent(), moment, tiles, pager); ended != Ended::there)
        return ended;
    if (counters_.made >= static_cast<std::uint32_t>(moment.budget)) return Ended::later;
    if (const Ended ended = find_room(tiles, pager); ended != Ended::there) return ended;
    add(node, moment, tiles);
    return Ended::there;
}

// There, and looking like itself.
MadeTiles::Ended MadeTiles::ensure_parent(io::NodeId parent, const MadeMoment& moment, VirtualTexture& tiles,
                                          pager::Pager& pager) {
    if (!is_made(parent)) {
        const pager::NodeIndex tile = pager.tiles().index(pager::TileKind::heights, parent);
        if (pager.state(tile) != pager::TileState::resident) return Ended::never;
        return pager.fade(tile) > 0.0f ? Ended::later : Ended::there;
    }
    if (const Ended ended = ensure(parent, moment, tiles, pager); ended != Ended::there) return ended;
    const Held& held = held_[*tiles.slot_of(parent)];
    return fade_of(held.since, moment) > 0.0f ? Ended::later : Ended::there;
}

MadeTiles::Ended MadeTiles::find_room(VirtualTexture& tiles, pager::Pager& pager) {
    while (!tiles.has_room()) {
        if (tiles.room_is_coming()) return Ended::later;
        if (make_room(tiles, kOnlyUnwanted)) continue;
        if (const auto victim = pager.unwanted_gpu_victim(pager::TileKind::heights)) {
            forget_below(pager.tiles().id(victim->node), tiles);
            tiles.release(victim->slot);
            continue;
        }
        if (!make_room(tiles, urgency_)) return Ended::never;
    }
    return Ended::there;
}

void MadeTiles::add(io::NodeId node, const MadeMoment& moment, VirtualTexture& tiles) {
    const std::uint32_t parent = *tiles.slot_of(node.parent());
    Held& above = held_[parent];
    if (!above.empty()) {
        ++above.children;
        // Whoever made it in this frame must have finished.
        if (above.made_in == frame_ && std::exchange(unfinished_, false)) pass_.finish();
    }
    const std::uint32_t slot = *tiles.claim(node);
    pass_.make(tiles.texture(),
               {.node = node, .octave = node.level - finest_, .slot = slot, .parent_slot = parent});
    unfinished_ = true;
    held_[slot] = {
        .node = node, .wanted_in = frame_, .urgency = urgency_, .made_in = frame_, .since = moment.now};
    ++counters_.made;
    ++counters_.made_ever;
    ++counters_.held;
}

bool MadeTiles::make_room(VirtualTexture& tiles, std::uint32_t urgency) {
    std::optional<std::uint32_t> oldest, least;
    for (std::uint32_t slot = 0; slot < held_.size(); ++slot) {
        const Held& held = held_[slot];
        if (held.empty() || held.children > 0) continue;
        if (held.wanted_in == frame_) {
            if (held.urgency > urgency && (!least || held.urgency > held_[*least].urgency)) least = slot;
        } else if (!oldest || held.wanted_in < held_[*oldest].wanted_in) {
            oldest = slot;
        }
    }
    const auto victim = oldest ? oldest : least;
    if (victim) release(*victim, tiles);
    return victim.has_value();
}

void MadeTiles::release(std::uint32_t slot, VirtualTexture& tiles) {
    const io::NodeId node = held_[slot].node;
    if (is_made(node.parent())) --held_[*tiles.slot_of(node.parent())].children;
    tiles.release_made(node, slot);
    held_[slot] = {};
    --counters_.held;
}

// Children before their parents. which: of a node, and how many octaves it lies below the source.
template <class Which>
void MadeTiles::release_from_below(VirtualTexture& tiles, Which which) {
    for (int octave = io::DetailInfo::kMostOctaves; octave > 0 && counters_.held > 0; --octave)
        for (std::uint32_t slot = 0; slot < held_.size(); ++slot)
            if (held_[slot].node.level == finest_ + octave && which(held_[slot].node, octave))
                release(slot, tiles);
}

void MadeTiles::forget_below(io::NodeId source, VirtualTexture& tiles) {
    if (source.level != finest_) return;
    release_from_below(tiles, [&](io::NodeId node, int octave) {
        return node.x >> octave == source.x && node.y >> octave == source.y;
    });
}

void MadeTiles::forget_all(VirtualTexture& tiles) {
    release_from_below(tiles, [](io::NodeId, int) { return true; });
    used_.clear();
    wanted_.clear();
    counters_.wanted = counters_.missing = counters_.made = 0;
    settled_ = true;
}

void MadeTiles::collect_used() {
    used_.clear();
    for (std::uint32_t slot = 0; slot < held_.size(); ++slot)
        if (!held_[slot].empty() && held_[slot].wanted_in == frame_) used_.push_back(slot);
    std::ranges::sort(used_, [this](std::uint32_t a, std::uint32_t b) {
        return held_[a].node.level != held_[b].node.level ? held_[a].node.level < held_[b].node.level : a < b;
    });
}

}  // namespace ridgeline::render
