// Rivers at rest: where uplift U and stream incision K·A^m·S (A drained area, S slope along the stream)
// balance, S = U / (K·A^m). J. Braun and S. Willett, "A very efficient O(n) … stream power equation"
// (Geomorphology 2013), solve its evolution along receiver trees; G. Cordonnier et al., "Large scale terrain
// generation from tectonic uplift and fluvial erosion" (Eurographics 2016), make landscapes with it, with
// slopes limited as talus. Pits of a start surface are raised by R. Barnes et al.'s priority flood (Computers
// & Geosciences 2014).
//
// How we differ: no time steps; heights are set to the balance along the current receivers, then water is
// sent again, a few times. Nodes are jittered, so that streams follow the ground rather than the grid's eight
// directions, and grids are solved coarse to fine, each starting from the one before: great valleys are old.
#include "drainage.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "noise.h"

namespace ridgeline::synth {
namespace {

constexpr int kCoarsestNodes = 65;
constexpr int kMostNodes = 1025;
// Fields of uplift and rock are smooth: they are made on no more nodes than this, and interpolated.
constexpr int kMostFieldNodes = 257;
// Share of a cell by which nodes leave the lattice, to either side. Under ½, so that none changes places.
constexpr float kJitter = 0.45f;

// On plains, where uplift is next to nothing, the start is still this uneven: water that finds no unevenness
// runs straight along the lattice.
constexpr float kPlainRoughness = 0.1f;

using Index = std::uint32_t;

// What the ground is made of, over the unit square.
struct Ground {
    float uplift = 0.0f;  // 0…about 1.5
    float talus = 0.0f;   // steepest slope that stands
};

Ground ground_at(float x, float y, std::uint32_t seed) {
    const float warped_x = x + 0.18f * fractal_noise(x * 2.1f, y * 2.1f, seed + 100, 4);
    const float warped_y = y + 0.18f * fractal_noise(x * 2.1f + 5.0f, y * 2.1f + 3.0f, seed + 200, 4);
    const float upland =
        smooth_step(-0.32f, 0.45f, 0.05f + fractal_noise(warped_x * 1.7f, warped_y * 1.7f, seed + 300, 3));
    const float range =
        1.0f - 2.2f * std::abs(fractal_noise(warped_x * 3.1f, warped_y * 3.1f, seed + 400, 4));
    const float block = 1.0f + 0.5f * fractal_noise(warped_x * 9.0f, warped_y * 9.0f, seed + 500, 4);
    Ground ground;
    ground.uplift =
        std::max(0.02f * block, upland * (0.35f + 0.65f * smooth_step(0.0f, 1.0f, range)) * block);
    const float rock =
        0.75f * (1.0f + 0.6f * fractal_noise(warped_x * 14.0f, warped_y * 14.0f, seed + 600, 3));
    // What rises slowly is soft and worn: foothills stay gentle.
    ground.talus = rock * std::min(1.0f, 0.15f + 1.6f * ground.uplift);
    return ground;
}

struct GroundMaps {
    HeightMap uplift;
    HeightMap talus;
};

GroundMaps make_ground(std::uint32_t seed) {
    GroundMaps maps;
    maps.uplift.nodes = maps.talus.nodes = kMostFieldNodes;
    const float step = 1.0f / (kMostFieldNodes - 1);
    for (int row = 0; row < kMostFieldNodes; ++row)
        for (int column = 0; column < kMostFieldNodes; ++column) {
            const Ground ground =
                ground_at(static_cast<float>(column) * step, static_cast<float>(row) * step, seed);
            maps.uplift.heights_m.push_back(ground.uplift);
            maps.talus.heights_m.push_back(ground.talus);
        }
    return maps;
}

// One resolution of the landscape.
class Network {
  public:
    Network(int nodes, const DrainageOptions& options, const GroundMaps& ground);

