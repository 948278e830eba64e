// Literature: the horizon paper (3.1) for chunks from propagated vertex errors; the tower paper for M x N
// roots. Their builders hold the raster in memory; here every step but one looks at a block and its apron,
// and the one that cannot (errors of coarse vertices depend on finer ones, across all blocks) works on a 64th
// of the samples.
#include "ridgeline/build/builder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "ridgeline/base/thread_annotations.h"
#include "ridgeline/build/block_pipeline.h"
#include "ridgeline/build/build_memory.h"
#include "ridgeline/build/detail_windows.h"
#include "ridgeline/build/height_rows.h"
#include "ridgeline/build/imagery/image_rows.h"
#include "ridgeline/build/imagery/imagery_layer.h"
#include "ridgeline/build/node_heights.h"
#include "ridgeline/build/row_builder.h"
#include "ridgeline/build/scratch_raster.h"
#include "ridgeline/jobs/job_system.h"

namespace ridgeline::build {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

int thread_count(const BuildOptions& options) {
    return options.jobs > 0 ? options.jobs
                            : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

BuildShape shape_of(const HeightRows& rows, const BuildOptions& options) {
    return {io::Grid(rows.info().width, rows.info().height, options.tile - 1), rows.may_have_nodata(),
            rows.natural_rows()};
}

// The calling thread works with the others, but a job system has one worker at least.
jobs::JobSystemOptions job_options(int threads) {
    jobs::JobSystemOptions options;
    options.workers = std::max(1, threads - 1);
    return options;
}

float error_m(float quanta, double quantum_m) {
    const auto nearest = static_cast<float>(static_cast<double>(quanta) * quantum_m);
    return quanta > 0.0f ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : 0.0f;
}

Result<void> check_stop(const BuildOptions& options) {
    if (options.stop && options.stop->load(std::memory_order_relaxed))
        return Error{options.out.string() + ": stopped before it was complete; nothing was left"};
    return {};
}

Result<void> report_progress(const BuildOptions& options, Stage stage, std::int64_t done,
                             std::int64_t total) {
    if (options.progress) options.progress(stage, done, total);
    return check_stop(options);
}

// Before the heights, whose arrays then have the memory to themselves, and so that bad pictures fail early.
Result<std::optional<io::ImageryInfo>> build_imagery(TexelRows* rows, const BuildOptions& options,
                                                     const io::StoreWriter& writer) {
    if (rows == nullptr) return std::optional<io::ImageryInfo>();
    LayerOptions layer;
    layer.threads = thread_count(options);
    layer.memory_bytes = options.memory_bytes;
    layer.encoder = options.encoder;
    layer.progress = [&](ImageryStage stage, std::int64_t done, std::int64_t total) {
        return stage == ImageryStage::tiles ? report_progress(options, Stage::imagery, done, total)
                                            : check_stop(options);
    };
    auto info = build_imagery_layer(*rows, writer.directory(), writer.scratch(), layer);
    if (!info) return info.error();
    return std::optional(std::move(*info));
}

// One build from first row to rename; steps in the order of their names in run().
class Build {
  public:
    Build(HeightRows& rows, const BuildOptions& options, io::StoreWriter writer, ScratchRaster raster,
          std::optional<io::ImageryInfo> imagery)
        : rows_(rows),
          imagery_(std::move(imagery)),
          options_(options),
          writer_(std::move(writer)),
          raster_(std::move(raster)),
          grid_(rows.info().width, rows.info().height, options.tile - 1),
          blocks_(grid_),
          metric_(options.metric, rows.info()),
          lattice_(grid_, metric_),
          detail_windows_(grid_),
          thresholds_(grid_, blocks_, {}),
          has_data_(static_cast<std::size_t>(grid_.node_count()), 0),
          own_errors_(static_cast<std::size_t>(grid_.node_count()), 0.0f),
          jobs_(job_options(thread_count(options))) {
        for (int slot = 0; slot < 2 * thread_count(options) + 1; ++slot) {
            slots_.push_back(std::make_unique<BlockSlot>());
            slots_.back()->packed.resize(static_cast<std::size_t>(kWindow) * kWindow);
            slots_.back()->counts = std::make_unique<BlockCounts>(grid_, blocks_);
        }
        writer_.begin(grid_);
    }

    Result<BuildReport> run();

  private:
    using Step = Result<void> (Build::*)();
    Result<void> timed(Stage stage, Step step);

    Result<void> read();
    Result<void> fill();
    Result<void> find_errors();
    Result<void> choose_thresholds();
    Result<void> make_tiles();
    Result<void> write();

    Result<void> check_stop() const;
    Result<void> report_progress(Stage stage, std::int64_t done, std::int64_t total) const;

    Result<void> submit_block(BlockPipeline& pipeline, std::int64_t block);
    Result<void> submit_readable_rows(BlockPipeline& pipeline);
    void work_on_errors(TileMaker& maker, BlockSlot& slot);
    Result<void> take_errors(BlockSlot& slot);
    void pass_has_data_up();
    Result<void> make_coarse_tiles(const TileInputs& inputs);
    Result<void> take_tiles(BlockSlot& slot);
    void settle_records();
    io::NodeRecord& record(io::NodeId node) { return writer_.records()[place(node)]; }
    std::size_t place(io::NodeId node) const { return static_cast<std::size_t>(grid_.linear(node)); }

    HeightRows& rows_;
    std::optional<io::ImageryInfo> imagery_;  // written already
    const BuildOptions& options_;
    io::StoreWriter writer_;
    ScratchRaster raster_;
    io::Grid grid_;
    BlockGrid blocks_;
    VertexMetric metric_;
    CoarseLattice lattice_;
    DetailWindows detail_windows_;
    std::optional<VoidFill> fill_;
    Thresholds thresholds_;
    std::optional<Levels> levels_;
    std::vector<std::uint8_t> chosen_;
    std::vector<std::uint8_t> has_data_;           // by linear place
    std::vector<float> own_errors_;                // quanta, by linear place
    std::vector<io::ReliefBounds> coarse_bounds_;  // of nodes larger than a block: of their children
    std::vector<std::int64_t> deferred_;
    std::int64_t next_row_of_blocks_ = 0;
    std::int64_t blocks_done_ = 0;
    BuildReport report_;

    MakerPool makers_;
    std::vector<std::unique_ptr<BlockSlot>> slots_;
    jobs::JobSystem jobs_;
};

Result<BuildReport> Build::run() {
    const auto start = Clock::now();
    RIDGELINE_TRY(timed(Stage::read, &Build::read));
    RIDGELINE_TRY(timed(Stage::fill, &Build::fill));
    RIDGELINE_TRY(timed(Stage::errors, &Build::find_errors));
    RIDGELINE_TRY(timed(Stage::thresholds, &Build::choose_thresholds));
    RIDGELINE_TRY(timed(Stage::tiles, &Build::make_tiles));
    RIDGELINE_TRY(timed(Stage::write, &Build::write));
    report_.seconds = seconds_since(start);
    return report_;
}

Result<void> Build::timed(Stage stage, Step step) {
    const auto start = Clock::now();
    auto result = (this->*step)();
    report_.stage_seconds[static_cast<std::size_t>(stage)] = seconds_since(start);
    return result;
}

Result<void> Build::check_stop() const { return build::check_stop(options_); }

Result<void> Build::report_progress(Stage stage, std::int64_t done, std::int64_t total) const {
    return build::report_progress(options_, stage, done, total);
}

Result<void> Build::submit_block(BlockPipeline& pipeline, std::int64_t block) {
    auto slot = pipeline.next();
    if (!slot) return slot.error();
    (*slot)->block = block;
    RIDGELINE_TRY(raster_.read_window(blocks_.origin(block), (*slot)->packed));
    pipeline.submit();
    return {};
}

// --- read: the source into the scratch raster; errors of blocks without voids follow at its heels ----------

Result<void> Build::submit_readable_rows(BlockPipeline& pipeline) {
    for (; next_row_of_blocks_ < blocks_.rows(); ++next_row_of_blocks_) {
        const std::int64_t needed = next_row_of_blocks_ * kBlock + kBlock + kWindowApron + 1;
        if (raster_.readable_rows() < std::min(needed, grid_.height())) return {};
        for (std::int64_t column = 0; column < blocks_.columns(); ++column)
            RIDGELINE_TRY(submit_block(pipeline, next_row_of_blocks_ * blocks_.columns() + column));
    }
    return {};
}

Result<void> Build::read() {
    BlockPipeline pipeline(
        jobs_, makers_, slots_, [this](TileMaker& maker, BlockSlot& slot) { work_on_errors(maker, slot); },
        [this](BlockSlot& slot) { return take_errors(slot); });
    const std::int64_t band = band_rows(shape_of(rows_, options_));
    std::vector<std::int32_t> quanta;
    for (std::int64_t row = 0; row < grid_.height(); row += band) {
        const std::int64_t rows = std::min(band, grid_.height() - row);
        quanta.resize(static_cast<std::size_t>(rows * grid_.width()));
        RIDGELINE_TRY(rows_.read(row, rows, quanta));
        RIDGELINE_TRY(raster_.append(quanta));
        RIDGELINE_TRY(submit_readable_rows(pipeline));
        RIDGELINE_TRY(report_progress(Stage::read, row + rows, grid_.height()));
    }
    RIDGELINE_TRY(pipeline.drain());
    if (raster_.statistics().valid > 0) return {};
    const auto& sources = rows_.info().sources;
    return Error{(sources.empty() ? std::string("source") : sources.front()) +
                 ": no height at all: every sample is nodata"};
}

void Build::work_on_errors(TileMaker& maker, BlockSlot& slot) {
    const io::LatticePoint origin = blocks_.origin(slot.block);
    maker.window.unpack(grid_, origin, slot.packed);
    slot.deferred = maker.window.has_voids() && !fill_;
    if (slot.deferred) return;
    if (maker.window.has_voids()) maker.window.fill(*fill_);
    maker.window.pad();
    find_vertex_errors(maker.window.quanta(), maker.window.flags(), metric_, maker.errors);
    lattice_.hand_up(blocks_, slot.block, maker.window, maker.errors);
    slot.counts->clear();
    slot.counts->add_fine(maker.errors);
    slot.counts->finish();
    slot.nodes_with_data.clear();
    for_each_node(grid_, origin, grid_.finest(), [&](io::NodeId node) {
        if (has_samples(grid_, node, origin, maker.window)) slot.nodes_with_data.push_back(node);
    });
}

Result<void> Build::take_errors(BlockSlot& slot) {
    if (slot.deferred) {
        deferred_.push_back(slot.block);
        return {};
    }
    thresholds_.add(slot.block, Thresholds::Part::fine, *slot.counts);
    for (const io::NodeId node : slot.nodes_with_data) has_data_[place(node)] = 1;
    return report_progress(Stage::errors, ++blocks_done_, blocks_.count());
}

// --- fill and errors: what had to wait for the whole raster ------------------------------------------------

Result<void> Build::fill() {
    if (deferred_.empty()) return {};
    VoidFill fill(grid_);
    std::int64_t done = 0;
    BlockPipeline pipeline(
        jobs_, makers_, slots_,
        [&](TileMaker& maker, BlockSlot& slot) {
            maker.window.unpack(grid_, blocks_.origin(slot.block), slot.packed);
            maker.window.set_means(blocks_, slot.block, fill);
        },
        [&](BlockSlot&) { return report_progress(Stage::fill, ++done, blocks_.count()); });
    for (std::int64_t block = 0; block < blocks_.count(); ++block)
        RIDGELINE_TRY(submit_block(pipeline, block));
    RIDGELINE_TRY(pipeline.drain());
    fill.finish();
    fill_ = std::move(fill);
    return {};
}

Result<void> Build::find_errors() {
    BlockPipeline pipeline(
        jobs_, makers_, slots_, [this](TileMaker& maker, BlockSlot& slot) { work_on_errors(maker, slot); },
        [this](BlockSlot& slot) { return take_errors(slot); });
    for (const std::int64_t block : deferred_) RIDGELINE_TRY(submit_block(pipeline, block));
    return pipeline.drain();
}

// --- thresholds --------------------------------------------------------------------------------------------

void Build::pass_has_data_up() {
    for (std::int64_t i = grid_.node_count() - 1; i >= grid_.first(1); --i)
        if (has_data_[static_cast<std::size_t>(i)] != 0) has_data_[place(grid_.node_at(i).parent())] = 1;
    // Roots always have tiles, so that there is something to draw wherever the camera starts.
    std::fill_n(has_data_.begin(), grid_.first(1), std::uint8_t{1});
}

Result<void> Build::choose_thresholds() {
    lattice_.finish();
    Mutex adding;
    jobs_.parallel_for_ranges(0, blocks_.count(), 16, [&](std::int64_t first, std::int64_t last) {
        BlockCounts counts(grid_, blocks_);
        for (std::int64_t block = first; block < last; ++block) {
            counts.clear();
            counts.add_coarse(lattice_, blocks_.origin(block));
            counts.finish();
            const MutexLock lock(adding);
            thresholds_.add(block, Thresholds::Part::coarse, counts);
        }
    });
    pass_has_data_up();
    std::vector<std::int64_t> nodes;
    for (int level = 0; level < grid_.levels(); ++level)
        nodes.push_back(std::count(has_data_.begin() + grid_.first(level),
                                   has_data_.begin() + grid_.first(level + 1), 1));
    chosen_ = thresholds_.choose(nodes);
    levels_.emplace(grid_, chosen_);
    return report_progress(Stage::thresholds, 1, 1);
}

// --- tiles -------------------------------------------------------------------------------------------------

Result<void> Build::make_tiles() {
    const CornerSurfaces corners(grid_, blocks_, lattice_, *levels_);
    FineVertices fine_vertices(blocks_);
    const TileInputs inputs{
        grid_,     blocks_,       metric_,        lattice_, *levels_, corners, fill_ ? &*fill_ : nullptr,
        has_data_, fine_vertices, options_.relief};
    coarse_bounds_.resize(static_cast<std::size_t>(grid_.first(blocks_.top_level())));
    blocks_done_ = 0;
    BlockPipeline pipeline(
        jobs_, makers_, slots_,
        [&](TileMaker& maker, BlockSlot& slot) {
            slot.batch.clear();
            maker.make_block(inputs, slot.block, slot.packed, slot.batch);
        },
        [&](BlockSlot& slot) -> Result<void> {
            RIDGELINE_TRY(take_tiles(slot));
            return report_progress(Stage::tiles, ++blocks_done_, blocks_.count());
        });
    for (std::int64_t block = 0; block < blocks_.count(); ++block)
        RIDGELINE_TRY(submit_block(pipeline, block));
    RIDGELINE_TRY(pipeline.drain());
    return make_coarse_tiles(inputs);
}

Result<void> Build::make_coarse_tiles(const TileInputs& inputs) {
    BlockPipeline pipeline(
        jobs_, makers_, slots_,
        [&](TileMaker& maker, BlockSlot& slot) {
            slot.batch.clear();
            maker.make_coarse(inputs, slot.node, slot.bounds, slot.batch);
        },
        [&](BlockSlot& slot) -> Result<void> {
            RIDGELINE_TRY(check_stop());
            return take_tiles(slot);
        });
    for (int level = blocks_.top_level() - 1; level >= 0; --level) {
        for (std::int64_t i = grid_.first(level); i < grid_.first(level + 1); ++i) {
            if (has_data_[static_cast<std::size_t>(i)] == 0) continue;
            const auto slot = pipeline.next();
            if (!slot) return slot.error();
            (*slot)->node = grid_.node_at(i);
            (*slot)->bounds = std::move(coarse_bounds_[static_cast<std::size_t>(i)]);
            pipeline.submit();
        }
        // Parents need what their children hand up.
        RIDGELINE_TRY(pipeline.drain());
    }
    return {};
}

Result<void> Build::take_tiles(BlockSlot& slot) {
    const TileBatch& batch = slot.batch;
    if (batch.failure) return *batch.failure;
    std::span<const std::uint8_t> payloads = batch.payloads;
    for (const TileBatch::Entry& entry : batch.entries) {
        RIDGELINE_TRY(writer_.put(io::Layer::heights, entry.node, payloads.first(entry.heights_bytes)));
        detail_windows_.offer(entry.node, payloads.first(entry.heights_bytes));
        payloads = payloads.subspan(entry.heights_bytes);
        RIDGELINE_TRY(writer_.put(io::Layer::mesh, entry.node, payloads.first(entry.mesh_bytes)));
        payloads = payloads.subspan(entry.mesh_bytes);
        io::NodeRecord& to = record(entry.node);
        to.flags = io::NodeRecord::kHasData | (entry.has_mask ? io::NodeRecord::kHasMask : 0u);
        to.vertex_count = entry.chunk.vertex_count;
        to.index_count = entry.chunk.index_count;
        to.triangle_count = entry.chunk.triangle_count;
        to.min_quanta = entry.chunk.min_quanta;
        to.max_quanta = entry.chunk.max_quanta;
    }
    for (const auto& [node, quanta] : batch.errors) {
        float& own = own_errors_[place(node)];
        own = std::max(own, quanta);
    }
    for (const auto& [node, bounds] : batch.bounds)
        coarse_bounds_[place(node.parent())].add_child(options_.relief, node.quarter(), bounds);
    return {};
}

// Errors never grow downwards, so they go up from the finest level.
void Build::settle_records() {
    for (std::int64_t i = grid_.node_count() - 1; i >= 0; --i) {
        const io::NodeId node = grid_.node_at(i);
        io::NodeRecord& own = record(node);
        if (!own.has_data()) continue;
        own.error_m =
            std::max(own.error_m, error_m(own_errors_[static_cast<std::size_t>(i)], rows_.info().quantum_m));
        if (node.level == 0) continue;
        io::NodeRecord& parent = record(node.parent());
        parent.error_m = std::max(parent.error_m, own.error_m);
    }
}

// --- write -------------------------------------------------------------------------------------------------

Result<void> Build::write() {
    settle_records();
    io::TerrainInfo info = rows_.info();
    info.tile = options_.tile;
    info.metric = metric_name(options_.metric);
    info.relief = options_.relief;
    info.min_height_m = info.height_m(raster_.statistics().min_quanta);
    info.max_height_m = info.height_m(raster_.statistics().max_quanta);
    info.invalid_samples = grid_.width() * grid_.height() - raster_.statistics().valid;
    for (const std::uint8_t code : chosen_) {
        info.thresholds_m.push_back(largest_error(code) * info.quantum_m);
        if (metric_.has_cones())
            info.cone_thresholds_m.push_back(largest_error_of_square(code) * info.quantum_m);
    }
    const auto findings = rows_.findings();
    info.notes.insert(info.notes.end(), findings.begin(), findings.end());
    info.generator = "ridgeline " RIDGELINE_VERSION;
    auto detail = detail_windows_.calibrate(info);
    if (!detail) return detail.error();
    info.detail = std::move(*detail);
    info.imagery = std::move(imagery_);
    auto written = writer_.finish(std::move(info), [this](std::int64_t done, std::int64_t total) {
        return report_progress(Stage::write, done, total).ok();
    });
    RIDGELINE_TRY(check_stop());
    if (!written) return written.error();
    report_.info = std::move(*written);
    return {};
}

}  // namespace

const char* stage_name(Stage stage) {
    constexpr const char* kNames[kStages] = {"imagery",    "read",  "fill", "errors",
                                             "thresholds", "tiles", "write"};
    return kNames[static_cast<std::size_t>(stage)];
}

Result<BuildReport> build_from_rows(HeightRows& rows, const BuildOptions& options, TexelRows* imagery) {
    const auto start = Clock::now();
    const auto affordable = affordable_threads(shape_of(rows, options), options.memory_bytes);
    if (!affordable) return Error{options.out.string() + ": " + affordable.error().message};
    BuildOptions fitting = options;
    fitting.jobs = std::min(thread_count(options), *affordable);
    auto writer = io::StoreWriter::create(options.out, options.replace);
    if (!writer) return writer.error();
    auto layer = build_imagery(imagery, fitting, *writer);
    if (!layer) return layer.error();
    const double imagery_seconds = seconds_since(start);
    auto raster = ScratchRaster::create(writer->scratch() / "samples", rows.info().width, rows.info().height);
    if (!raster) return raster.error();
    auto report = Build(rows, fitting, std::move(*writer), std::move(*raster), std::move(*layer)).run();
    if (!report) return report;
    report->seconds += imagery_seconds;
    report->stage_seconds[static_cast<std::size_t>(Stage::imagery)] = imagery_seconds;
    return report;
}

Result<BuildReport> build_terrain(const BuildOptions& options) {
    if (options.tile != 33 && options.tile != 65 && options.tile != 129)
        return Error{"tiles of " + std::to_string(options.tile) +
                     " samples are not possible: choose 33, 65 or 129"};
    if (!options.relief.fits(options.tile - 1))
        return Error{"a relief of " + std::to_string(options.relief.bands) + " bands, " +
                     std::to_string(options.relief.steps) + " steps and " +
                     std::to_string(options.relief.cells) + " cells does not fit tiles of " +
                     std::to_string(options.tile) + " samples"};
    DemOptions dem;
    dem.sources = options.sources;
    dem.crs = options.crs;
    dem.nodata = options.nodata;
    dem.cache_bytes = raster_cache_bytes(options.memory_bytes);
    dem.threads = thread_count(options);
    auto rows = open_dem(dem);
    if (!rows) return rows.error();
    if (options.imagery.empty()) return build_from_rows(**rows, options);
    auto imagery = open_imagery({options.imagery, dem.cache_bytes, dem.threads}, (*rows)->info());
    if (!imagery) return imagery.error();
    return build_from_rows(**rows, options, imagery->get());
}

}  // namespace ridgeline::build
