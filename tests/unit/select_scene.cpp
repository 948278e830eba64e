#include "unit/select_scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "ridgeline/base/contract.h"
#include "ridgeline/io/chunk_codec.h"
#include "ridgeline/io/relief_maker.h"

namespace ridgeline::test {
namespace {

using io::Grid;
using io::LatticePoint;
using io::NodeId;

constexpr std::int64_t kNoScale = std::int64_t{1} << 40;

std::int64_t low_bit(std::int64_t v) { return v == 0 ? kNoScale : v & -v; }

// A lattice point of the bisection hierarchy: its scale, whether it is a square's centre, its hypotenuse's
// ends.
struct Place {
    std::int64_t scale = 0;
    bool centre = false;
    LatticePoint a, b;
};
Place place_of(std::int64_t x, std::int64_t y) {
    Place p;
    const std::int64_t bx = low_bit(x), by = low_bit(y);
    p.scale = std::min(bx, by);
    p.centre = bx == by;
    const std::int64_t s = p.scale;
    if (p.centre) {
        const std::int64_t u = (x / s) % 4 == 1 ? s : -s, v = (y / s) % 4 == 1 ? s : -s;
        p.a = {x + u, y + v};
        p.b = {x - u, y - v};
    } else if (bx < by) {
        p.a = {x - s, y};
        p.b = {x + s, y};
    } else {
        p.a = {x, y - s};
        p.b = {x, y + s};
    }
    return p;
}

std::int32_t rounded(double quanta) { return static_cast<std::int32_t>(std::floor(quanta + 0.5)); }

class NodeSource final : public io::ChunkSource {
  public:
    NodeSource(const Scene& scene, NodeId node)
        : scene_(scene), node_(node), origin_(scene.grid().origin(node)) {}
    std::int32_t quanta(std::int64_t x, std::int64_t y) const override {
        return scene_.quanta(origin_.x + x, origin_.y + y);
    }
    bool in_level(std::int64_t x, std::int64_t y, int relative) const override {
        return scene_.in_level(origin_.x + x, origin_.y + y, node_.level - relative);
    }

