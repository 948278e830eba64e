// BC1 blocks by the GPU: those that the same shader gives as C++, whatever the slot and the count; and imagery
// layers made with them.
#include <chrono>
#include <cstring>

#include "ridgeline/app/build/gpu_encoder.h"
#include "ridgeline/render/block_encoder.h"
#include "ridgeline/shaders/lib/bc1.h"
#include "support/block_pictures.h"
#include "support/gl_context.h"
#include "support/small_imagery.h"
#include "support/small_store.h"

using namespace ridgeline;
using namespace ridgeline::test;
using build::BlockTexels;

namespace {

constexpr auto kPatience = std::chrono::seconds(60);

io::Bc1Block encoded_on_cpu(const BlockTexels& texels) {
    const auto words = shaders::bc1_encoded(shader_texels(texels));
    return {static_cast<std::uint16_t>(words.x & 0xffffu), static_cast<std::uint16_t>(words.x >> 16),
            words.y};
}

std::vector<BlockTexels> many_blocks(std::size_t count, std::uint32_t seed) {
    RandomBlocks random(seed);
    std::vector<BlockTexels> blocks;
    for (std::size_t i = 0; i < count; ++i) {
        blocks.push_back(random.next(kBlockKinds[i % 5]));
        if (i % 7 == 0) random.pierce(blocks.back());
        if (i % 11 == 0) blocks.back().fill(random.any_texel());
    }
    return blocks;
}

void fill(const render::BlockEncoder& encoder, std::size_t slot, const std::vector<BlockTexels>& blocks) {
    for (std::size_t i = 0; i < blocks.size(); ++i) encoder.texels(slot)[i] = shader_texels(blocks[i]);
}

SmallStore small_store() {
    return SmallStore(ReferenceTerrain(io::Grid(65, 65, 32), ReferenceTerrain::random_hills(1, 30, 3)));
}

std::unique_ptr<app::GpuEncoder> open_encoder() {
    auto encoder = app::GpuEncoder::open();
    if (encoder) return std::move(*encoder);
    MESSAGE("skipped: ", encoder.error().message);
    return nullptr;
}

// Opaque texels' squared error over a store's finest level, and its holes.
struct Judged {
    double squares = 0.0;
    std::int64_t texels = 0, wrong_holes = 0;
};
Judged judge(const std::filesystem::path& directory, const io::ImageryInfo& frame,
             const MemoryTexels::Colour& picture) {
    const auto store = io::Store::open(directory);
    REQUIRE(store);
    const io::Grid& grid = store->imagery_grid();
    Judged judged;
    for (std::int64_t i = grid.first(grid.finest()); i < grid.node_count(); ++i) {
        const io::NodeId node = grid.node_at(i);
        const auto blocks = read_tile(*store, node);
        for (int y = 0; y < io::kImageryTile; ++y)
            for (int x = 0; x < io::kImageryTile; ++x) {
                const std::int64_t column = node.x * io::kImageryTile + x,
                                   row = node.y * io::kImageryTile + y;
                if (column >= frame.width || row >= frame.height) continue;
                const build::Texel is = picture(column, row), shown = texel_of(blocks, x, y);
                judged.wrong_holes += (is.alpha != 0) != (shown.alpha != 0);
                if (is.alpha == 0) continue;
                judged.squares += squares_between(is, shown);
                ++judged.texels;
            }
    }
    return judged;
}

}  // namespace

TEST_CASE("the GPU's blocks are those of the shader as C++") {
    GlContext gl;
    if (!gl) return;
    const auto blocks = many_blocks(30000, 1);
    auto encoder = render::BlockEncoder::create(1, blocks.size());
    if (!encoder) FAIL(encoder.error().message);
    fill(*encoder, 0, blocks);
    encoder->start(0, blocks.size());
    REQUIRE(encoder->finish(kPatience));
    double by_gpu = 0.0, by_cpu = 0.0;
    int differ = 0, wrong_holes = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const io::Bc1Block on_gpu = encoder->blocks(0)[i], on_cpu = encoded_on_cpu(blocks[i]);
        differ += on_gpu != on_cpu;
        by_gpu += squared_error(blocks[i], on_gpu);
        by_cpu += squared_error(blocks[i], on_cpu);
        for (int t = 0; t < 16; ++t)
            wrong_holes +=
                (texel_of_block(on_gpu, t).alpha != 0) != (blocks[i][static_cast<std::size_t>(t)].alpha != 0);
    }
    MESSAGE(differ, " of ", blocks.size(), " blocks differ");
    // GL lets division and what is rounded at a tie differ in the last bit, and then an endpoint by a step.
    CHECK(differ <= static_cast<int>(blocks.size() / 100));
    CHECK(by_gpu == doctest::Approx(by_cpu).epsilon(1e-3));
    CHECK(wrong_holes == 0);
}

