// Which missing nodes a frame takes to be hidden before it knows: those that were hidden in the frame before.
// Internal to the room; one owner, one thread.
//
// What is hidden follows from what is drawn, and what is drawn from what is there or hidden. The circle is
// cut here: the drawn tree grows with an assumption, the horizon proves it or not. What it disproves is
// revealed: not assumed again, and wanted, until its data has come or it has left the picture; or else it
// would come and go by turns.
#pragma once

#include <utility>

#include "ridgeline/select/frame_tree.h"

namespace ridgeline::select {

class AssumedHidden {
  public:
    explicit AssumedHidden(std::int64_t node_count) : now_(node_count), next_(node_count) {
        now_.begin_frame();
    }

    bool holds(NodeIndex index) const { return now_.flags_of(index) == kHidden; }
    bool revealed(NodeIndex index) const { return now_.has(index, kRevealed); }
    void reveal(NodeIndex index) { now_.add(index, kRevealed); }

    // What the next frame shall know: begin, add node by node, finish.
    void begin_next() { next_.begin_frame(); }
    void add_hidden(NodeIndex index) { next_.add(index, kHidden); }
    void keep_revealed(NodeIndex index) { next_.add(index, kRevealed); }
    void finish_next() { std::swap(now_, next_); }

  private:
    static constexpr unsigned kHidden = 1, kRevealed = 2;

    FrameTree now_, next_;
};

}  // namespace ridgeline::select
