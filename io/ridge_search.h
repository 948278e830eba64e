// The way along a band that a silhouette should take: one place across per step, found by dynamic
// programming.
//
// Every step of a chain is a straight segment; its worth is how high it stands once it is lowered to lie
// under the ground. The chain of greatest worth is the ridge, where there is one (horizon paper 3.2, without
// its cones). Working memory; one a thread.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ridgeline/io/relief_lattice.h"

namespace ridgeline::io {

class RidgeSearch {
  public:
    struct Segment {
        int along = 0;  // the column, for chains that run east, at which it begins
        int from = 0, to = 0;
    };
    // Whether there is ground all along a segment; empty: always.
    using Ground = std::function<bool(const Segment&)>;

    // heights: of the lattice, quads + 1 along of quads + 1 across each, relative to the node's lowest.
    // Finds the chains of all bands of an axis.
    void find(const ReliefShape& shape, int quads, std::span<const float> heights, const Ground& ground);

    // Where band's chain stands at each of its steps + 1 vertices; kNowhere where there is no ground.
    static constexpr int kNowhere = -1;
    std::span<const int> chain(int band) const {
        const auto vertices = static_cast<std::size_t>(shape_.steps) + 1;
        return std::span(places_).subspan(static_cast<std::size_t>(band) * vertices, vertices);
    }

  private:
    // Worths of all segments of one step, by drift and place of departure.
    void weigh_step(int step, std::span<const float> heights, const Ground& ground);
    void weigh_drift(int step, int drift, std::span<const float> heights);
    // The best way to each place of a band after one more step.
    void advance(int step, int band);
    void trace_back(int band);
    float worth(int drift, int from) const {
        return worths_[static_cast<std::size_t>((drift + most_drift_) * stride_ + from)];
    }

    // By band, place within the band and nowhere last.
    struct Way {
        std::vector<float> worth, next;
        std::vector<std::uint8_t> came_from;  // steps * (places + 1)
    };

    ReliefShape shape_;
    int quads_ = 0, stride_ = 0, segment_quads_ = 0, most_drift_ = 0;
    bool voids_ = false;
    float ground_worth_ = 0.0f;
    std::vector<float> worths_, sunk_;
    std::vector<Way> ways_;
    std::vector<int> places_;
};

}  // namespace ridgeline::io
