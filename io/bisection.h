// The right-triangle bisection of one node, vertex by vertex, in an order that encoder and decoder share.
//
// Literature: restricted quadtree triangulations (Pajarola, "Large scale terrain visualization using the
// restricted quadtree triangulation", 1998) and triangle bintrees with neighbour links (Duchaineau et al.,
// "ROAMing terrain", 1997). Where ROAM keeps queues to refine a mesh from frame to frame, we refine once,
// breadth first: triangles are looked at in order of creation, so all of one level come before the next, and
// whether a pair (diamond) may split is known when its first triangle's turn comes. One question a diamond
// then describes the whole mesh.
//
// A node starts as its four quarters of four triangles each, so that corners, side midpoints, centre and
// quarter centres always exist, and no triangle touches more than one side of its quarter.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ridgeline/io/chunk.h"
#include "ridgeline/io/node_id.h"

namespace ridgeline::io {

class Bisection {
  public:
    struct Vertex {
        std::uint32_t x = 0, y = 0;  // finest samples from the node's corner
        // The ends of the hypotenuse that this vertex halves; itself at a corner.
        std::uint16_t ends[2] = {0, 0};
    };

    // Edges of a triangle: the hypotenuse (vertex 1 to 2), the legs (0 to 1) and (2 to 0).
    enum class Edge : std::uint8_t { hypotenuse, first_leg, second_leg, none };

    // Vertex 0 is the right angle; 0, 1, 2 run counter-clockwise seen from above, north up.
    struct Triangle {
        std::array<std::uint16_t, 3> vertex{};
        std::array<std::int32_t, 3> neighbour{-1, -1, -1};  // across hypotenuse, first leg, second leg
        std::int32_t first_child = -1;                      // its second is the next
        std::uint8_t quarter = 0;
        Side side{};                  // of the quarter, where side_edge is not none
        Edge side_edge = Edge::none;  // the edge that lies on that side
    };

    // Corner vertices in quarter order, then side midpoints in side order, centre, quarter centres.
    static constexpr std::uint16_t kFirstMidpoint = 4;
    static constexpr std::uint16_t kCentre = 8;
    static constexpr std::uint16_t kFirstQuarterCentre = 9;
    static constexpr std::uint16_t kFirstVertices = 13;
    static constexpr std::int32_t kFirstTriangles = 16;

    // extent: finest samples along the node's side.
    void begin(NodeId node, std::uint32_t extent);

    // Splits every diamond for which split(x, y) of its midpoint holds; asks once a diamond, in the shared
    // order. False, with the mesh unfinished, once more than kMaxChunkVertices vertices would exist.
    template <class Split>
    [[nodiscard]] bool refine(Split&& split) {
        for (std::int32_t t = 0; t < static_cast<std::int32_t>(triangles_.size()); ++t) {
            if (!may_split(t)) continue;
            const Triangle& triangle = triangles_[static_cast<std::size_t>(t)];
            const Vertex& a = vertices_[triangle.vertex[1]];
            const Vertex& b = vertices_[triangle.vertex[2]];
            if (((a.x + b.x) | (a.y + b.y)) & 1u) continue;
            if (!split((a.x + b.x) / 2, (a.y + b.y) / 2)) continue;
            if (vertices_.size() >= kMaxChunkVertices) return false;
            split_diamond(t);
        }
        return true;
    }

    // Calls leaf(triangle) for every triangle of the mesh along the Sierpinski curve, so that neighbours in
    // order share vertices.
    template <class Leaf>
    void for_each_leaf(Leaf&& leaf) const {
        for (std::int32_t t = 0; t < kFirstTriangles; ++t) visit(t, Direction::along, leaf);
    }

    const std::vector<Vertex>& vertices() const { return vertices_; }
    // Children after their parents; the first kFirstTriangles have none.
    const std::vector<Triangle>& triangles() const { return triangles_; }
    // Every split makes two triangles of one.
    std::size_t leaf_count() const { return (triangles_.size() + kFirstTriangles) / 2; }

  private:
    // Whether the curve runs from vertex 1 to 2 or back.
    enum class Direction { along, back };

    template <class Leaf>
    void visit(std::int32_t t, Direction direction, Leaf& leaf) const {
        const Triangle& triangle = triangles_[static_cast<std::size_t>(t)];
        if (triangle.first_child < 0) return leaf(triangle);
        const int first = direction == Direction::along ? 0 : 1;
        const auto turned = direction == Direction::along ? Direction::back : Direction::along;
        visit(triangle.first_child + first, turned, leaf);
        visit(triangle.first_child + 1 - first, turned, leaf);
    }

    bool may_split(std::int32_t t) const {
        const Triangle& triangle = triangles_[static_cast<std::size_t>(t)];
        if (triangle.first_child >= 0) return false;
        const std::int32_t base = triangle.neighbour[0];
        return base < 0 || triangles_[static_cast<std::size_t>(base)].neighbour[0] == t;
    }
    void split_diamond(std::int32_t t);
    std::int32_t split_triangle(std::int32_t t, std::uint16_t middle);
    void relink(std::int32_t neighbour, std::int32_t from, std::int32_t to);

    std::vector<Vertex> vertices_;
    std::vector<Triangle> triangles_;
};

}  // namespace ridgeline::io
