// Literature: the circular grid with continuous level of detail (scheduling paper, 3.3); nested rings of
// doubling spacing on their own lattices (Losasso, Hoppe, "Geometry clipmaps", SIGGRAPH 2004). How we differ:
// rings are round and one mesh with fans where they meet, instead of squares joined by degenerate triangles;
// docs/disc.md.
#include "ridgeline/render/disc_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ridgeline/shaders/shared/disc_uniforms.h"

namespace ridgeline::render {
namespace {

// Cells of a square's side, of a block's.
constexpr int kSquare = 4;
constexpr int kBlock = 2;
// Blocks follow each other in strips so wide, so that a row's vertices are still there for the next row.
constexpr int kStrip = 8;

int floor_to(int value, int step) {
    return value >= 0 ? value / step * step : -((-value + step - 1) / step * step);
}

// The eye stands anywhere in the square at the centre; the disc is round about that square's middle.
bool in_disc(int radius, const glm::ivec2& cell) {
    const glm::ivec2 corner(floor_to(cell.x, kSquare), floor_to(cell.y, kSquare));
    const glm::ivec2 middle(kSquare / 2);
    const glm::ivec2 far = glm::max(glm::abs(corner - middle), glm::abs(corner + kSquare - middle));
    return far.x * far.x + far.y * far.y <= radius * radius;
}

class GridMaker {
  public:
    explicit GridMaker(int radius) : radius_(radius), side_(2 * half() + 1) {}

    DiscGrid make() {
        for (int y = -half(); y <= half(); ++y)
            for (int x = -half(); x <= half(); ++x)
                grid_.vertices.push_back({static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)});
        for (int hole = 0; hole < kRingHoles; ++hole)
            for (int sector = 0; sector < kRingSectors; ++sector)
                add_sector(static_cast<RingHole>(hole), sector);
        return std::move(grid_);
    }

  private:
    // All of the disc and a square more.
    int half() const { return radius_ / kSquare * kSquare + 2 * kSquare; }

    std::uint32_t vertex(const glm::ivec2& at) const {
        return static_cast<std::uint32_t>((at.y + half()) * side_ + at.x + half());
    }

    // The ring within, whose cells are half as large.
    bool in_hole(RingHole hole, const glm::ivec2& cell) const {
        if (hole == RingHole::full) return false;
        const int number = static_cast<int>(hole);
        const glm::ivec2 shift((number & 1) * kBlock, (number >> 1) * kBlock);
        return in_disc(radius_, 2 * (cell - shift));
    }

    static int sector_of(const glm::ivec2& block) {
        const double turn =
            std::atan2(block.y + 0.5 * kBlock, block.x + 0.5 * kBlock) / (2.0 * std::numbers::pi);
        return std::clamp(static_cast<int>((turn + 0.5) * kRingSectors), 0, kRingSectors - 1);
    }

    void add_sector(RingHole hole, int number) {
        RingSector& sector = grid_.sectors[static_cast<std::size_t>(hole)][static_cast<std::size_t>(number)];
        sector = {static_cast<std::uint32_t>(grid_.indices.size()), 0, glm::ivec2(half()),
                  glm::ivec2(-half())};
        for (int strip = -half(); strip < half(); strip += kStrip)
            for (int y = -half(); y < half(); y += kBlock)
                for (int x = strip; x < std::min(strip + kStrip, half()); x += kBlock)
                    add_block(hole, {x, y}, number, sector);
        sector.count = static_cast<std::uint32_t>(grid_.indices.size()) - sector.first;
    }

    void add_block(RingHole hole, const glm::ivec2& block, int number, RingSector& sector) {
        if (!in_disc(radius_, block) || in_hole(hole, block) || sector_of(block) != number) return;
        add_fan(block);
        sector.least = glm::min(sector.least, block);
        sector.most = glm::max(sector.most, block + kBlock);
    }

