// The six lines along which a chunk's quarters end (four sides, two inner lines), their segments, and the fan
// vertices that the next finer level puts on each segment. Shared by encoder and decoder.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/io/bisection.h"

namespace ridgeline::io {

class ChunkSides {
  public:
    // Sides in side order, then the north-south line and the west-east line through the centre.
    static constexpr int kLines = 6;

    struct Point {
        std::uint32_t along = 0;  // row on a north-south line, column on a west-east one
        std::uint16_t vertex = 0;
    };

    // Collects the vertices on each line, in order.
    void begin(const std::vector<Bisection::Vertex>& vertices, std::uint32_t extent);

    // Bisects every segment of every line as far as ask(x, y) says; the order is shared by encoder and
    // decoder.
    template <class Ask>
    void find_fans(Ask&& ask) {
        fans_.clear();
        for (int line = 0; line < kLines; ++line) {
            const auto& points = points_[static_cast<std::size_t>(line)];
            auto& starts = fan_starts_[static_cast<std::size_t>(line)];
            starts.clear();
            for (std::size_t i = 0; i + 1 < points.size(); ++i) {
                starts.push_back(static_cast<std::uint32_t>(fans_.size()));
                bisect(line, points[i].along, points[i + 1].along, ask);
            }
            starts.push_back(static_cast<std::uint32_t>(fans_.size()));
        }
    }

    std::span<const Point> points(int line) const { return points_[static_cast<std::size_t>(line)]; }
    // All fan vertices, positions along their lines; those of one segment lie together, ascending.
    std::span<const std::uint32_t> fans() const { return fans_; }
    // The first fan vertex of a segment; that of segment+1 ends it.
    std::uint32_t fan_start(int line, std::size_t segment) const {
        return fan_starts_[static_cast<std::size_t>(line)][segment];
    }
    // The segment of a line that starts at `along`.
    std::size_t segment_at(int line, std::uint32_t along) const;

    std::array<std::uint32_t, 2> position(int line, std::uint32_t along) const {
        return runs_south(line) ? std::array{fixed_[static_cast<std::size_t>(line)], along}
                                : std::array{along, fixed_[static_cast<std::size_t>(line)]};
    }
    static bool runs_south(int line) { return line < 2 || line == 4; }
    // The line on which a quarter's side lies.
    static int line_of(int quarter, Side side) {
        const int inner = inner_line(quarter, side);
        return inner < 0 ? index(side) : inner < 2 ? 4 : 5;
    }

  private:
    template <class Ask>
    void bisect(int line, std::uint32_t from, std::uint32_t to, Ask& ask) {
        if (to - from < 2) return;
        const std::uint32_t middle = (from + to) / 2;
        const auto [x, y] = position(line, middle);
        if (!ask(x, y)) return;
        bisect(line, from, middle, ask);
        fans_.push_back(middle);
        bisect(line, middle, to, ask);
    }

    std::array<std::uint32_t, kLines> fixed_{};
    std::array<std::vector<Point>, kLines> points_;
    std::array<std::vector<std::uint32_t>, kLines> fan_starts_;
    std::vector<std::uint32_t> fans_;
};

}  // namespace ridgeline::io
