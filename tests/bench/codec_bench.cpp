// Rates of the payload codecs on one thread: triangles a second through chunks, bytes of heights a second
// through heights tiles. The terrain is made here; a store's own mix of chunks gives the figures of
// docs/benchmarks.md:
//   bench_codec DIR.terrain
#include <benchmark/benchmark.h>

#include <optional>

#include "ridgeline/io/relief_maker.h"
#include "ridgeline/io/store.h"
#include "support/reference_terrain.h"

using namespace ridgeline;
using namespace ridgeline::io;
using ridgeline::test::ReferenceTerrain;

namespace {

std::optional<Store> store;

struct Payloads {
    NodeId node;
    std::vector<std::uint8_t> heights, mesh;
};

// The finest and the coarser nodes in the shares in which a walk meets them: every `stride`-th node.
std::vector<Payloads> sample_payloads(std::int64_t stride) {
    std::vector<Payloads> all;
    for (std::int64_t i = 0; i < store->grid().node_count(); i += stride) {
        Payloads p{store->grid().node_at(i), {}, {}};
        if (!store->record(p.node).has_data()) continue;
        if (store->read_payload(Layer::heights, p.node, p.heights) &&
            store->read_payload(Layer::mesh, p.node, p.mesh))
            all.push_back(std::move(p));
    }
    return all;
}

void decode_chunks(benchmark::State& state) {
    const auto payloads = sample_payloads(std::max<std::int64_t>(1, store->grid().node_count() / 400));
    ChunkScratch scratch;
    HeightsTile heights;
    std::vector<ChunkVertex> block(1 << 18);
    std::int64_t triangles = 0, chunks = 0;
    for ([[maybe_unused]] auto _ : state)
        for (const Payloads& p : payloads) {
            const NodeRecord& record = store->record(p.node);
            const ChunkView view(std::as_writable_bytes(std::span(block)), record, store->chunk_shape());
            const bool ok = decode_heights(p.heights, store->grid().quads(), heights).ok() &&
                            decode_chunk(store->grid(), p.node, record, store->chunk_spacing(), p.mesh,
                                         heights, scratch, view)
                                .ok();
            if (!ok) return state.SkipWithError("a damaged store");
            triangles += record.triangle_count;
            ++chunks;
        }
    state.counters["triangles/s"] =
        benchmark::Counter(static_cast<double>(triangles), benchmark::Counter::kIsRate);
    state.counters["chunks/s"] = benchmark::Counter(static_cast<double>(chunks), benchmark::Counter::kIsRate);
}

// Decoding leaves behind what encoding does, so a store's own chunks can be asked for their reliefs again.
void make_reliefs(benchmark::State& state) {
    const auto payloads = sample_payloads(std::max<std::int64_t>(1, store->grid().node_count() / 400));
    const ChunkShape shape = store->chunk_shape();
    std::vector<ChunkScratch> scratches(payloads.size());
    std::vector<HeightsTile> tiles(payloads.size());
    std::vector<ChunkVertex> block(1 << 18);
    for (std::size_t i = 0; i < payloads.size(); ++i) {
        const Payloads& p = payloads[i];
        const NodeRecord& record = store->record(p.node);
        const ChunkView view(std::as_writable_bytes(std::span(block)), record, shape);
        if (!decode_heights(p.heights, shape.quads, tiles[i]) ||
            !decode_chunk(store->grid(), p.node, record, store->chunk_spacing(), p.mesh, tiles[i],
                          scratches[i], view))
            return state.SkipWithError("a damaged store");
    }
    ReliefMaker maker;
    std::vector<std::uint8_t> out;
    std::int64_t nodes = 0, bytes = 0;
    for ([[maybe_unused]] auto _ : state)
        for (std::size_t i = 0; i < payloads.size(); ++i) {
            const NodeRecord& record = store->record(payloads[i].node);
            EncodedChunk chunk;
            chunk.min_quanta = record.min_quanta;
            chunk.max_quanta = record.max_quanta;
            ReliefBounds bounds;
            out.clear();
            maker.append(store->grid(), payloads[i].node, shape.relief, scratches[i], tiles[i], chunk, bounds,
                         out);
            bytes += static_cast<std::int64_t>(out.size());
            ++nodes;
        }
    state.counters["nodes/s"] = benchmark::Counter(static_cast<double>(nodes), benchmark::Counter::kIsRate);
    state.counters["bytes a node"] = static_cast<double>(bytes) / static_cast<double>(nodes);
}

void decode_heights_tiles(benchmark::State& state) {
    const auto payloads = sample_payloads(std::max<std::int64_t>(1, store->grid().node_count() / 400));
    HeightsTile heights;
    std::int64_t samples = 0, bytes = 0;
    for ([[maybe_unused]] auto _ : state)
        for (const Payloads& p : payloads) {
            if (!decode_heights(p.heights, store->grid().quads(), heights))
                return state.SkipWithError("a damaged store");
            samples += static_cast<std::int64_t>(heights.quanta.size());
            bytes += static_cast<std::int64_t>(p.heights.size());
        }
    state.counters["samples/s"] =
        benchmark::Counter(static_cast<double>(samples), benchmark::Counter::kIsRate);
    state.counters["bytes a sample"] = static_cast<double>(bytes) / static_cast<double>(samples);
}

void encode_heights_tiles(benchmark::State& state) {
    const auto payloads = sample_payloads(std::max<std::int64_t>(1, store->grid().node_count() / 100));
    std::vector<HeightsTile> tiles(payloads.size());
    for (std::size_t i = 0; i < tiles.size(); ++i)
        if (!decode_heights(payloads[i].heights, store->grid().quads(), tiles[i]))
            return state.SkipWithError("a damaged store");
    std::vector<std::uint8_t> out;
    std::int64_t samples = 0;
    for ([[maybe_unused]] auto _ : state)
        for (const HeightsTile& tile : tiles) {
            out.clear();
            encode_heights(tile, out);
            samples += static_cast<std::int64_t>(tile.quanta.size());
        }
    state.counters["samples/s"] =
        benchmark::Counter(static_cast<double>(samples), benchmark::Counter::kIsRate);
}

// Encoding asks for vertex sets, which a store does not keep: made hills stand in.
void encode_chunks(benchmark::State& state) {
    static const ReferenceTerrain terrain(Grid(513, 513, 64), ReferenceTerrain::random_hills(1, 40.0, 6.0));
    ChunkScratch scratch;
    std::vector<std::uint8_t> out;
    std::int64_t triangles = 0;
    for ([[maybe_unused]] auto _ : state)
        for (std::int64_t i = terrain.grid().first(terrain.grid().finest()); i < terrain.grid().node_count();
             ++i) {
            const NodeId node = terrain.grid().node_at(i);
            out.clear();
            const auto chunk =
                encode_chunk(terrain.grid(), node, ReferenceTerrain::NodeSource(terrain, node), scratch, out);
            if (!chunk) return state.SkipWithError("a chunk too large");
            triangles += chunk->triangle_count;
        }
    state.counters["triangles/s"] =
        benchmark::Counter(static_cast<double>(triangles), benchmark::Counter::kIsRate);
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    benchmark::RegisterBenchmark("encode_chunk", encode_chunks)->Unit(benchmark::kMillisecond);
    if (argc > 1) {
        auto opened = Store::open(argv[1]);
        if (!opened) return std::fprintf(stderr, "bench_codec: %s\n", opened.error().message.c_str()), 1;
        store = std::move(*opened);
        benchmark::RegisterBenchmark("decode_heights_and_chunk", decode_chunks)
            ->Unit(benchmark::kMillisecond);
        benchmark::RegisterBenchmark("make_relief", make_reliefs)->Unit(benchmark::kMillisecond);
        benchmark::RegisterBenchmark("decode_heights", decode_heights_tiles)->Unit(benchmark::kMillisecond);
        benchmark::RegisterBenchmark("encode_heights", encode_heights_tiles)->Unit(benchmark::kMillisecond);
    }
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
