// bench_pager DIR.terrain: how fast chunks of a store come in, and what that costs the render thread.
//
// Asks for the nodes of the finest level in the order of the Hilbert curve, 200 at a time, each group once
// the one before is in RAM, as fast as they come. Rows: decoding alone on one thread without a pager, then
// the pager with 1 to 3 workers, then the pager on a disk that takes 50 ms a read. Files are read once
// beforehand, so they come from the page cache. "render" is the time that the render thread spends in the
// pager per frame with 200 nodes wanted and used.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>
#include <vector>

#include "ridgeline/io/store.h"
#include "ridgeline/jobs/job_system.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/telemetry/clock.h"

namespace {

using namespace ridgeline;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kWanted = 200;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<pager::NodeIndex> finest_nodes(const io::Store& store, std::size_t most) {
    const io::Grid& grid = store.grid();
    std::vector<pager::NodeIndex> nodes;
    for (std::int64_t i = grid.first(grid.finest()); i < grid.node_count(); ++i)
        if (store.records()[static_cast<std::size_t>(i)].has_data())
            nodes.push_back(static_cast<pager::NodeIndex>(i));
    const auto place = [&](pager::NodeIndex node) {
        const io::NodeId id = grid.node_at(node);
        return io::hilbert_index(id.x, id.y, 20);
    };
    std::sort(nodes.begin(), nodes.end(), [&](auto a, auto b) { return place(a) < place(b); });
    nodes.resize(std::min(nodes.size(), most) / kWanted * kWanted);
    return nodes;
}

// Milliseconds of CPU per chunk.
double decode_alone(const io::Store& store, const std::vector<pager::NodeIndex>& nodes) {
    const pager::TileSource source = pager::tile_source(store);
    const pager::ChunkDecoder decoder(source.grid, source.spacing, source.relief);
    pager::DecodeScratch scratch;
    std::vector<std::byte> block;
    std::vector<std::uint8_t> mesh, heights;
    const auto cpu = telemetry::ThreadCpuClock::of_this_thread();
    std::int64_t used_ns = 0;
    for (const pager::NodeIndex node : nodes) {
        const io::NodeId id = source.grid.node_at(node);
        block.resize(source.chunk_bytes(node));
        if (!store.read_payload(io::Layer::mesh, id, mesh) ||
            !store.read_payload(io::Layer::heights, id, heights))
            return 0.0;
        const std::int64_t start_ns = cpu.used_ns();
        if (!decoder.decode({id, &source.record(node), mesh, heights}, scratch, block)) return 0.0;
        used_ns += cpu.used_ns() - start_ns;
    }
    return telemetry::milliseconds(used_ns) / static_cast<double>(nodes.size());
}

struct Paged {
    double chunks_per_s = 0.0, read_mib_per_s = 0.0, chunks_per_read = 0.0;
    double cpu_ms = 0.0;     // per chunk, all threads
    double render_us = 0.0;  // per frame, CPU
};

Paged page(const io::Store& store, const std::vector<pager::NodeIndex>& nodes, int workers,
           const pager::FaultSpec& fault) {
    jobs::JobSystem jobs({.workers = workers, .on_worker_start = {}, .on_worker_stop = {}});
    pager::PagerOptions options;
    options.ram_bytes = std::uint64_t{64} << 20;
    options.fault = fault;
    auto pager = pager::Pager::create(pager::tile_source(store), jobs, options);
    if (!pager || !pager->load_level0()) return {};
    std::uint32_t frame = 0;
    std::int64_t render_ns = 0;
    const auto cpu = telemetry::ThreadCpuClock::of_this_thread();
    const std::int64_t cpu_start_ns = telemetry::process_cpu_ns();
    const auto start = Clock::now();
    for (std::size_t first = 0; first < nodes.size(); first += kWanted) {
        const std::span wanted = std::span(nodes).subspan(first, kWanted);
        const auto in_ram = [&](pager::NodeIndex node) {
            return pager->state(node) == pager::TileState::ready;
        };
        do {
            const std::int64_t frame_start_ns = cpu.used_ns();
            pager->begin_frame(++frame, pager::Seconds(0.0));
            pager->ready_to_upload(0);
            pager->touch(wanted);
            pager->request(wanted);
            render_ns += cpu.used_ns() - frame_start_ns;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        } while (!std::all_of(wanted.begin(), wanted.end(), in_ram));
    }
    const double seconds = seconds_since(start);
    const pager::PagerCounters counts = pager->counters();
    const auto loaded = static_cast<double>(counts.loaded);
    return {.chunks_per_s = loaded / seconds,
            .read_mib_per_s = static_cast<double>(counts.bytes_read) / seconds / (1 << 20),
            .chunks_per_read = loaded / static_cast<double>(counts.reads),
            .cpu_ms = telemetry::milliseconds(telemetry::process_cpu_ns() - cpu_start_ns) / loaded,
            .render_us = telemetry::milliseconds(render_ns) * 1e3 / frame};
}

void print(const char* name, const Paged& paged, double alone_ms) {
    std::printf("%-22s %9.0f %9.1f %12.1f %10.3f %6.2f %10.0f\n", name, paged.chunks_per_s,
                paged.read_mib_per_s, paged.chunks_per_read, paged.cpu_ms, paged.cpu_ms / alone_ms,
                paged.render_us);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return std::fprintf(stderr, "usage: bench_pager DIR.terrain\n"), 2;
    const auto store = io::Store::open(argv[1]);
    if (!store) return std::fprintf(stderr, "bench_pager: error: %s\n", store.error().message.c_str()), 1;
    const auto nodes = finest_nodes(*store, 4000);
    const double alone = decode_alone(*store, nodes);
    std::printf("%-22s %9s %9s %12s %10s %6s %10s\n", "variant", "chunks/s", "MiB/s in", "chunks/read",
                "CPU ms", "ratio", "render us");
    std::printf("%-22s %9s %9s %12s %10.3f %6.2f\n", "decode, one thread", "", "", "", alone, 1.0);
    const char* names[] = {"pager, 1 worker", "pager, 2 workers", "pager, 3 workers"};
    for (int workers = 1; workers <= 3; ++workers)
        print(names[workers - 1], page(*store, nodes, workers, {}), alone);
    pager::FaultSpec slow;
    slow.delay = std::chrono::milliseconds(50);
    print("pager, 50 ms a read", page(*store, nodes, 1, slow), alone);
    return 0;
}