    // Rows count southwards: seen from above, counter-clockwise is north-western corner, south-western, ...
    void add_fan(const glm::ivec2& block) {
        const std::array<glm::ivec2, 4> corners = {block, block + glm::ivec2(0, kBlock), block + kBlock,
                                                   block + glm::ivec2(kBlock, 0)};
        const std::array<glm::ivec2, 4> beyond = {glm::ivec2(-kBlock, 0), glm::ivec2(0, kBlock),
                                                  glm::ivec2(kBlock, 0), glm::ivec2(0, -kBlock)};
        const glm::ivec2 middle = block + kBlock / 2;
        for (std::size_t side = 0; side < 4; ++side) {
            const glm::ivec2 from = corners[side], to = corners[(side + 1) % 4];
            if (!in_disc(radius_, block + beyond[side])) {
                add_triangle(middle, from, to);
                continue;
            }
            add_triangle(middle, from, (from + to) / 2);
            add_triangle(middle, (from + to) / 2, to);
        }
    }

    void add_triangle(const glm::ivec2& a, const glm::ivec2& b, const glm::ivec2& c) {
        for (const glm::ivec2& at : {a, b, c}) grid_.indices.push_back(vertex(at));
    }

    int radius_;
    int side_;
    DiscGrid grid_;
};

}  // namespace

DiscGrid make_disc_grid(int radius) { return GridMaker(radius).make(); }

glm::ivec2 ring_centre(const glm::ivec2& eye_cell, int ring) {
    return {floor_to(eye_cell.x >> ring, kSquare), floor_to(eye_cell.y >> ring, kSquare)};
}

RingHole ring_hole(const glm::ivec2& eye_cell, int ring, int innermost) {
    if (ring == innermost) return RingHole::full;
    const glm::ivec2 within = ring_centre(eye_cell, ring - 1) / 2 - ring_centre(eye_cell, ring);
    return static_cast<RingHole>((within.x != 0 ? 1 : 0) + (within.y != 0 ? 2 : 0));
}

DiscTriangle disc_triangle(int radius, const glm::ivec2& eye_cell, int innermost, const glm::dvec2& place) {
    constexpr int kOutermost = 24;
    DiscTriangle found;
    glm::ivec2 centre(0), block(0);
    glm::dvec2 in_ring(0.0);
    for (found.ring = innermost; found.ring <= kOutermost; ++found.ring) {
        centre = ring_centre(eye_cell, found.ring);
        in_ring = place / static_cast<double>(std::int64_t{1} << found.ring) - glm::dvec2(centre);
        block = glm::ivec2(glm::floor(in_ring / static_cast<double>(kBlock))) * kBlock;
        if (in_disc(radius, block)) break;
    }
    // From the block's middle, -1 to 1: the larger coordinate says the side, the other one where along it.
    const glm::dvec2 past = in_ring - glm::dvec2(block) - 1.0;
    const bool sideways = std::abs(past.x) >= std::abs(past.y);
    const double out = sideways ? past.x : past.y, along = sideways ? past.y : past.x;
    const int sign = out < 0.0 ? -1 : 1;
    const auto at = [&](int to, int way) {
        const glm::ivec2 offset = sideways ? glm::ivec2(to, way) : glm::ivec2(way, to);
        return (centre + block + 1 + offset) << found.ring;
    };
    const bool fan = in_disc(radius, block + kBlock * (sideways ? glm::ivec2(sign, 0) : glm::ivec2(0, sign)));
    const double reach = std::abs(out);
    if (fan) {
        const int turn = along < 0.0 ? -1 : 1;
        found.cells = {at(0, 0), at(sign, 0), at(sign, turn)};
        found.weights = {1.0 - reach, reach - std::abs(along), std::abs(along)};
        return found;
    }
    found.cells = {at(0, 0), at(sign, -1), at(sign, 1)};
    found.weights = {1.0 - reach, 0.5 * (reach - along), 0.5 * (reach + along)};
    return found;
}

RingRange ring_range(double above_ground, double reach) {
    const auto first_to_reach = [](double distance) {
        const double rings = std::log2(std::max(distance, 1.0) / static_cast<double>(shaders::kDiscMorphEnd));
        return std::clamp(static_cast<int>(std::ceil(rings)), 0, 24);
    };
    const int innermost = first_to_reach(above_ground);
    return {innermost, std::max(innermost, first_to_reach(reach))};
}

}  // namespace ridgeline::render
