// A small random terrain with everything that selection and its properties need, made in memory by the slow
// exact rules: heights, restricted-quadtree vertex sets of every level, their surfaces, records, decoded
// chunks.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "ridgeline/io/chunk.h"
#include "ridgeline/io/grid.h"
#include "ridgeline/io/heights_tile.h"
#include "ridgeline/io/node_record.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/select/drawn_surface.h"
#include "ridgeline/select/ground_source.h"
#include "ridgeline/select/selection.h"

namespace ridgeline::test {

using Random = std::mt19937_64;
inline double uniform(Random& random, double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
}
inline int whole(Random& random, int from, int to) {
    return std::uniform_int_distribution<int>(from, to)(random);
}

struct SceneShape {
    std::int64_t width = 300;  // samples
    std::int64_t height = 180;
    int quads = 32;
    std::uint64_t seed = 1;
    // Share of the finest nodes without data.
    double nodata_share = 0.0;
    // Rectangles of invalid cells, most of them small.
    int voids = 0;
    // Vertices of an average node besides those that every node has. Few make even midpoints of sides morph.
    std::size_t vertices_per_node = 250;
    // How much higher than usual the mountains are.
    double relief = 1.0;
};

class Scene {
  public:
    explicit Scene(const SceneShape& shape);
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    const io::TerrainInfo& info() const { return info_; }
    const io::Grid& grid() const { return grid_; }
    std::span<const io::NodeRecord> records() const { return records_; }
    const io::ChunkView& chunk(select::NodeIndex index) const { return chunks_[index]; }

    // Valid where make_voids() left it.
    io::HeightsTile heights_tile(io::NodeId node) const;
    // Whether the fragments of a level's cell are drawn; place of its north-western corner.
    bool cell_valid(std::int64_t x, std::int64_t y, int level) const;

    std::span<const std::uint8_t> payload(select::NodeIndex index) const { return payloads_[index]; }

    // Samples of the padded lattice; beyond the raster the nearest one repeats.
    std::int32_t quanta(std::int64_t x, std::int64_t y) const;
    bool in_level(std::int64_t x, std::int64_t y, int level) const;
    // The unmorphed surface of a level at any lattice point, quanta.
    double surface(std::int64_t x, std::int64_t y, int level) const {
        return surfaces_[static_cast<std::size_t>(level)][at(x, y)];
    }

  private:
    std::size_t at(std::int64_t x, std::int64_t y) const {
        return static_cast<std::size_t>(y * (columns_ + 1) + x);
    }
    void make_heights(Random& random, double relief);
    void make_voids(Random& random, int count);
    void find_errors();
    void find_thresholds(std::size_t vertices_per_node);
    void find_surfaces();
    void choose_nodata(Random& random, double share);
    void describe(io::NodeId node);
    void make_chunks();

    io::TerrainInfo info_;
    io::Grid grid_;
    std::int64_t columns_ = 0, rows_ = 0;  // of the padded lattice, in cells
    std::vector<std::int32_t> quanta_;
    std::vector<std::uint8_t> valid_;  // of finest cells, by north-western corner
    std::vector<double> errors_;       // propagated
    std::vector<double> thresholds_;
    std::vector<std::vector<double>> surfaces_;
    std::vector<io::NodeRecord> records_;
    std::vector<std::vector<std::uint8_t>> payloads_;
    std::vector<std::vector<io::ChunkVertex>> blocks_;
    std::vector<io::ChunkView> chunks_;
};

// The scene's chunks, as selection reads them.
class SceneGround final : public select::GroundSource {
  public:
    explicit SceneGround(const Scene& scene) : scene_(scene) {}
    io::ChunkView chunk(std::uint32_t index) const override { return scene_.chunk(index); }

  private:
    const Scene& scene_;
};

// A camera somewhere over or beside the terrain, looking anywhere; tolerances from coarse to as fine as it
// gets.
select::View random_view(const Scene& scene, Random& random);
// Sees and wants everything.
select::View view_of_all(const Scene& scene, Random& random);

// Random nodes with their ancestors; level 0 always; some of them fading.
std::vector<io::NodeResidency> random_residency(const Scene& scene, Random& random);
std::vector<io::NodeResidency> all_resident(const Scene& scene);

// A drawn quarter and the lattice square that it covers.
struct Unit {
    const select::DrawEntry* entry = nullptr;
    int quarter = 0;
    std::int64_t x = 0, y = 0, side = 0;
};
std::vector<Unit> units_of(const Scene& scene, std::span<const select::DrawEntry> draws);

}  // namespace ridgeline::test
