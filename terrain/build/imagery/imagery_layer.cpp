#include "ridgeline/build/imagery/imagery_layer.h"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <thread>

#include "ridgeline/build/build_memory.h"
#include "ridgeline/build/imagery/image_rows.h"
#include "ridgeline/build/imagery/imagery_builder.h"
#include "ridgeline/io/imagery_writer.h"
#include "ridgeline/io/store.h"
#include "ridgeline/io/store_update.h"

namespace ridgeline::build {
namespace {

constexpr int kFewestThreads = 2;

Result<int> affordable_threads(const io::ImageryInfo& info, const LayerOptions& options,
                               const ImageEncoder& encoder) {
    const int threads = std::max(options.threads, kFewestThreads);
    const std::uint64_t cache = raster_cache_bytes(options.memory_bytes);
    for (int fewer = threads; fewer >= kFewestThreads; --fewer)
        if (imagery_memory_bytes(info, fewer, encoder) + cache <= options.memory_bytes) return fewer;
    // The cache is a quarter of all, so a third of the rest.
    const std::uint64_t least = imagery_memory_bytes(info, kFewestThreads, encoder) * 4 / 3;
    return Error{"imagery of " + std::to_string(info.width) + " x " + std::to_string(info.height) +
                 " texels cannot be built in " + format_bytes(options.memory_bytes) + ": use --memory " +
                 std::to_string(least / 1_MiB + 1) + "MiB or more"};
}

}  // namespace

Result<io::ImageryInfo> build_imagery_layer(TexelRows& rows, const std::filesystem::path& directory,
                                            const std::filesystem::path& scratch,
                                            const LayerOptions& options) {
    const auto report = [&](ImageryStage stage, std::int64_t done, std::int64_t total) {
        return options.progress ? options.progress(stage, done, total) : Result<void>();
    };
    io::ImageryInfo info = rows.info();
    const auto cpu_encoder = options.encoder == nullptr ? make_cpu_encoder() : nullptr;
    ImageEncoder& encoder = options.encoder == nullptr ? *cpu_encoder : *options.encoder;
    const auto threads = affordable_threads(info, options, encoder);
    if (!threads) return threads.error();
    auto writer = io::ImageryWriter::create(directory, scratch, info.grid());
    if (!writer) return writer.error();
    {
        jobs::JobSystemOptions job_options;
        job_options.workers = *threads - 1;
        jobs::JobSystem jobs(job_options);
        const ImageryWork work{rows, encoder, jobs, [&](std::int64_t done, std::int64_t total) {
                                   return report(ImageryStage::tiles, done, total);
                               }};
        RIDGELINE_TRY(build_tiles(work, *writer));
    }
    // The caller's own Error where it stopped the writing.
    Result<void> reported;
    const auto written = writer->finish(info, [&](std::int64_t done, std::int64_t total) {
        reported = report(ImageryStage::write, done, total);
        return reported.ok();
    });
    RIDGELINE_TRY(reported);
    RIDGELINE_TRY(written);
    // As large as the layer itself, and of no use any more.
    std::error_code ignored;
    std::filesystem::remove(scratch / io::layer_file(io::Layer::imagery), ignored);
    return info;
}

Result<AddImageryReport> add_imagery(const AddImageryOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    auto update = io::StoreUpdate::begin(options.store, options.replace);
    if (!update) return update.error();
    LayerOptions layer;
    layer.threads = options.jobs > 0 ? options.jobs : static_cast<int>(std::thread::hardware_concurrency());
    layer.memory_bytes = options.memory_bytes;
    layer.encoder = options.encoder;
    layer.progress = [&](ImageryStage stage, std::int64_t done, std::int64_t total) -> Result<void> {
        if (options.progress) options.progress(stage, done, total);
        if (options.stop && options.stop->load(std::memory_order_relaxed))
            return Error{options.store.string() +
                         ": stopped before its imagery was complete; it is as it was"};
        return {};
    };
    const ImageSources sources{options.sources, raster_cache_bytes(options.memory_bytes), layer.threads};
    auto rows = open_imagery(sources, update->info());
    if (!rows) return rows.error();
    const auto imagery = build_imagery_layer(**rows, update->directory(), update->scratch(), layer);
    if (!imagery) return imagery.error();
    auto info = update->finish(*imagery);
    if (!info) return info.error();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    return AddImageryReport{std::move(*info), taken.count()};
}

}  // namespace ridgeline::build