  private:
    const Scene& scene_;
    NodeId node_;
    LatticePoint origin_;
};

}  // namespace

Scene::Scene(const SceneShape& shape) : grid_(shape.width, shape.height, shape.quads) {
    Random random(shape.seed);
    info_.width = shape.width;
    info_.height = shape.height;
    info_.tile = shape.quads + 1;
    info_.west_m = 300000.25;
    info_.north_m = 2700000.5;
    info_.spacing_x_m = 20.0;
    info_.spacing_y_m = 27.25;
    info_.quantum_m = 0.25;
    info_.height_offset_m = -10.0;
    columns_ = grid_.nodes_x(0) * grid_.extent(0);
    rows_ = grid_.nodes_y(0) * grid_.extent(0);
    make_heights(random, shape.relief);
    find_errors();
    find_thresholds(shape.vertices_per_node);
    for (const double threshold : thresholds_) info_.thresholds_m.push_back(threshold * info_.quantum_m);
    find_surfaces();
    records_.resize(static_cast<std::size_t>(grid_.node_count()));
    choose_nodata(random, shape.nodata_share);
    make_voids(random, shape.voids);
    for (std::int64_t i = grid_.node_count() - 1; i >= 0; --i) describe(grid_.node_at(i));
    make_chunks();
}

std::int32_t Scene::quanta(std::int64_t x, std::int64_t y) const {
    return quanta_[at(std::clamp<std::int64_t>(x, 0, info_.width - 1),
                      std::clamp<std::int64_t>(y, 0, info_.height - 1))];
}

bool Scene::in_level(std::int64_t x, std::int64_t y, int level) const {
    const Place p = place_of(x, y);
    const std::int64_t extent = grid_.extent(level);
    if (p.scale >= extent / 2 || (p.centre && p.scale == extent / 4)) return true;
    return errors_[at(x, y)] > thresholds_[static_cast<std::size_t>(level)];
}

// Waves of falling height and length, a fault, noise and a lake: rough places next to smooth and flat ones.
void Scene::make_heights(Random& random, double relief) {
    quanta_.assign(static_cast<std::size_t>((columns_ + 1) * (rows_ + 1)), 0);
    std::vector<std::array<double, 4>> waves;
    for (double length = 200.0; length > 3.0; length *= 0.6)
        waves.push_back({uniform(random, -6.3, 6.3) / length, uniform(random, -6.3, 6.3) / length,
                         uniform(random, 0.0, 6.3), length * uniform(random, 2.0, 5.0) * relief});
    const double fault = uniform(random, 0.2, 0.8) * static_cast<double>(info_.width);
    double low = 1e9, high = -1e9;
    for (std::int64_t y = 0; y <= rows_; ++y)
        for (std::int64_t x = 0; x <= columns_; ++x) {
            const auto fx = static_cast<double>(x), fy = static_cast<double>(y);
            double height = fx > fault ? 300.0 : 0.0;
            const double rough = std::clamp(3.0 * fx / fault - 1.5, 0.0, 1.0);
            for (const auto& w : waves)
                height += (w[3] > 200.0 ? 1.0 : rough) * w[3] * std::sin(w[0] * fx + w[1] * fy + w[2]);
            height = std::max(height + rough * uniform(random, -8.0, 8.0), -150.0);
            quanta_[at(x, y)] = static_cast<std::int32_t>(std::lround(height));
            low = std::min(low, height);
            high = std::max(high, height);
        }
    info_.min_height_m = info_.height_m(std::floor(low) - 1.0);
    info_.max_height_m = info_.height_m(std::ceil(high) + 1.0);
}

// Own vertical error, then the largest of what depends on a vertex, fine to coarse.
void Scene::find_errors() {
    errors_.assign(quanta_.size(), 0.0);
    const auto inside = [&](std::int64_t x, std::int64_t y) {
        return x >= 0 && y >= 0 && x <= columns_ && y <= rows_;
    };
    const auto pass = [&](std::int64_t s, bool centres) {
        for (std::int64_t y = 0; y <= rows_; y += s)
            for (std::int64_t x = 0; x <= columns_; x += s) {
                const Place p = place_of(x, y);
                if (p.scale != s || p.centre != centres) continue;
                double& error = errors_[at(x, y)];
                error = std::abs(2.0 * quanta(x, y) - quanta(p.a.x, p.a.y) - quanta(p.b.x, p.b.y)) / 2.0;
                const std::int64_t d = centres ? s : s / 2;
                if (d == 0) continue;
                for (int i = 0; i < 4; ++i) {
                    const std::int64_t dx = centres ? (i == 0 ? d : i == 1 ? -d : 0) : (i & 1 ? d : -d);
                    const std::int64_t dy = centres ? (i == 2 ? d : i == 3 ? -d : 0) : (i & 2 ? d : -d);
                    if (inside(x + dx, y + dy)) error = std::max(error, errors_[at(x + dx, y + dy)]);
                }
            }
    };
    for (std::int64_t s = 1; s <= grid_.extent(0) / 2; s *= 2) {
        pass(s, false);
        pass(s, true);
    }
}

// So that a node of any level keeps about as many vertices.
void Scene::find_thresholds(std::size_t vertices_per_node) {
    std::vector<double> sorted = errors_;
    std::sort(sorted.begin(), sorted.end(), std::greater<>());
    for (int level = 0; level < grid_.levels(); ++level) {
        const auto nodes =
            static_cast<std::size_t>(grid_.nodes_x(level)) * static_cast<std::size_t>(grid_.nodes_y(level));
        thresholds_.push_back(sorted[std::min(nodes * vertices_per_node, sorted.size() - 1)]);
    }
}

void Scene::find_surfaces() {
    for (int level = 0; level < grid_.levels(); ++level) {
        std::vector<double> surface(quanta_.size());
        const auto fill = [&](std::int64_t s, bool centres, bool all_larger) {
            for (std::int64_t y = 0; y <= rows_; y += s)
                for (std::int64_t x = 0; x <= columns_; x += s) {
                    const Place p = place_of(x, y);
                    if (!all_larger && (p.scale != s || p.centre != centres)) continue;
                    surface[at(x, y)] = all_larger || in_level(x, y, level)
                                            ? quanta(x, y)
                                            : 0.5 * (surface[at(p.a.x, p.a.y)] + surface[at(p.b.x, p.b.y)]);
                }
        };
        fill(grid_.extent(0), false, true);
        for (std::int64_t s = grid_.extent(0) / 2; s > 0; s /= 2) {
            fill(s, true, false);
            fill(s, false, false);
        }
        surfaces_.push_back(std::move(surface));
    }
}

void Scene::choose_nodata(Random& random, double share) {
    for (std::int64_t i = grid_.node_count() - 1; i >= 0; --i) {
        const NodeId node = grid_.node_at(i);
        bool data = node.level == grid_.finest() && uniform(random, 0.0, 1.0) >= share;
        for (int q = 0; q < io::kQuarters && node.level < grid_.finest(); ++q)
            if (grid_.contains(node.child(q)))
                data = data || records_[static_cast<std::size_t>(grid_.linear(node.child(q)))].has_data();
        records_[static_cast<std::size_t>(i)].flags = data || node.level == 0 ? io::NodeRecord::kHasData : 0u;
    }
}

void Scene::make_voids(Random& random, int count) {
    valid_.assign(quanta_.size(), 1);
    for (; count > 0; --count) {
        const int width = 1 << whole(random, 0, 5), height = 1 << whole(random, 0, 5);
        const int x = whole(random, 0, static_cast<int>(columns_) - width);
        const int y = whole(random, 0, static_cast<int>(rows_) - height);
        for (int j = y; j < y + height; ++j)
            for (int i = x; i < x + width; ++i) valid_[at(i, j)] = 0;
    }
}

bool Scene::cell_valid(std::int64_t x, std::int64_t y, int level) const {
    const std::int64_t step = grid_.step(level);
    for (std::int64_t j = y; j < y + step; ++j)
        for (std::int64_t i = x; i < x + step; ++i)
            if (valid_[at(i, j)] != 0) return true;
    return false;
}

io::HeightsTile Scene::heights_tile(NodeId node) const {
    io::HeightsTile tile;
    tile.quads = grid_.quads();
    const LatticePoint origin = grid_.origin(node);
    const std::int64_t step = grid_.step(node.level);
    constexpr int kApron = io::HeightsTile::kApron;
    for (int row = -kApron; row <= tile.quads + kApron; ++row)
        for (int column = -kApron; column <= tile.quads + kApron; ++column)
            tile.quanta.push_back(quanta(origin.x + column * step, origin.y + row * step));
    for (int row = 0; row < tile.quads; ++row)
        for (int column = 0; column < tile.quads; ++column) {
            tile.cell_valid.push_back(
                cell_valid(origin.x + column * step, origin.y + row * step, node.level) ? 1 : 0);
            tile.all_valid = tile.all_valid && tile.cell_valid.back() != 0;
        }
    if (tile.all_valid) tile.cell_valid.clear();
    return tile;
}

void Scene::describe(NodeId node) {
    io::NodeRecord& record = records_[static_cast<std::size_t>(grid_.linear(node))];
    if (!record.has_data()) return;
    const LatticePoint origin = grid_.origin(node);
    const std::int64_t extent = grid_.extent(node.level);
    record.min_quanta = record.max_quanta = quanta(origin.x, origin.y);
    double error = 0.0;
    for (std::int64_t y = origin.y; y <= origin.y + extent; ++y)
        for (std::int64_t x = origin.x; x <= origin.x + extent; ++x) {
            const double own = surface(x, y, node.level), above = surface(x, y, std::max(node.level - 1, 0));
            error = std::max(error, std::abs(own - quanta(x, y)));
            for (const std::int32_t q : {quanta(x, y), rounded(own), rounded(above)}) {
                record.min_quanta = std::min(record.min_quanta, q);
                record.max_quanta = std::max(record.max_quanta, q);
            }
        }
    record.error_m = static_cast<float>(error * info_.quantum_m);
    for (int q = 0; q < io::kQuarters && node.level < grid_.finest(); ++q)
        if (grid_.contains(node.child(q)))
            record.error_m = std::max(
                record.error_m, records_[static_cast<std::size_t>(grid_.linear(node.child(q)))].error_m);
}

void Scene::make_chunks() {
    io::ChunkScratch scratch;
    payloads_.resize(records_.size());
    blocks_.resize(records_.size());
    chunks_.resize(records_.size());
    io::ReliefMaker reliefs;
    std::vector<io::ReliefBounds> bounds(records_.size());
    const io::ChunkShape shape{grid_.quads(), info_.relief};
    for (std::size_t i = records_.size(); i-- > 0;) {
        io::NodeRecord& record = records_[i];
        if (!record.has_data()) continue;
        const NodeId node = grid_.node_at(static_cast<std::int64_t>(i));
        const io::HeightsTile heights = heights_tile(node);
        if (!heights.all_valid) record.flags |= io::NodeRecord::kHasMask;
        std::vector<std::uint8_t>& payload = payloads_[i];
        auto encoded = io::encode_chunk(grid_, node, NodeSource(*this, node), scratch, payload);
        RIDGELINE_CHECK(encoded.ok());
        bounds[i].widen(record.min_quanta);
        bounds[i].widen(record.max_quanta);
        reliefs.append(grid_, node, shape.relief, scratch, heights, *encoded, bounds[i], payload);
        record.min_quanta = encoded->min_quanta;
        record.max_quanta = encoded->max_quanta;
        if (node.level > 0)
            bounds[static_cast<std::size_t>(grid_.linear(node.parent()))].add_child(
                shape.relief, node.quarter(), bounds[i]);
        record.vertex_count = encoded->vertex_count;
        record.index_count = encoded->index_count;
        record.triangle_count = encoded->triangle_count;
        blocks_[i].resize(io::chunk_layout(record, shape).total / sizeof(io::ChunkVertex) + 1);
        chunks_[i] = io::ChunkView(std::as_writable_bytes(std::span(blocks_[i])), record, shape);
        const io::ChunkSpacing spacing{info_.spacing_x_m, info_.spacing_y_m, info_.quantum_m};
        RIDGELINE_CHECK(
            io::decode_chunk(grid_, node, record, spacing, payload, heights, scratch, chunks_[i]).ok());
    }
}

namespace {

glm::dvec3 random_place(const Scene& scene, Random& random, double margin) {
    const auto& info = scene.info();
    const auto x = uniform(random, -margin, 1.0 + margin) * static_cast<double>(info.width - 1);
    const auto y = uniform(random, -margin, 1.0 + margin) * static_cast<double>(info.height - 1);
    const auto quanta = scene.quanta(static_cast<std::int64_t>(x), static_cast<std::int64_t>(y));
    return {info.world(x, y), info.height_m(quanta)};
}

void look_at(select::Camera& camera, const glm::dvec3& target) {
    camera.forward = glm::normalize(target - camera.eye_m);
    camera.right = glm::normalize(glm::cross(camera.forward, glm::dvec3(0.0, 0.0, 1.0)));
    camera.up = glm::cross(camera.right, camera.forward);
}

}  // namespace

select::View random_view(const Scene& scene, Random& random) {
    select::Camera camera;
    camera.eye_m = random_place(scene, random, whole(random, 0, 5) == 0 ? 0.3 : 0.0);
    camera.eye_m.z += std::exp(uniform(random, 0.0, 8.0)) - 20.0;
    look_at(camera, random_place(scene, random, 0.0));
    camera.horizontal_field = Angle::from_degrees(uniform(random, 20.0, 110.0));
    camera.speed_m_per_s = whole(random, 0, 1) * uniform(random, 0.0, 500.0);
    camera.turn_per_second = Angle::from_degrees(uniform(random, 0.0, 90.0));
    select::ViewOptions options;
    options.pixel_error_px = std::exp(uniform(random, -1.0, 3.0));
    options.exaggeration = std::array{0.5, 1.0, 1.0, 3.0}[static_cast<std::size_t>(whole(random, 0, 3))];
    options.eye_above_ground_m = uniform(random, 1.0, 500.0);
    return select::make_view(camera, options);
}

select::View view_of_all(const Scene& scene, Random& random) {
    select::View view = random_view(scene, random);
    for (auto& plane : view.visible.planes) plane = {{0.0, 0.0, 1.0}, 1e9};
    view.picture_reach = Angle::from_degrees(180.0);
    view.extension = {};
    return view;
}

std::vector<io::NodeResidency> random_residency(const Scene& scene, Random& random) {
    std::vector<io::NodeResidency> residency(scene.records().size());
    const double share = 1.0 - std::pow(uniform(random, 0.0, 0.8), 2.0);
    const double fading = whole(random, 0, 1) * uniform(random, 0.0, 1.0);
    for (std::size_t i = 0; i < residency.size(); ++i) {
        const NodeId node = scene.grid().node_at(static_cast<std::int64_t>(i));
        const bool root = node.level == 0;
        const bool above =
            root || residency[static_cast<std::size_t>(scene.grid().linear(node.parent()))].resident;
        residency[i].resident =
            scene.records()[i].has_data() && above && (root || uniform(random, 0.0, 1.0) < share);
        if (!root && uniform(random, 0.0, 1.0) < fading)
            residency[i].fade = static_cast<float>(uniform(random, 0.0, 1.0));
    }
    return residency;
}

std::vector<io::NodeResidency> all_resident(const Scene& scene) {
    std::vector<io::NodeResidency> residency(scene.records().size());
    for (std::size_t i = 0; i < residency.size(); ++i) residency[i].resident = scene.records()[i].has_data();
    return residency;
}

std::vector<Unit> units_of(const Scene& scene, std::span<const select::DrawEntry> draws) {
    std::vector<Unit> units;
    for (const auto& entry : draws)
        for (int q = 0; q < io::kQuarters; ++q) {
            if ((entry.quarters >> q & 1) == 0) continue;
            const std::int64_t half = scene.grid().extent(entry.node.level) / 2;
            const LatticePoint origin = scene.grid().origin(entry.node);
            units.push_back({&entry, q, origin.x + (q & 1) * half, origin.y + (q >> 1) * half, half});
        }
    return units;
}

}  // namespace ridgeline::test