TEST_CASE("every slot gets its own blocks, as many as were asked for") {
    GlContext gl;
    if (!gl) return;
    constexpr std::size_t kSlots = 5, kBlocks = 300;
    auto encoder = render::BlockEncoder::create(kSlots, kBlocks);
    if (!encoder) FAIL(encoder.error().message);
    const auto blocks = many_blocks(kBlocks, 2);
    fill(*encoder, 0, blocks);
    encoder->start(0, kBlocks);
    REQUIRE(encoder->finish(kPatience));
    const std::vector<io::Bc1Block> all(encoder->blocks(0).begin(), encoder->blocks(0).end());
    for (const std::size_t count : {1, 63, 64, 65, 300}) {
        CAPTURE(count);
        // Turned round, so that what was there before is told from what is new.
        for (std::size_t slot = 0; slot < kSlots; ++slot) {
            auto turned = blocks;
            std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(slot * 37),
                        turned.end());
            fill(*encoder, slot, turned);
        }
        std::vector<std::vector<io::Bc1Block>> before;
        for (std::size_t slot = 0; slot < kSlots; ++slot)
            before.emplace_back(encoder->blocks(slot).begin(), encoder->blocks(slot).end());
        for (const std::size_t slot : {3, 1, 4}) encoder->start(slot, count);
        REQUIRE(encoder->finish(kPatience));
        int wrong = 0;
        for (std::size_t slot = 0; slot < kSlots; ++slot)
            for (std::size_t i = 0; i < kBlocks; ++i) {
                const bool started = (slot == 1 || slot >= 3) && i < count;
                wrong +=
                    encoder->blocks(slot)[i] != (started ? all[(i + slot * 37) % kBlocks] : before[slot][i]);
            }
        CHECK(wrong == 0);
    }
}

TEST_CASE("imagery that the GPU encodes: the same bytes again and whatever the threads, the CPU's holes") {
    const auto encoder = open_encoder();
    if (!encoder) return;
    io::ImageryInfo frame;
    frame.width = 1300;
    frame.height = 900;
    const auto noise = pierced_noise(frame.width, frame.height, 7);
    std::string first;
    for (const int workers : {1, 2, 5}) {
        const auto small = small_store();
        MemoryTexels rows(frame, noise);
        add_imagery(small.directory(), rows, workers, *encoder);
        if (first.empty()) first = imagery_files(small.directory());
        CHECK(imagery_files(small.directory()) == first);
        const auto verified =
            io::verify_store(*io::Store::open(small.directory()), [](std::int64_t, std::int64_t) {});
        if (!verified) FAIL(verified.error().message);
        const Judged judged = judge(small.directory(), frame, noise);
        CHECK(judged.wrong_holes == 0);
        CHECK(judged.texels > 1'000'000);
    }
    const auto again = open_encoder();
    REQUIRE(again);
    const auto small = small_store();
    MemoryTexels rows(frame, noise);
    add_imagery(small.directory(), rows, 2, *again);
    CHECK(imagery_files(small.directory()) == first);
}

TEST_CASE("imagery that the GPU encodes: no more than 0.3 dB from the CPU's") {
    const auto encoder = open_encoder();
    if (!encoder) return;
    io::ImageryInfo frame;
    frame.width = 520;
    frame.height = 700;
    const MemoryTexels::Colour picture = [](std::int64_t x, std::int64_t y) -> build::Texel {
        const double slow = std::sin(static_cast<double>(x) / 19.0) + std::cos(static_cast<double>(y) / 23.0);
        const auto h = static_cast<std::uint32_t>(x * 73856093 ^ y * 19349663) * 0x9e3779b1u >> 27;
        const auto channel = [&](double base) { return static_cast<std::uint8_t>(base + 30.0 * slow + h); };
        return {channel(90.0), channel(110.0), channel(70.0), build::kOpaque};
    };
    const auto cpu = small_store(), gpu = small_store();
    MemoryTexels rows(frame, picture);
    add_imagery(cpu.directory(), rows);
    add_imagery(gpu.directory(), rows, 2, *encoder);
    const Judged by_cpu = judge(cpu.directory(), frame, picture),
                 by_gpu = judge(gpu.directory(), frame, picture);
    CHECK(by_gpu.texels == by_cpu.texels);
    CHECK(10.0 * std::log10(by_gpu.squares / by_cpu.squares) < 0.3);
}
