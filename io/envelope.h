// The lowest and the highest that a chunk's drawn surface can get, at any place and in any morph state.
//
// Every vertex lies between its own height and the parent's surface there, each at a weight of its own; so
// the lower envelope is the chunk's triangulation with every vertex at the lesser of the two, the upper one
// with every vertex at the greater. (Under both surfaces is not low enough: where they cross, an edge between
// a vertex of one and a vertex of the other lies under both.) Fans add vertices on the sides' edges, rounded
// to the quantum, so up to half a quantum beside the envelopes; along() and fan_rise() allow for it.
//
// Working memory, reused from chunk to chunk; one a thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/io/chunk_state.h"
#include "ridgeline/io/grid.h"

namespace ridgeline::io {

class Envelope {
  public:
    // chunk: as encode_chunk leaves it; must outlive the calls below.
    void begin(const Grid& grid, NodeId node, const ChunkScratch::State& chunk);

    std::int32_t lower(std::size_t vertex) const { return lower_[vertex]; }
    std::int32_t upper(std::size_t vertex) const { return upper_[vertex]; }
    // Exactly, at the points of the lattice of the node's level: quads + 1 rows of as many.
    std::span<const double> lower_lattice() const { return lower_lattice_; }
    std::span<const double> upper_lattice() const { return upper_lattice_; }
    // How far fans may reach over the upper envelope.
    double fan_rise() const { return fans_ ? kFanOffset : 0.0; }

    // A straight line over the node, in lattice steps from its corner; within one quarter.
    struct Line {
        int from_x = 0, from_y = 0, to_x = 0, to_y = 0;
    };
    struct Point {
        double along = 0.0;  // 0 at the line's start, 1 at its end
        double quanta = 0.0;
    };
    // The lower envelope along a line, fans included: it runs straight, or higher, between these points.
    void trace(const Line& line, std::vector<Point>& points) const;

  private:
    static constexpr double kFanOffset = 0.5;
    // No height: those are within 2^29 quanta.
    static constexpr double kUnset = 1e300;

    // The same line in finest samples, for the triangles.
    struct Ray {
        double x = 0.0, y = 0.0, dx = 0.0, dy = 0.0;
    };
    struct Piece {
        std::int32_t triangle;
        double from, to;  // of the line
    };
    void fill_lattices();
    void fill_between(std::ptrdiff_t at, std::ptrdiff_t to_end) {
        double &low = lower_lattice_[static_cast<std::size_t>(at)],
               &high = upper_lattice_[static_cast<std::size_t>(at)];
        const bool unset = low == kUnset;
        const auto a = static_cast<std::size_t>(at - to_end), b = static_cast<std::size_t>(at + to_end);
        const double low_mean = 0.5 * (lower_lattice_[a] + lower_lattice_[b]);
        const double high_mean = 0.5 * (upper_lattice_[a] + upper_lattice_[b]);
        low = unset ? low_mean : low;
        high = unset ? high_mean : high;
    }
    // Where lattice and samples are one, triangles need not be looked for.
    void trace_samples(const Line& line, std::vector<Point>& points) const;
    void trace_cell(const Line& line, double from, double to, std::vector<Point>& points) const;
    void trace_triangles(const Line& line, std::vector<Point>& points) const;
    void trace_leaf(const Bisection::Triangle& triangle, const Ray& ray, double from, double to,
                    std::vector<Point>& points) const;
    void descend(const Piece& piece, const Ray& ray, std::vector<Point>& points) const;

    const ChunkScratch::State* chunk_ = nullptr;
    std::uint32_t extent_ = 0, step_ = 1;
    int quads_ = 0;
    bool fans_ = false;
    std::vector<std::int32_t> lower_, upper_;
    std::vector<double> lower_lattice_, upper_lattice_;
};

}  // namespace ridgeline::io
