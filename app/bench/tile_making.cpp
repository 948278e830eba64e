#include "ridgeline/app/bench/tile_making.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <vector>

#include "ridgeline/detail/detail_tile.h"
#include "ridgeline/detail/finer_ground.h"
#include "ridgeline/pager/heights_texels.h"
#include "ridgeline/render/detail_pass.h"

namespace ridgeline::app {
namespace {

using Clock = std::chrono::steady_clock;
using detail::DetailTile;
using Seconds = std::chrono::duration<double>;

// Turns are short, so that whatever else the machine does meets all variants alike.
constexpr int kTurns = 8;

struct Variant {
    double tiles = 0.0, seconds = 0.0;
    double per_second() const { return tiles / seconds; }
};

class TileMaking {
  public:
    TileMaking(const io::Store& store, jobs::JobSystem& jobs, const TileMakingOptions& options)
        : store_(store), jobs_(jobs), options_(options), ground_(detail::finer_ground(store.info(), 1)) {}

    Result<void> open() {
        RIDGELINE_TRY(read_parents());
        const int side = pager::heights_texels_side(quads());
        auto texture = gl::Texture2DArray::create({.format = GL_R32I,
                                                   .size_px = glm::ivec2(side),
                                                   .layers = static_cast<int>(5 * parents_.size()),
                                                   .label = "tiles to make"});
        if (!texture) return texture.error();
        texture_ = std::move(*texture);
        auto pass = render::DetailPass::create(ground_, quads());
        if (!pass) return pass.error();
        pass_.emplace(std::move(*pass));
        for (std::size_t i = 0; i < parents_.size(); ++i) upload_parent(i);
        return {};
    }

    Result<void> run(Figures& figures) {
        make_on_gpu();
        make_on_cpu(true);
        if (!is_alike()) return Error{"suite synthesis: the GPU's made tiles are not the CPU's"};
        Variant gpu, cpu, core;
        for (int turn = 0; turn < kTurns; ++turn) {
            measure(gpu, [&] { make_on_gpu(); });
            measure(cpu, [&] { make_on_cpu(true); });
            measure(core, [&] { make_on_cpu(false); });
        }
        const auto bytes = static_cast<double>(pager::heights_texels_bytes(quads()));
        report("tiles/gpu", gpu, cpu, 0.0, figures);
        report("tiles/cpu", cpu, cpu, bytes, figures);
        report("tiles/cpu_one_core", core, cpu, bytes, figures);
        return {};
    }

  private:
    int quads() const { return store_.grid().quads(); }

    // Evenly spread over those with data.
    Result<void> read_parents() {
        const io::Grid& grid = store_.grid();
        std::vector<io::NodeId> nodes;
        for (std::int64_t i = grid.first(grid.finest()); i < grid.node_count(); ++i)
            if (store_.record(grid.node_at(i)).has_data()) nodes.push_back(grid.node_at(i));
        const std::size_t count = std::min(nodes.size(), static_cast<std::size_t>(options_.parents));
        std::vector<std::uint8_t> bytes;
        sources_.resize(count);
        parents_.resize(count);
        children_.resize(4 * count);
        for (std::size_t i = 0; i < count; ++i) {
            const io::NodeId node = nodes[i * nodes.size() / count];
            RIDGELINE_TRY(store_.read_heights(node, bytes, sources_[i]));
            detail::make_root(sources_[i], node, ground_.shift, parents_[i]);
        }
        return {};
    }

    void upload_parent(std::size_t i) {
        const int side = pager::heights_texels_side(quads());
        std::vector<std::byte> texels(pager::heights_texels_bytes(quads()));
        pager::pack_heights(sources_[i], pager::HeightsFilter::none, texels);
        texture_.upload({.layer = static_cast<int>(i), .size_px = glm::ivec2(side)}, {GL_RED_INTEGER, GL_INT},
                        texels);
    }

    std::uint32_t slot_of(std::size_t child) const {
        return static_cast<std::uint32_t>(parents_.size() + child);
    }

    void make_on_gpu() {
        for (std::size_t child = 0; child < children_.size(); ++child)
            pass_->make(texture_, {.node = parents_[child / 4].node.child(static_cast<int>(child % 4)),
                                   .octave = 1,
                                   .slot = slot_of(child),
                                   .parent_slot = static_cast<std::uint32_t>(child / 4)});
        pass_->finish();
        glFinish();
    }

    void make_on_cpu(bool all_cores) {
        const auto make = [&](std::int64_t child) {
            const auto i = static_cast<std::size_t>(child);
            detail::make_child(parents_[i / 4], static_cast<int>(i % 4), ground_.gains[0], children_[i]);
        };
        const auto count = static_cast<std::int64_t>(children_.size());
        if (all_cores) return jobs_.parallel_for(0, count, 1, make);
        for (std::int64_t child = 0; child < count; ++child) make(child);
    }

    template <class Make>
    void measure(Variant& variant, Make make) {
        const auto from = Clock::now();
        while (Seconds(Clock::now() - from).count() < options_.seconds / kTurns) {
            make();
            variant.tiles += static_cast<double>(children_.size());
        }
        variant.seconds += Seconds(Clock::now() - from).count();
    }

    bool is_alike() const {
        const int side = pager::heights_texels_side(quads());
        std::vector<std::int32_t> texels(static_cast<std::size_t>(side * side));
        for (std::size_t child = 0; child < children_.size(); ++child) {
            glGetTextureSubImage(texture_.id(), 0, 0, 0, static_cast<GLint>(slot_of(child)), side, side, 1,
                                 GL_RED_INTEGER, GL_INT,
                                 static_cast<GLsizei>(texels.size() * sizeof texels[0]), texels.data());
            for (std::size_t i = 0; i < texels.size(); ++i)
                if (texels[i] >> 1 != children_[child].heights[i]) return false;
        }
        return true;
    }

    static void report(const std::string& name, const Variant& variant, const Variant& cpu,
                       double bytes_a_tile, Figures& figures) {
        figures.set(name, "tiles_per_s", variant.per_second());
        figures.set(name, "per_second_ratio", variant.per_second() / cpu.per_second());
        figures.set(name, "bytes_sent_per_tile", bytes_a_tile);
    }

    const io::Store& store_;
    jobs::JobSystem& jobs_;
    const TileMakingOptions& options_;
    detail::FinerGround ground_;
    std::vector<io::HeightsTile> sources_;
    std::vector<DetailTile> parents_, children_;
    gl::Texture2DArray texture_;
    std::optional<render::DetailPass> pass_;
};

}  // namespace

Result<void> make_tiles(const io::Store& store, jobs::JobSystem& jobs, const TileMakingOptions& options,
                        Figures& figures) {
    TileMaking making(store, jobs, options);
    RIDGELINE_TRY(making.open());
    return making.run(figures);
}

}  // namespace ridgeline::app
