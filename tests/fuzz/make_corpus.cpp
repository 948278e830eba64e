// Writes the corpora anew: small inputs from the real encoders, called sound-…, into the folder that is named.
// Inputs of other names stay: what was found once is kept there.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fuzz/bundle.h"
#include "ridgeline/io/imagery_tile.h"
#include "ridgeline/io/imagery_writer.h"
#include "ridgeline/io/record_table.h"
#include "ridgeline/io/relief_codec.h"
#include "ridgeline/io/relief_maker.h"
#include "ridgeline/io/store_update.h"
#include "ridgeline/platform/path_generators.h"
#include "support/small_store.h"

using namespace ridgeline;
using namespace ridgeline::io;
namespace fs = std::filesystem;

namespace {

using Bytes = std::vector<std::uint8_t>;

void put_word(std::uint32_t value, Bytes& out) {
    for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}
void append(const Bytes& bytes, Bytes& out) { out.insert(out.end(), bytes.begin(), bytes.end()); }
Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

Bytes content(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return bytes_of(std::string(std::istreambuf_iterator<char>(in), {}));
}

class Corpora {
  public:
    explicit Corpora(fs::path folder) : folder_(std::move(folder)) {}
    void add(const std::string& target, const std::string& name, const Bytes& bytes) const {
        fs::create_directories(folder_ / target);
        std::ofstream file(folder_ / target / ("sound-" + name), std::ios::binary);
        file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }

  private:
    fs::path folder_;
};

test::ReferenceTerrain hills(std::int64_t width, std::int64_t height) {
    return test::ReferenceTerrain(Grid(width, height, 32), test::ReferenceTerrain::random_hills(1, 30, 3));
}

// One tile of a few colours, some of it holes.
Bytes imagery_payload() {
    std::vector<Bc1Block> blocks(kImageryBlockCount);
    for (std::size_t i = 0; i < blocks.size(); ++i)
        blocks[i] = {static_cast<std::uint16_t>(i % 5 * 4000), static_cast<std::uint16_t>(i % 3 * 9000),
                     static_cast<std::uint32_t>(i % 7) * 0x1f3d5b79u};
    ImageryScratch scratch;
    Bytes payload;
    encode_imagery(blocks, scratch, payload);
    return payload;
}

// A store of five nodes, with a tile of imagery.
class PicturedStore {
  public:
    PicturedStore() : small_(hills(65, 60)) {
        auto update = StoreUpdate::begin(small_.directory(), Replace::never);
        REQUIRE(update);
        ImageryInfo imagery;
        imagery.west_m = update->info().min_east_m();
        imagery.north_m = update->info().max_north_m();
        imagery.width = imagery.height = 100;
        auto writer = ImageryWriter::create(update->directory(), update->scratch(), imagery.grid());
        REQUIRE(writer);
        REQUIRE(writer->put({0, 0, 0}, imagery_payload(), Holes::some));
        REQUIRE(writer->finish(imagery));
        REQUIRE(update->finish(imagery));
    }
    const fs::path& path() const { return small_.directory(); }

