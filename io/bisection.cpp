#include "ridgeline/io/bisection.h"

namespace ridgeline::io {
namespace {

// The nine first points of a node on a 3x3 grid, row by row from the north-west, as vertex numbers.
constexpr std::uint16_t kPoint[3][3] = {{0, 6, 1}, {4, 8, 5}, {2, 7, 3}};

// The sides of a quarter counter-clockwise, each with the corners (column, row) it runs between.
struct QuarterSide {
    Side side;
    int from[2], to[2];
};
constexpr QuarterSide kQuarterSides[kSides] = {{Side::west, {0, 0}, {0, 1}},
                                               {Side::south, {0, 1}, {1, 1}},
                                               {Side::east, {1, 1}, {1, 0}},
                                               {Side::north, {1, 0}, {0, 0}}};

// The place in kQuarterSides of the triangle at a side.
constexpr int place_of(Side side) {
    constexpr int kPlace[kSides] = {0, 2, 3, 1};
    return kPlace[index(side)];
}

// The first triangle across a quarter's side, or -1 at the node's border.
std::int32_t across(int quarter, Side side) {
    if (inner_line(quarter, side) < 0) return -1;
    const int other = quarter ^ (side == Side::west || side == Side::east ? 1 : 2);
    return other * 4 + place_of(opposite(side));
}

}  // namespace

void Bisection::begin(NodeId node, std::uint32_t extent) {
    const std::uint32_t half = extent / 2, quarter = extent / 4;
    vertices_.assign(kFirstVertices, {});
    for (std::uint32_t row = 0; row < 3; ++row)
        for (std::uint32_t column = 0; column < 3; ++column) {
            const std::uint16_t v = kPoint[row][column];
            vertices_[v] = {column * half, row * half, {v, v}};
        }
    const auto set_ends = [&](std::uint16_t v, std::uint16_t a, std::uint16_t b) {
        vertices_[v].ends[0] = a;
        vertices_[v].ends[1] = b;
    };
    set_ends(kPoint[1][0], 0, 2), set_ends(kPoint[1][2], 1, 3);
    set_ends(kPoint[0][1], 0, 1), set_ends(kPoint[2][1], 2, 3);
    // The square's diagonal runs through its parent's centre.
    const bool main_diagonal = ((node.x ^ node.y) & 1) == 0;
    set_ends(kCentre, main_diagonal ? 0 : 1, main_diagonal ? 3 : 2);

    triangles_.assign(kFirstTriangles, {});
    for (int q = 0; q < kQuarters; ++q) {
        const int qx = q & 1, qy = q >> 1;
        const auto centre = static_cast<std::uint16_t>(kFirstQuarterCentre + q);
        vertices_[centre] = {quarter + static_cast<std::uint32_t>(qx) * half,
                             quarter + static_cast<std::uint32_t>(qy) * half,
                             {kCentre, static_cast<std::uint16_t>(q)}};
        for (int i = 0; i < kSides; ++i) {
            const QuarterSide& s = kQuarterSides[i];
            Triangle& t = triangles_[static_cast<std::size_t>(q * 4 + i)];
            t.vertex = {centre, kPoint[qy + s.from[1]][qx + s.from[0]], kPoint[qy + s.to[1]][qx + s.to[0]]};
            t.neighbour = {across(q, s.side), q * 4 + (i + 3) % 4, q * 4 + (i + 1) % 4};
            t.quarter = static_cast<std::uint8_t>(q);
            t.side = s.side;
            t.side_edge = Edge::hypotenuse;
        }
    }
}

void Bisection::split_diamond(std::int32_t t) {
    const Triangle triangle = triangles_[static_cast<std::size_t>(t)];
    const Vertex a = vertices_[triangle.vertex[1]], b = vertices_[triangle.vertex[2]];
    const auto middle = static_cast<std::uint16_t>(vertices_.size());
    vertices_.push_back({(a.x + b.x) / 2, (a.y + b.y) / 2, {triangle.vertex[1], triangle.vertex[2]}});

    const std::int32_t children = split_triangle(t, middle);
    const std::int32_t partner = triangle.neighbour[0];
    if (partner < 0) return;
    const std::int32_t partners = split_triangle(partner, middle);
    const auto at = [&](std::int32_t i) -> Triangle& { return triangles_[static_cast<std::size_t>(i)]; };
    at(children).neighbour[2] = partners + 1;
    at(children + 1).neighbour[1] = partners;
    at(partners).neighbour[2] = children + 1;
    at(partners + 1).neighbour[1] = children;
}

// Fields are written in place, one by one: a child put together first and copied as a whole would wait for
// its own narrow stores (a third of the time went there).
std::int32_t Bisection::split_triangle(std::int32_t t, std::uint16_t middle) {
    const auto first = static_cast<std::int32_t>(triangles_.size());
    triangles_.resize(triangles_.size() + 2);
    Triangle& parent = triangles_[static_cast<std::size_t>(t)];
    const auto fill = [&](Triangle& child, int leg, std::uint16_t from, std::uint16_t to) {
        child.vertex[0] = middle;
        child.vertex[1] = from;
        child.vertex[2] = to;
        child.neighbour[0] = parent.neighbour[static_cast<std::size_t>(leg)];
        child.quarter = parent.quarter;
        child.side = parent.side;
        if (parent.side_edge == static_cast<Edge>(leg)) child.side_edge = Edge::hypotenuse;
    };
    Triangle& a = triangles_[static_cast<std::size_t>(first)];
    Triangle& b = triangles_[static_cast<std::size_t>(first) + 1];
    fill(a, 1, parent.vertex[0], parent.vertex[1]);
    fill(b, 2, parent.vertex[2], parent.vertex[0]);
    a.neighbour[1] = first + 1;
    b.neighbour[2] = first;
    if (parent.side_edge == Edge::hypotenuse) {
        a.side_edge = Edge::second_leg;
        b.side_edge = Edge::first_leg;
    }
    parent.first_child = first;
    relink(a.neighbour[0], t, first);
    relink(b.neighbour[0], t, first + 1);
    return first;
}

void Bisection::relink(std::int32_t neighbour, std::int32_t from, std::int32_t to) {
    if (neighbour < 0) return;
    for (std::int32_t& link : triangles_[static_cast<std::size_t>(neighbour)].neighbour)
        if (link == from) link = to;
}

}  // namespace ridgeline::io
