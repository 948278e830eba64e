// Grounds with some of their tiles, shapes at random, seen from somewhere: what the tests of the quadtree's
// cells try.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <random>
#include <vector>

#include "ridgeline/render/asked_block.h"
#include "ridgeline/render/quadtree_blocks.h"
#include "ridgeline/render/quadtree_lod.h"
#include "ridgeline/shaders/lib/quadtree_levels.h"
#include "ridgeline/shaders/lib/quadtree_shape.h"

namespace ridgeline::test {

using Random = std::mt19937;

inline int whole(Random& random, int from, int to) {
    return std::uniform_int_distribution<int>(from, to)(random);
}
inline float real(Random& random, float from, float to) {
    return std::uniform_real_distribution<float>(from, to)(random);
}

// A ground with some of its tiles, shapes at random, seen from somewhere.
struct LodScene {
    io::Grid grid;
    std::vector<render::SlottedTile> tiles;
    std::vector<shaders::QuadtreeShape> shapes;
    std::vector<float> fades;
    shaders::QuadtreeUniforms view{};
    render::QuadtreeBlocks blocks;
    render::QuadtreeLod lod;

    explicit LodScene(Random& random) : LodScene(random_grid(random), random) {}
    LodScene(const io::Grid& ground, Random& random) : grid(ground), blocks(grid, 400) {
        add_tiles(random);
        for (std::size_t i = 0; i < tiles.size(); ++i) shapes.push_back(random_shape(random));
        build();
        look(random);
        lod.run(view, blocks, shapes);
    }

    // All tiles with their own look.
    void build() {
        blocks.build(tiles);
        fades.assign(tiles.size(), 0.0f);
        blocks.fade(fades);
    }

    // Some of them, turning from the look of those above.
    void fade(Random& random) {
        for (float& fade : fades) fade = std::max(real(random, -0.5f, 1.0f), 0.0f);
        blocks.fade(fades);
    }

    static io::Grid random_grid(Random& random) {
        const int quads = std::array{32, 64, 128}[static_cast<std::size_t>(whole(random, 0, 2))];
        return {whole(random, 2, 1500), whole(random, 2, 1500), quads};
    }

    // Near a place most tiles, elsewhere few; coarse before fine.
    void add_tiles(Random& random) {
        std::vector<io::NodeId> level;
        for (int y = 0; y < grid.nodes_y(0); ++y)
            for (int x = 0; x < grid.nodes_x(0); ++x)
                if (whole(random, 0, 9) != 0 || tiles.empty()) add({0, x, y}, level);
        while (!level.empty()) {
            std::vector<io::NodeId> next;
            for (const io::NodeId node : level)
                for (int q = 0; q < io::kQuarters; ++q) {
                    const io::NodeId child = node.child(q);
                    if (node.level == grid.finest() || !grid.contains(child)) continue;
                    if (tiles.size() < 300 && whole(random, 0, 9) < 4) add(child, next);
                }
            level = std::move(next);
        }
    }
    void add(io::NodeId node, std::vector<io::NodeId>& level) {
        tiles.push_back({node, static_cast<std::uint32_t>(tiles.size())});
        level.push_back(node);
    }

    static shaders::QuadtreeShape random_shape(Random& random) {
        shaders::QuadtreeShape shape{};
        const int roughness = 1 << whole(random, 0, 12);
        for (int i = shaders::kShapeErrors - 1; i >= 0; --i) shape.error[i] = whole(random, 0, roughness);
        for (int i = 20; i >= 1; --i) {
            const int at = i >= 5 ? i - 5 : i - 1, side = i >= 5 ? 4 : 2;
            const int parent = i >= 5 ? 1 + at / side / 2 * 2 + at % side / 2 : 0;
            shape.error[parent] = std::max(shape.error[parent], shaders::coarser_error(shape.error[i]));
        }
        shape.least = whole(random, -1000, 1000);
        shape.most = shape.least + whole(random, 0, 5000);
        return shape;
    }

    void look(Random& random) {
        const int bits = std::countr_zero(static_cast<unsigned>(grid.quads())) - shaders::kQuadtreeDepth;
        view.eye_cell = {whole(random, 0, static_cast<int>(grid.width()) - 1),
                         whole(random, 0, static_cast<int>(grid.height()) - 1), whole(random, -100, 400),
                         bits};
        view.blocks = {blocks.place_bits(), grid.finest(), 0, shaders::kQuadtreeAnyLevel};
        view.eye_rest = {real(random, 0, 1), real(random, 0, 1), real(random, 0, 1),
                         real(random, 0.001f, 0.01f)};
        view.scale = {real(random, 0.5f, 40), real(random, 0.5f, 40), real(random, 10, 2000),
                      real(random, 0, 300)};
        for (auto& plane : view.planes) plane = {0, 0, 0, 1};
    }

    // By grid and roots alone: a root without a tile has no ground below it.
    bool has_ground(std::int64_t x, std::int64_t y) const {
        const std::int64_t extent = grid.extent(0);
        const io::NodeId root{0, static_cast<std::int32_t>(x / extent),
                              static_cast<std::int32_t>(y / extent)};
        return std::ranges::any_of(tiles, [&](const render::SlottedTile& tile) { return tile.node == root; });
    }
    // By block and entry, before balancing; of entries that their block does not draw 0, as in lod.levels().
    std::vector<int> asked_levels() const {
        std::vector<int> levels;
        for (const auto& block : blocks.blocks()) {
            const render::AskedBlock asked(lod, view, block);
            for (int e = 0; e < shaders::kQuadtreeEntries; ++e) {
                const glm::ivec2 place = shaders::entry_place(e);
                const bool drawn = shaders::has_entry(block, place);
                levels.push_back(drawn ? shaders::asked_level(view, block, asked.cell(place)) : 0);
            }
        }
        return levels;
    }
    int level_at(const glm::ivec2& sample) const {
        const auto entry = shaders::entry_of(lod, view, sample);
        return entry.block < 0
                   ? -1
                   : lod.level(entry.block * shaders::kQuadtreeEntries + shaders::entry_at(entry.place));
    }
};

}  // namespace ridgeline::test
