#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include "ridgeline/io/imagery_info.h"
#include "ridgeline/render/page_table.h"
#include "ridgeline/shaders/lib/virtual_texture.h"

namespace ridgeline::render {
namespace {

// Imagery of which tiles come and go, each after its parent and before its children; and an eye that moves.
class Trial {
  public:
    Trial(unsigned seed, std::int64_t width, std::int64_t height)
        : random_(seed), grid_(width + 1, height + 1, io::kImageryTile), table_(grid_, 65535) {
        for (std::int64_t i = 0; i < grid_.first(1); ++i) insert(grid_.node_at(i));
        copy_.resize(static_cast<std::size_t>(grid_.levels()) * table_.entries(0).size());
        look_from({0, 0});
    }

    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            random_() % 8 == 0 ? move() : change();
            copy_changes();
            for (int lookup = 0; lookup < 8; ++lookup) look_up();
        }
    }

    int answers_of_windows = 0;  // as fine as was asked, and not for want of a tile

  private:
    int below(std::int64_t end) { return static_cast<int>(random_() % static_cast<std::uint64_t>(end)); }
    glm::ivec2 random_cell() { return {below(grid_.width() - 1), below(grid_.height() - 1)}; }

    void look_from(const glm::ivec2& eye) {
        eye_ = eye;
        table_.look_from(eye);
    }
    void move() {
        if (random_() % 8 == 0) return look_from(random_cell());
        const glm::ivec2 most(grid_.width() - 2, grid_.height() - 2);
        look_from(glm::clamp(eye_ + glm::ivec2(below(2001) - 1000, below(2001) - 1000), glm::ivec2(0), most));
    }

    void insert(io::NodeId node) {
        while (slots_.contains(next_slot_)) ++next_slot_;
        table_.insert(node, next_slot_);
        slots_[next_slot_] = node;
        slot_of_[node] = next_slot_++;
        if (next_slot_ > 2000) next_slot_ = 0;
    }
    bool has_children(io::NodeId node) const {
        for (int quarter = 0; quarter < 4; ++quarter)
            if (slot_of_.contains(node.child(quarter))) return true;
        return false;
    }
    // Near the eye as often as anywhere, down to a random level.
    void change() {
        const glm::ivec2 place =
            random_() % 2 ? random_cell()
                          : glm::clamp(eye_ + glm::ivec2(below(8001) - 4000, below(8001) - 4000),
                                       glm::ivec2(0), glm::ivec2(grid_.width() - 2, grid_.height() - 2));
        io::NodeId node = node_at(place, below(grid_.levels()));
        if (slot_of_.contains(node)) {
            if (node.level == 0 || has_children(node)) return;
            table_.remove(node);
            slots_.erase(slot_of_[node]);
            slot_of_.erase(node);
            return;
        }
        std::vector<io::NodeId> missing;
        for (; !slot_of_.contains(node); node = node.parent()) missing.push_back(node);
        for (auto each = missing.rbegin(); each != missing.rend(); ++each) insert(*each);
    }
    io::NodeId node_at(const glm::ivec2& cell, int level) const {
        const int shift = 8 + grid_.finest() - level;
        return {level, cell.x >> shift, cell.y >> shift};
    }

    // As the GPU gets them: only rows that are said to have changed.
    void copy_changes() {
        table_.take_changes([&](int level, int first, int count) {
            const auto size = table_.entries(0).size();
            const auto columns = static_cast<std::size_t>(table_.columns());
            const auto begin = static_cast<std::size_t>(first) * columns;
            const auto rows = table_.entries(level).subspan(begin, static_cast<std::size_t>(count) * columns);
            std::ranges::copy(rows, copy_.begin() + static_cast<std::ptrdiff_t>(
                                                        static_cast<std::size_t>(level) * size + begin));
        });
    }

    shaders::ImageryUniforms uniforms() const {
        shaders::ImageryUniforms imagery{};
        imagery.eye_cell_and_size = {eye_, grid_.width() - 1, grid_.height() - 1};
        imagery.table = {grid_.finest(), table_.window_bits(), 0};
        return imagery;
    }

    void look_up() {
        const glm::ivec2 cell =
            random_() % 2 ? random_cell()
                          : glm::clamp(eye_ + glm::ivec2(below(9001) - 4500, below(9001) - 4500),
                                       glm::ivec2(0), glm::ivec2(grid_.width() - 2, grid_.height() - 2));
        const auto coarseness = static_cast<float>(below(1000)) * 0.001f * static_cast<float>(grid_.levels());
        const glm::ivec3 at = shaders::page_address(uniforms(), cell, coarseness);
        const auto place = static_cast<std::size_t>((at.z * table_.rows() + at.y) * table_.columns() + at.x);
        const std::uint32_t page = copy_[place];
        REQUIRE(page != 0);

        // Never coarser than asked for but where the window ends, and that is 16 nodes away.
        const int asked = grid_.finest() - std::min(static_cast<int>(coarseness), grid_.finest());
        REQUIRE(at.z <= asked);
        const glm::ivec2 away = glm::abs(cell - eye_) >> (8 + grid_.finest() - asked);
        if (std::max(away.x, away.y) < 16) {
            REQUIRE(at.z == asked);
            ++answers_of_windows;
        }
        // The reference: up from there to the first that is resident.
        io::NodeId node = node_at(cell, at.z);
        while (!slot_of_.contains(node)) node = node.parent();
        REQUIRE(shaders::page_slot(page) == slot_of_[node]);
        REQUIRE(shaders::page_coarseness(page) == grid_.finest() - node.level);
    }

    std::mt19937 random_;
    io::Grid grid_;
    PageTable table_;
    glm::ivec2 eye_{0};
    std::map<std::uint32_t, io::NodeId> slots_;
    std::map<io::NodeId, std::uint32_t> slot_of_;
    std::uint32_t next_slot_ = 0;
    std::vector<std::uint32_t> copy_;
};

}  // namespace

TEST_CASE(
    "every lookup finds the finest resident tile at or above the level asked for, whatever came and went") {
    const std::int64_t sizes[][2] = {
        {300, 200}, {5000, 3000}, {40000, 70000}, {1000000, 900000}, {60000, 500}};
    unsigned seed = 0;
    for (const auto& [width, height] : sizes) {
        CAPTURE(width);
        Trial trial(++seed, width, height);
        trial.run(4000);
        CHECK(trial.answers_of_windows > 1000);
    }
}

TEST_CASE("the table stays small however large the imagery is") {
    const io::Grid large(4'000'001, 4'000'001, io::kImageryTile);
    CHECK(large.node_count() > 300'000'000);
    CHECK(PageTable::bytes(large) == large.levels() * 64 * 64 * 4);
}

}  // namespace ridgeline::render