  private:
    test::SmallStore small_;
};

void add_info_tables_and_store(const Corpora& corpora) {
    const test::SmallStore plain(hills(33, 33));
    const PicturedStore pictured;
    for (const auto& [name, folder] :
         {std::pair<std::string, fs::path>{"plain", plain.directory()}, {"pictured", pictured.path()}}) {
        corpora.add("info", name, content(folder / kInfoFile));
        Bytes bundle;
        for (std::size_t i = 0; i < fuzz::kBundled.size(); ++i) {
            const Bytes file = content(folder / fuzz::kBundled[i]);
            if (file.empty()) continue;
            bundle.push_back(static_cast<std::uint8_t>(i));
            put_word(static_cast<std::uint32_t>(file.size()), bundle);
            append(file, bundle);
        }
        corpora.add("store", name, bundle);
        const auto store = Store::open(folder);
        REQUIRE(store);
        for (const bool imagery : {false, true}) {
            if (imagery && !store->info().imagery) continue;
            const auto& grid = imagery ? store->imagery_grid() : store->grid();
            Bytes table = {static_cast<std::uint8_t>(imagery)};
            put_word(static_cast<std::uint32_t>(grid.node_count()), table);
            append(content(folder / (imagery ? kImageryTable : kNodesFile)), table);
            corpora.add("tables", name + (imagery ? "-imagery" : "-nodes"), table);
        }
    }
}

// An input whose payload stands as it is: first what heights_of() and set_bounds() take (tile_setting.h).
Bytes with_setting(std::uint8_t mode, const EncodedChunk& bounds, const Bytes& payload) {
    Bytes input = {mode};
    put_word(static_cast<std::uint32_t>(bounds.min_quanta), input);
    put_word(static_cast<std::uint32_t>(bounds.max_quanta), input);
    put_word(static_cast<std::uint32_t>(bounds.min_quanta), input);
    put_word(0, input);
    append(payload, input);
    return input;
}

HeightsTile flat_tile(std::int32_t quanta) {
    HeightsTile tile;
    tile.quads = 32;
    const auto stride = static_cast<std::size_t>(tile.stride());
    tile.quanta.assign(stride * stride, quanta);
    return tile;
}

// Meshes on chunk.cpp's grid, at a coarse level and at the finest.
void add_chunks(const Corpora& corpora) {
    const test::ReferenceTerrain terrain = hills(129, 100);
    constexpr ReliefShape kRelief{2, 2, 2};
    for (const int level : {1, terrain.grid().finest()}) {
        const NodeId node{level, 0, 0};
        ChunkScratch scratch;
        ReliefMaker reliefs;
        ReliefBounds bounds;
        Bytes payload;
        const auto chunk = encode_chunk(terrain.grid(), node,
                                        test::ReferenceTerrain::NodeSource(terrain, node), scratch, payload);
        REQUIRE(chunk);
        EncodedChunk widened = *chunk;
        reliefs.append(terrain.grid(), node, kRelief, scratch, flat_tile(chunk->min_quanta), widened, bounds,
                       payload);
        const auto mode = static_cast<std::uint8_t>(3 * level);
        corpora.add("chunk", "level-" + std::to_string(level), with_setting(mode, widened, payload));
    }
    // Topologies that the input answers for: none split, some split.
    for (const std::uint8_t answers : {0, 0x5a}) {
        Bytes input = with_setting(static_cast<std::uint8_t>(2 + 3 * 2), {}, {});
        put_word(3, input);
        input.insert(input.end(), 60, answers);
        corpora.add("chunk", "answers-" + std::to_string(answers), input);
    }
}

void add_tiles(const Corpora& corpora) {
    const test::ReferenceTerrain terrain = hills(65, 65);
    HeightsTile tile = terrain.heights_tile({1, 0, 0});
    Bytes whole = {0}, holed = {0};
    encode_heights(tile, whole);
    tile.all_valid = false;
    tile.sample_valid.assign(tile.quanta.size(), 1);
    tile.sample_valid[100] = 0;
    tile.cell_valid.assign(32u * 32u, 1);
    encode_heights(tile, holed);
    corpora.add("heights", "whole", whole);
    corpora.add("heights", "holed", holed);
    // Content: flags of one plane without holes, base, residuals.
    corpora.add("heights", "content", {1, 1 | 1 << 1, 9, 0, 0, 0, 1, 2, 3, 4, 5});
    Bytes imagery = {0};
    append(imagery_payload(), imagery);
    corpora.add("imagery", "payload", imagery);
    corpora.add("imagery", "planes", {1, 1, 2, 8, 9, 1, 7, 0, 1, 4, 0xe4, 0x1b});
    corpora.add("relief", "content", with_setting(1 + 3 * 3, {0, 0, 0, -5, 5}, {1, 0, 0, 0, 0, 0, 0, 0}));
}

void add_texts(const Corpora& corpora) {
    auto path = platform::orbit_path({{0, 0, 0}, {1000, 800, 300}}, {.round = platform::Seconds(10)});
    path.samples.resize(8);
    corpora.add("path", "orbit", bytes_of(platform::path_to_json(path)));
    platform::CameraPath ground = path;
    ground.samples.resize(3);
    for (auto& sample : ground.samples) sample.reference = platform::HeightReference::above_ground;
    corpora.add("path", "ground", bytes_of(platform::path_to_json(ground)));
    corpora.add("telemetry", "frames",
                bytes_of("cframe,time_s,frame_ms,triangles\n0,0.016,12.5,1000\n1,0.033,,1100\n2,0.05,9,\n"));
    corpora.add(
        "telemetry", "summary",
        bytes_of(R"(s{"format": "ridgeline-telemetry-1", "dataset": "a.terrain", "options": {"size": )"
                 R"("640x480"}, "gl_renderer": "x", "frames": 3, "seconds": 0.05, "fps_mean": 60.0, )"
                 R"("frame_ms": {"mean": 10.7, "p99": 12.5}})"));
}

}  // namespace

int main(int argc, char** argv) {
    doctest::Context context;
    context.setAsDefaultForAssertsOutOfTestCases();
    if (argc != 2) {
        std::fprintf(stderr, "use fuzz_corpus FOLDER\n");
        return 2;
    }
    const Corpora corpora(argv[1]);
    add_info_tables_and_store(corpora);
    add_chunks(corpora);
    add_tiles(corpora);
    add_texts(corpora);
    return 0;
}
