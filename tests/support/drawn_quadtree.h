// The quadtree's surface exactly as a frame drew it: levels read back from the GPU, triangles as the vertex shader has them.
// What the walk itself knows of it is the highest that it may be.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "ridgeline/app/walk/stage.h"
#include "ridgeline/render/quadtree_patch.h"
#include "ridgeline/shaders/lib/disc.h"
#include "ridgeline/shaders/lib/quadtree.h"
#include "ridgeline/shaders/lib/quadtree_vertex.h"

namespace ridgeline::test {

class DrawnQuadtree {
  public:
    // Of the stage's last frame, with levels from the GPU; until the next one.
    explicit DrawnQuadtree(const app::TerrainStage& stage)
        : stage_(stage),
          info_(stage.frame().sampled_info()),
          quadtree_(stage.frame().quadtree()),
          look_(stage.frame().disc_look(stage.pager())),
          cells_(quadtree_.read_cells()),
          quads_(1 << quadtree_.uniforms().eye_cell.w),
          patch_(render::quadtree_patch(quads_)) {}

    // Metres over the eye, with exaggeration; nothing outside the raster.
    std::optional<double> height_m(const glm::dvec2& east_north_m) {
        const glm::dvec2 place = info_.lattice(east_north_m.x, east_north_m.y);
        const glm::dvec2 most(static_cast<double>(info_.width - 1), static_cast<double>(info_.height - 1));
        if (!(place.x >= 0.0 && place.y >= 0.0 && place.x <= most.x && place.y <= most.y)) return {};
        const auto entry =
            shaders::entry_of(*this, quadtree_.uniforms(), glm::ivec2(glm::min(place, most - 1.0)));
        if (entry.block < 0) return {};
        for (const Triangle& triangle : triangles(entry, place))
            if (const auto quanta = triangle.quanta(place)) {
                const select::EyeFrame& eye = stage_.frame().sampled_eye();
                return (*quanta - static_cast<double>(eye.quanta_rest)) * static_cast<double>(eye.quantum_m);
            }
        return {};
    }

    // As shaders/lib/quadtree.h asks for them.
    const shaders::QuadtreeBlock& block(int i) const {
        return quadtree_.blocks().blocks()[static_cast<std::size_t>(i)];
    }
    const shaders::QuadtreePlace& place(std::uint32_t i) const { return quadtree_.blocks().places()[i]; }
    int level(int i) const { return cells_[static_cast<std::size_t>(i)].level; }
    int lod(int i) const { return cells_[static_cast<std::size_t>(i)].lod; }

  private:
    struct Triangle {
        std::array<glm::dvec2, 3> at;
        std::array<double, 3> height;

        std::optional<double> quanta(const glm::dvec2& place) const {
            constexpr double kSlack = 1e-9;
            const glm::dvec2 a = at[1] - at[0], b = at[2] - at[0], p = place - at[0];
            const double area = a.x * b.y - a.y * b.x;
            if (area == 0.0) return {};
            const double u = (p.x * b.y - p.y * b.x) / area, v = (a.x * p.y - a.y * p.x) / area;
            if (u < -kSlack || v < -kSlack || u + v > 1.0 + kSlack) return {};
            return height[0] + u * (height[1] - height[0]) + v * (height[2] - height[0]);
        }
    };

    const std::vector<Triangle>& triangles(const shaders::QuadtreeEntry& entry, const glm::dvec2& place) {
        const int at = entry.block * shaders::kQuadtreeEntries + shaders::entry_at(entry.place);
        const int shift = shaders::cell_shift(quadtree_.uniforms(), level(at));
        const glm::ivec2 sample = glm::min(
            glm::ivec2(place), glm::ivec2(static_cast<int>(info_.width), static_cast<int>(info_.height)) - 2);
        const glm::ivec2 corner((sample.x >> shift) << shift, (sample.y >> shift) << shift);
        auto& known = known_[{corner.x, corner.y}];
        if (known.empty())
            known = made(shaders::instance_of(*this, quadtree_.uniforms(), corner, level(at), lod(at)));
        return known;
    }

    std::vector<Triangle> made(const shaders::QuadtreeInstance& cell) const {
        std::vector<Triangle> triangles;
        for (std::size_t i = 0; i < patch_.size(); i += 3) {
            Triangle triangle;
            for (std::size_t c = 0; c < 3; ++c) {
                const int at = patch_[i + c];
                const auto vertex =
                    shaders::quadtree_vertex(cell, {at % (quads_ + 1), at / (quads_ + 1)}, quads_);
                triangle.at[c] = glm::dvec2(vertex.cell);
                triangle.height[c] = static_cast<double>(shaders::twice_turned_height(
                    look_, stage_.frame().heights_uniforms(), vertex.cell, vertex.level, vertex.turned,
                    stage_.frame().sampled_eye().quanta));
            }
            triangles.push_back(triangle);
        }
        return triangles;
    }

    const app::TerrainStage& stage_;
    const io::TerrainInfo& info_;
    const render::QuadtreeSurface& quadtree_;
    render::DiscLook look_;
    std::vector<shaders::QuadtreeCell> cells_;
    int quads_;
    std::vector<std::uint16_t> patch_;
    std::map<std::pair<int, int>, std::vector<Triangle>> known_;
};

}  // namespace ridgeline::test