    // The first start surface, and the start from a coarser solution.
    void start_afresh();
    void start_from(const HeightMap& coarser);
    // Sends the water down `rounds` times and sets heights to the balance each time; `incision` is what
    // stands for 1/K and is led towards the wanted relief.
    void settle(int rounds, float& incision);
    // The heights on the regular lattice.
    HeightMap regular() const;

  private:
    static constexpr std::array<std::pair<int, int>, 8> kAround{
        {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

    Index index(int column, int row) const { return static_cast<Index>(row * nodes_ + column); }
    bool on_rim(int column, int row) const {
        return column == 0 || row == 0 || column == nodes_ - 1 || row == nodes_ - 1;
    }
    float distance_m(Index a, Index b) const;
    float base_level_m(int column, int row) const;
    void raise_pits();
    void choose_receivers();
    void order_from_outlets();
    void gather_areas();
    float balance(float incision);

    int nodes_;
    float cell_m_;
    DrainageOptions options_;
    std::vector<float> x_, y_;  // jittered, in cells
    std::vector<float> uplift_, talus_;
    std::vector<float> heights_m_, balanced_m_, area_m2_;
    std::vector<Index> receivers_, order_;
};

Network::Network(int nodes, const DrainageOptions& options, const GroundMaps& ground)
    : nodes_(nodes), cell_m_(options.extent_m / static_cast<float>(nodes - 1)), options_(options) {
    const float to_field = static_cast<float>(kMostFieldNodes - 1) / static_cast<float>(nodes - 1);
    for (int row = 0; row < nodes; ++row) {
        for (int column = 0; column < nodes; ++column) {
            const std::uint32_t h = hash(column, row, options.seed + static_cast<std::uint32_t>(nodes));
            x_.push_back(static_cast<float>(column) + kJitter * (2.0f * unit_interval(h) - 1.0f));
            y_.push_back(static_cast<float>(row) + kJitter * (2.0f * unit_interval(hash(h + 1)) - 1.0f));
            uplift_.push_back(ground.uplift.smooth_at(x_.back() * to_field, y_.back() * to_field));
            talus_.push_back(ground.talus.smooth_at(x_.back() * to_field, y_.back() * to_field));
        }
    }
    heights_m_.resize(x_.size());
}

// No two nodes come closer than a third of a cell, lest a slope between them mean nothing.
float Network::distance_m(Index a, Index b) const {
    const float dx = x_[a] - x_[b];
    const float dy = y_[a] - y_[b];
    return cell_m_ * std::max(1.0f / 3.0f, std::sqrt(dx * dx + dy * dy));
}

float Network::base_level_m(int column, int row) const {
    const float to_unit = 2.0f / static_cast<float>(nodes_ - 1);
    const float level =
        0.6f + 0.4f * fractal_noise(static_cast<float>(column) * to_unit, static_cast<float>(row) * to_unit,
                                    options_.seed + 700, 3);
    return 0.02f * options_.relief_m * level;
}

void Network::start_afresh() {
    const float to_unit = 8.0f / static_cast<float>(nodes_ - 1);
    for (int row = 0; row < nodes_; ++row) {
        for (int column = 0; column < nodes_; ++column) {
            const Index i = index(column, row);
            const float rough = fractal_noise(x_[i] * to_unit, y_[i] * to_unit, options_.seed + 800, 4);
            heights_m_[i] = base_level_m(column, row);
            if (!on_rim(column, row))
                heights_m_[i] += options_.relief_m * (0.4f * uplift_[i] + 0.05f * (1.0f + rough));
        }
    }
    raise_pits();
}

void Network::start_from(const HeightMap& coarser) {
    const float to_coarser = static_cast<float>(coarser.nodes - 1) / static_cast<float>(nodes_ - 1);
    for (int row = 0; row < nodes_; ++row) {
        for (int column = 0; column < nodes_; ++column) {
            const Index i = index(column, row);
            // Unevenness of the start decides where the small valleys of this resolution begin.
            const float rough = unit_interval(hash(column, row, options_.seed + 900)) - 0.5f;
            heights_m_[i] = on_rim(column, row)
                                ? base_level_m(column, row)
                                : coarser.smooth_at(x_[i] * to_coarser, y_[i] * to_coarser) +
                                      0.15f * cell_m_ * std::max(kPlainRoughness, uplift_[i]) * rough;
        }
    }
    raise_pits();
}

// Priority flood from the rim: afterwards every node has a lower neighbour.
void Network::raise_pits() {
    const float least_step_m = 1e-6f * cell_m_ + 1e-4f;
    using Front = std::pair<float, Index>;
    std::priority_queue<Front, std::vector<Front>, std::greater<>> front;
    std::vector<char> reached(heights_m_.size(), 0);
    for (int row = 0; row < nodes_; ++row)
        for (int column = 0; column < nodes_; ++column)
            if (on_rim(column, row)) {
                front.emplace(heights_m_[index(column, row)], index(column, row));
                reached[index(column, row)] = 1;
            }
    while (!front.empty()) {
        const auto [level_m, i] = front.top();
        front.pop();
        const int column = static_cast<int>(i) % nodes_;
        const int row = static_cast<int>(i) / nodes_;
        for (const auto& [dx, dy] : kAround) {
            if (column + dx < 0 || row + dy < 0 || column + dx >= nodes_ || row + dy >= nodes_) continue;
            const Index neighbour = index(column + dx, row + dy);
            if (std::exchange(reached[neighbour], 1)) continue;
            heights_m_[neighbour] = std::max(heights_m_[neighbour], level_m + least_step_m);
            front.emplace(heights_m_[neighbour], neighbour);
        }
    }
}

// Each node drains to the neighbour down the steepest slope; the rim drains off the map (to itself).
void Network::choose_receivers() {
    receivers_.resize(heights_m_.size());
    for (int row = 0; row < nodes_; ++row) {
        for (int column = 0; column < nodes_; ++column) {
            const Index i = index(column, row);
            receivers_[i] = i;
            if (on_rim(column, row)) continue;
            float steepest = 0.0f;
            for (const auto& [dx, dy] : kAround) {
                const Index neighbour = index(column + dx, row + dy);
                const float slope = (heights_m_[i] - heights_m_[neighbour]) / distance_m(i, neighbour);
                if (slope > steepest) {
                    steepest = slope;
                    receivers_[i] = neighbour;
                }
            }
        }
    }
}

// Every node after its receiver: breadth first over the trees, donors listed by counting.
void Network::order_from_outlets() {
    const std::size_t count = receivers_.size();
    std::vector<Index> first(count + 1, 0);
    for (Index i = 0; i < count; ++i)
        if (receivers_[i] != i) ++first[receivers_[i] + 1];
    for (std::size_t i = 0; i < count; ++i) first[i + 1] += first[i];
    std::vector<Index> next(first.begin(), first.end() - 1);
    std::vector<Index> donors(count);
    order_.clear();
    for (Index i = 0; i < count; ++i) {
        if (receivers_[i] != i)
            donors[next[receivers_[i]]++] = i;
        else
            order_.push_back(i);
    }
    for (std::size_t k = 0; k < order_.size(); ++k)
        order_.insert(order_.end(), donors.begin() + first[order_[k]], donors.begin() + first[order_[k] + 1]);
}

void Network::gather_areas() {
    area_m2_.assign(heights_m_.size(), cell_m_ * cell_m_);
    for (auto i = order_.rbegin(); i != order_.rend(); ++i)
        if (receivers_[*i] != *i) area_m2_[receivers_[*i]] += area_m2_[*i];
}

// Heights at which incision and uplift balance; moves ours most of the way there and returns the highest.
float Network::balance(float incision) {
    constexpr float kStep = 0.7f;  // all the way at once, receivers flicker between rounds
    balanced_m_ = heights_m_;
    float highest_m = 0.0f;
    for (const Index i : order_) {
        const Index receiver = receivers_[i];
        if (receiver == i) continue;
        const float stream_slope = incision * uplift_[i] / std::sqrt(area_m2_[i]);
        // Streams as they balance, hillsides no steeper than talus, one passing smoothly into the other.
        const float slope = stream_slope * talus_[i] / (stream_slope + talus_[i]);
        balanced_m_[i] = balanced_m_[receiver] + distance_m(i, receiver) * slope;
        highest_m = std::max(highest_m, balanced_m_[i]);
    }
    for (std::size_t i = 0; i < heights_m_.size(); ++i)
        heights_m_[i] += kStep * (balanced_m_[i] - heights_m_[i]);
    return highest_m;
}

void Network::settle(int rounds, float& incision) {
    for (int round = 0; round < rounds; ++round) {
        choose_receivers();
        order_from_outlets();
        gather_areas();
        const float highest_m = balance(incision);
        incision *= std::sqrt(std::clamp(options_.relief_m / highest_m, 0.5f, 2.0f));
    }
}

// Moving least squares: a plane fitted to the jittered nodes around, weighted by nearness.
HeightMap Network::regular() const {
    HeightMap map{nodes_, cell_m_, std::vector<float>(heights_m_.size())};
    for (int row = 0; row < nodes_; ++row) {
        for (int column = 0; column < nodes_; ++column) {
            float w = 0, wx = 0, wy = 0, wh = 0, wxx = 0, wxy = 0, wyy = 0, wxh = 0, wyh = 0;
            const float own_m = heights_m_[index(column, row)];
            for (int b = std::max(0, row - 2); b <= std::min(nodes_ - 1, row + 2); ++b) {
                for (int a = std::max(0, column - 2); a <= std::min(nodes_ - 1, column + 2); ++a) {
                    const Index i = index(a, b);
                    const float dx = x_[i] - static_cast<float>(column);
                    const float dy = y_[i] - static_cast<float>(row);
                    const float nearness = std::max(0.0f, 1.0f - (dx * dx + dy * dy) / 3.0f);
                    const float weight = nearness * nearness * nearness * nearness;
                    const float dh = heights_m_[i] - own_m;
                    w += weight, wx += weight * dx, wy += weight * dy, wh += weight * dh;
                    wxx += weight * dx * dx, wxy += weight * dx * dy, wyy += weight * dy * dy;
                    wxh += weight * dx * dh, wyh += weight * dy * dh;
                }
            }
            // A small ridge term keeps the fit tame where nodes line up.
            constexpr float kRidge = 0.02f;
            const float mx = wx / w, my = wy / w, mh = wh / w;
            const float xx = wxx / w - mx * mx + kRidge, xy = wxy / w - mx * my,
                        yy = wyy / w - my * my + kRidge;
            const float xh = wxh / w - mx * mh, yh = wyh / w - my * mh;
            const float determinant = xx * yy - xy * xy;
            const float slope_x = (xh * yy - yh * xy) / determinant;
            const float slope_y = (yh * xx - xh * xy) / determinant;
            map.heights_m[index(column, row)] = own_m + mh - slope_x * mx - slope_y * my;
        }
    }
    return map;
}

// Coarse networks are cheap and decide much; fine ones only need to fit in.
int rounds_for(int nodes) { return nodes <= 129 ? 30 : nodes <= 257 ? 16 : nodes <= 513 ? 8 : 5; }

}  // namespace

HeightMap drained_landscape(const DrainageOptions& options) {
    const GroundMaps ground = make_ground(options.seed);
    float incision = 0.15f * options.relief_m;
    HeightMap map;
    for (int nodes = kCoarsestNodes; nodes <= kMostNodes; nodes = 2 * nodes - 1) {
        Network network(nodes, options, ground);
        if (map.nodes == 0)
            network.start_afresh();
        else
            network.start_from(map);
        network.settle(rounds_for(nodes), incision);
        map = network.regular();
        if (map.cell_m <= options.finest_cell_m) break;
    }
    return map;
}

}  // namespace ridgeline::synth
