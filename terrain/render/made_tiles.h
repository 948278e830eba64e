// Tiles of ground finer than the source: which are in which slots of the heights' texture, which are made next, and
// which leave. docs/detail.md.
//
// They share the slots with the tiles that the pager brings. A tile is made where its parent is, within a frame's
// budget, coarse before fine; it is the same whoever makes it and whenever, so one that left costs nothing but its
// making. Hence those that the last frame did not want make room first, the longest unwanted before the others; then
// tiles of the source that nobody wants; then made ones that are wanted least, so that what is there in the end does
// not depend on what was there before. A tile that has children there stays. A new tile looks like its parent at first,
// and has none below it while it does: so nothing pops.
//
// Render thread only; after the first frames nothing allocates.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/detail/finer_ground.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/render/detail_pass.h"
#include "ridgeline/render/virtual_texture.h"
#include "ridgeline/select/tile_schedule.h"

namespace ridgeline::render {

// When tiles are made.
struct MadeMoment {
    pager::Seconds now{0.0};
    // Over which a tile turns from its parent's look to its own; 0: it does not.
    pager::Seconds fade{0.25};
    // Tiles that this frame may make.
    int budget = 8;
};

struct MadeCounters {
    std::uint32_t wanted = 0;   // in the last frame, parents not counted
    std::uint32_t missing = 0;  // of them those that are not there yet
    std::uint32_t made = 0;     // in the last frame
    std::uint32_t held = 0;     // slots with made tiles
    std::uint64_t made_ever = 0;
};

class MadeTiles {
  public:
    // finest: the source's finest level. layers: slots of the texture.
    static Result<MadeTiles> create(const detail::FinerGround& ground, const io::Grid& lattice, int layers);

    // Makes what is missing of a frame's tiles, finer than the source (others are passed over), coarse before fine.
    void make(std::span<const select::ScheduledTile> wanted, const MadeMoment& moment, VirtualTexture& tiles,
              pager::Pager& pager);
    // The last make() was for these, and nothing of it can still change: all is there, or finds no room, or waits for the
    // source's tile.
    bool settled(std::span<const select::ScheduledTile> wanted) const;
    // Gives up the slot of the tile that has been unwanted for longest, or else of the least urgent of those that are
    // less urgent than this: a place in the order of the last make(), which counts from 1. False: there is none.
    static constexpr std::uint32_t kOnlyUnwanted = 0xffffffffu, kEvenWanted = 0;
    bool make_room(VirtualTexture& tiles, std::uint32_t urgency);
    // A tile of the source leaves, and all that was made of it with it.
    void forget_below(io::NodeId source, VirtualTexture& tiles);

    // All of them leave.
    void forget_all(VirtualTexture& tiles);

    // Calls visit(node, slot) for every made tile that the last make() wanted and that is there, coarse before fine,
    // each with its made ancestors.
    template <class Visit>
    void for_each_wanted(Visit visit) const {
        for (const std::uint32_t slot : used_) visit(held_[slot].node, slot);
    }
    // Of a slot that holds a made tile.
    io::NodeId node(std::uint32_t slot) const { return held_[slot].node; }
    const MadeCounters& counters() const { return counters_; }

  private:
    struct Held {
        io::NodeId node{-1, 0, 0};
        std::uint32_t wanted_in = 0;  // the make() that last wanted it
        std::uint32_t urgency = 0;    // its place in that one's order
        std::uint32_t made_in = 0;
        int children = 0;
        pager::Seconds since{0.0};

        bool empty() const { return node.level < 0; }
    };

    MadeTiles(DetailPass pass, int finest, int layers);
    bool is_made(io::NodeId node) const { return node.level > finest_; }
    void mark_wanted(io::NodeId node, std::uint32_t urgency, const VirtualTexture& tiles);
    // What became of a tile: it is there, will be in a later frame, or cannot be before something else changes.
    enum class Ended { there, later, never };
    Ended ensure(io::NodeId node, const MadeMoment& moment, VirtualTexture& tiles, pager::Pager& pager);
    Ended ensure_parent(io::NodeId parent, const MadeMoment& moment, VirtualTexture& tiles,
                        pager::Pager& pager);
    Ended find_room(VirtualTexture& tiles, pager::Pager& pager);
    void add(io::NodeId node, const MadeMoment& moment, VirtualTexture& tiles);
    void release(std::uint32_t slot, VirtualTexture& tiles);
    void collect_used();
    template <class Which>
    void release_from_below(VirtualTexture& tiles, Which which);

    DetailPass pass_;
    int finest_;
    std::vector<Held> held_;  // by slot
    std::vector<std::uint32_t> used_;
    std::vector<io::NodeId> wanted_;  // of the last make()
    MadeCounters counters_;
    std::uint32_t frame_ = 0;    // counts make()
    std::uint32_t urgency_ = 0;  // of the tile that it is at
    bool unfinished_ = false;    // something was made that cannot be sampled yet
    bool settled_ = true;
};

}  // namespace ridgeline::render
