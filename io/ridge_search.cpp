// Literature: the horizon paper (3.2) picks silhouette vertices by height and cone; FINDINGS' prototype
// showed that chains free within their band, found by dynamic programming, hide 3 % more than straight rows.
// The worth of a segment looks at the ground at every lattice column that it crosses; what lies between is
// for the exact check afterwards (relief_maker.cpp).
#include "ridgeline/io/ridge_search.h"

#include <algorithm>
#include <limits>

namespace ridgeline::io {
namespace {

constexpr float kNoGround = -std::numeric_limits<float>::infinity();
// Steeper segments cover too few columns to be worth looking at.
constexpr int kMostSlope = 2;

}  // namespace

void RidgeSearch::find(const ReliefShape& shape, int quads, std::span<const float> heights,
                       const Ground& ground) {
    shape_ = shape;
    quads_ = quads;
    stride_ = quads + 1;
    segment_quads_ = quads / shape.steps;
    int most_places = 0;
    for (int band = 0; band < shape.bands; ++band)
        most_places = std::max(most_places, band_range(shape, quads, band).count());
    most_drift_ = std::min(kMostSlope * segment_quads_, most_places - 1);
    voids_ = static_cast<bool>(ground);
    // Any ground is worth more than the height of any other, however far it sinks.
    ground_worth_ = 1.0f + 4.0f * *std::max_element(heights.begin(), heights.end());
    ways_.resize(static_cast<std::size_t>(shape.bands));
    for (int band = 0; band < shape.bands; ++band) {
        const auto places = static_cast<std::size_t>(band_range(shape, quads, band).count()) + 1;
        Way& way = ways_[static_cast<std::size_t>(band)];
        way.worth.assign(places, 0.0f);
        way.next.resize(places);
        way.came_from.resize(places * static_cast<std::size_t>(shape.steps));
    }
    for (int step = 0; step < shape.steps; ++step) {
        weigh_step(step, heights, ground);
        for (int band = 0; band < shape.bands; ++band) advance(step, band);
    }
    places_.resize(static_cast<std::size_t>(shape.bands) * (static_cast<std::size_t>(shape.steps) + 1));
    for (int band = 0; band < shape.bands; ++band) trace_back(band);
}

void RidgeSearch::weigh_step(int step, std::span<const float> heights, const Ground& ground) {
    worths_.resize(static_cast<std::size_t>((2 * most_drift_ + 1) * stride_));
    sunk_.resize(static_cast<std::size_t>(stride_));
    for (int drift = -most_drift_; drift <= most_drift_; ++drift) {
        weigh_drift(step, drift, heights);
        if (!voids_) continue;
        for (int from = std::max(0, -drift); from <= quads_ - std::max(0, drift); ++from) {
            float& worth = worths_[static_cast<std::size_t>((drift + most_drift_) * stride_ + from)];
            worth = ground({step * segment_quads_, from, from + drift}) ? worth + ground_worth_ : kNoGround;
        }
    }
}

// The mean height of the line between the ground at both ends, less what it must sink to lie under the ground
// at the columns between.
void RidgeSearch::weigh_drift(int step, int drift, std::span<const float> heights) {
    const int first = std::max(0, -drift), count = stride_ - (drift < 0 ? -drift : drift);
    const auto column = [&](int k) {
        return heights.data() + static_cast<std::ptrdiff_t>(step * segment_quads_ + k) * stride_ + first;
    };
    const float *from = column(0), *to = column(segment_quads_) + drift;
    float* sunk = sunk_.data();
    std::fill_n(sunk, count, 0.0f);
    for (int k = 1; k < segment_quads_; ++k) {
        const float t = static_cast<float>(k) / static_cast<float>(segment_quads_);
        const int whole = drift * k >= 0 ? drift * k / segment_quads_
                                         : -((-drift * k + segment_quads_ - 1) / segment_quads_);
        const float part =
            static_cast<float>(drift * k - whole * segment_quads_) / static_cast<float>(segment_quads_);
        const float* here = column(k) + whole;
        const std::ptrdiff_t next = part > 0.0f ? 1 : 0;
        for (int i = 0; i < count; ++i) {
            const float line = from[i] + t * (to[i] - from[i]);
            const float ground = here[i] + part * (here[i + next] - here[i]);
            sunk[i] = std::max(sunk[i], line - ground);
        }
    }
    float* worth = worths_.data() + static_cast<std::ptrdiff_t>(drift + most_drift_) * stride_ + first;
    for (int i = 0; i < count; ++i) worth[i] = 0.5f * (from[i] + to[i]) - sunk[i];
}

void RidgeSearch::advance(int step, int band) {
    const LatticeRange range = band_range(shape_, quads_, band);
    Way& way = ways_[static_cast<std::size_t>(band)];
    const int nowhere = range.count();
    std::uint8_t* came_from = &way.came_from[static_cast<std::size_t>(step) * way.worth.size()];
    for (int to = 0; to < nowhere; ++to) {
        float best = kNoGround;
        int best_from = nowhere;
        const int first = std::max(0, to - most_drift_), last = std::min(nowhere - 1, to + most_drift_);
        for (int from = first; from <= last; ++from) {
            const float sum =
                way.worth[static_cast<std::size_t>(from)] + worth(to - from, range.first + from);
            if (sum > best) best = sum, best_from = from;
        }
        if (voids_ && way.worth[static_cast<std::size_t>(nowhere)] > best)
            best = way.worth[static_cast<std::size_t>(nowhere)], best_from = nowhere;
        way.next[static_cast<std::size_t>(to)] = best;
        came_from[to] = static_cast<std::uint8_t>(best_from);
    }
    const auto best = std::max_element(way.worth.begin(), way.worth.end());
    way.next[static_cast<std::size_t>(nowhere)] = *best;
    came_from[nowhere] = static_cast<std::uint8_t>(best - way.worth.begin());
    way.worth.swap(way.next);
}

void RidgeSearch::trace_back(int band) {
    const LatticeRange range = band_range(shape_, quads_, band);
    const Way& way = ways_[static_cast<std::size_t>(band)];
    const int nowhere = range.count();
    int* places = &places_[static_cast<std::size_t>(band * (shape_.steps + 1))];
    const auto last = way.worth.end() - (voids_ ? 0 : 1);
    auto place = static_cast<int>(std::max_element(way.worth.begin(), last) - way.worth.begin());
    for (int vertex = shape_.steps; vertex >= 0; --vertex) {
        places[vertex] = place == nowhere ? kNowhere : range.first + place;
        if (vertex > 0)
            place = way.came_from[static_cast<std::size_t>(vertex - 1) * way.worth.size() +
                                  static_cast<std::size_t>(place)];
    }
}

}  // namespace ridgeline::io
