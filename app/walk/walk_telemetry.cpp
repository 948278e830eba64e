#include "ridgeline/app/walk/walk_telemetry.h"

#include <utility>

#include "ridgeline/telemetry/allocation_counter.h"
#include "ridgeline/telemetry/clock.h"

namespace ridgeline::app {
namespace {

using telemetry::milliseconds;
using telemetry::now_ns;

// CPU shares are shown over this; shorter, and they flicker.
constexpr std::int64_t kCpuSpan_ns = 500'000'000;
// Looking costs tens of microseconds: no frame is to pay that each time.
constexpr std::int64_t kProcessSpan_ns = 1'000'000'000;

}  // namespace

WalkTelemetry::WalkTelemetry(Keep keep)
    : keep_(keep), render_clock_(telemetry::ThreadCpuClock::of_this_thread()) {
    recorder_.count_this_thread(telemetry::CpuGroup::render);
}

void WalkTelemetry::worker_started() {
    recorder_.count_this_thread(telemetry::CpuGroup::workers);
    const MutexLock lock(mutex_);
    workers_.push_back(telemetry::ThreadCpuClock::of_this_thread());
}

void WalkTelemetry::start(telemetry::RunDescription description) {
    recorder_.describe(std::move(description));
    recorder_.start();
    resume();
    cpu_sample_ = sample();
}

void WalkTelemetry::resume() {
    frame_end_ns_ = now_ns();
    render_cpu_ns_ = render_clock_.used_ns();
    heap_allocations_ = telemetry::heap_allocations();
}

const telemetry::FrameRecord& WalkTelemetry::add_frame(double time_s, const glm::dvec3& eye_m,
                                                       const StageReport& report, TerrainStage& stage) {
    const std::int64_t now = now_ns(), cpu = render_clock_.used_ns();
    const std::uint64_t allocations = telemetry::heap_allocations();
    const std::uint64_t read = stage.pager().counters().bytes_read;
    const pager::PagerCounters imagery = stage.pager().counters(pager::TileKind::imagery);
    look_at_process(now);
    report_ = report;
    record_ = {};
    record_.frame = frames_++;
    record_.time_s = time_s;
    record_.frame_ms = milliseconds(now - frame_end_ns_);
    record_.cpu_render_ms = milliseconds(cpu - render_cpu_ns_);
    record_.selection_ms = report.selection_ms;
    record_.selection_wait_ms = report.selection_wait_ms;
    record_.upload_ms = report.upload_ms;
    record_.triangles = static_cast<std::int64_t>(report.surface.triangles);
    record_.draws = report.surface.draws;
    record_.nodes_visited = report.selection.visited;
    record_.nodes_frustum_culled = report.selection.frustum_culled;
    record_.nodes_horizon_culled = report.selection.horizon_culled;
    record_.nodes_drawn = report.selection.drawn;
    record_.tiles_wanted = report.selection.wanted;
    record_.tiles_missing = report.selection.missing;
    record_.eye_lift_m = report.eye_lift_m;
    record_.bytes_read = static_cast<std::int64_t>(read - bytes_read_);
    record_.bytes_uploaded = static_cast<std::int64_t>(report.bytes_uploaded);
    record_.ram_cache_bytes = static_cast<std::int64_t>(stage.pager().ram_bytes_used());
    record_.gpu_cache_bytes = static_cast<std::int64_t>(stage.gpu_cache_bytes());
    record_.heap_allocations = static_cast<std::int64_t>(allocations - heap_allocations_);
    record_.eye_east_m = eye_m.x;
    record_.eye_north_m = eye_m.y;
    record_.eye_height_m = eye_m.z + report.eye_lift_m;
    record_.shadow_casters = report.selection.casters;
    record_.shadow_triangles = static_cast<std::int64_t>(report.shadow.triangles);
    record_.schedule_ms = report.schedule_ms;
    if (report.readback_age) record_.readback_age_frames = static_cast<double>(*report.readback_age);
    record_.readback_stalls = static_cast<std::int64_t>(report.readback_stalls);
    record_.tiles_scheduled = static_cast<std::int64_t>(report.tiles_scheduled);
    record_.heights_wanted = static_cast<std::int64_t>(report.heights_wanted);
    record_.heights_missing = static_cast<std::int64_t>(report.heights_missing);
    record_.imagery_wanted = static_cast<std::int64_t>(report.imagery_wanted);
    record_.imagery_missing = static_cast<std::int64_t>(report.imagery_missing);
    record_.imagery_requested = static_cast<std::int64_t>(imagery.requested - imagery_requested_);
    record_.imagery_loaded = static_cast<std::int64_t>(imagery.loaded - imagery_loaded_);
    record_.imagery_gpu_bytes = static_cast<std::int64_t>(stage.gpu_imagery_bytes());
    record_.rss_bytes = process_.rss_bytes;
    record_.handles = process_.handles;
    if (keep_ == Keep::frames) recorder_.add_frame(record_);
    while (const auto measured = stage.take_gpu_time()) {
        gpu_ms_ = measured->time.count();
        if (keep_ == Keep::frames) recorder_.set_gpu_ms(static_cast<std::int64_t>(measured->frame), gpu_ms_);
    }
    frame_end_ns_ = now;
    render_cpu_ns_ = cpu;
    bytes_read_ = read;
    imagery_requested_ = imagery.requested;
    imagery_loaded_ = imagery.loaded;
    // Taken last: what recording itself allocates is not the frame's.
    heap_allocations_ = telemetry::heap_allocations();
    return record_;
}

void WalkTelemetry::look_at_process(std::int64_t wall_ns) {
    if (process_.wall_ns != 0 && wall_ns - process_.wall_ns < kProcessSpan_ns) return;
    process_ = {wall_ns, static_cast<std::int64_t>(telemetry::current_rss_bytes()),
                telemetry::open_handles()};
}

void WalkTelemetry::leave_out() {
    frame_end_ns_ = now_ns();
    render_cpu_ns_ = render_clock_.used_ns();
    heap_allocations_ = telemetry::heap_allocations();
}

HudFigures WalkTelemetry::figures(const TerrainStage& stage) const {
    const auto bytes = [](std::int64_t value) { return static_cast<std::uint64_t>(value); };
    return {.frame_ms = record_.frame_ms,
            .render_cpu_ms = record_.cpu_render_ms,
            .selection_ms = record_.selection_ms,
            .gpu_ms = gpu_ms_,
            .triangles = report_.surface.triangles,
            .draws = report_.surface.draws,
            .nodes = report_.selection.drawn,
            .tiles_wanted = report_.selection.wanted,
            .tiles_missing = report_.selection.missing,
            .bytes_read = bytes(record_.bytes_read),
            .bytes_uploaded = report_.bytes_uploaded,
            .ram_bytes = bytes(record_.ram_cache_bytes),
            .ram_capacity_bytes = stage.pager().ram_bytes_capacity(),
            .gpu_bytes = bytes(record_.gpu_cache_bytes),
            .gpu_capacity_bytes = stage.gpu_cache_capacity_bytes(),
            .heights_wanted = report_.heights_wanted,
            .heights_missing = report_.heights_missing,
            .heights_bytes = stage.gpu_heights_bytes(),
            .imagery_wanted = report_.imagery_wanted,
            .imagery_missing = report_.imagery_missing,
            .imagery_bytes = stage.gpu_imagery_bytes(),
            .eye_lift_m = report_.eye_lift_m,
            .casters = report_.selection.casters,
            .shadow_triangles = report_.shadow.triangles,
            .shadow_map_bytes = stage.shadow_map_bytes()};
}

WalkTelemetry::CpuSample WalkTelemetry::sample() {
    CpuSample now{now_ns(), telemetry::process_cpu_ns(), render_clock_.used_ns(), 0};
    const MutexLock lock(mutex_);
    for (const telemetry::ThreadCpuClock& worker : workers_) now.workers_ns += worker.used_ns();
    return now;
}

HudCpu WalkTelemetry::cpu() {
    if (now_ns() - cpu_sample_.wall_ns < kCpuSpan_ns) return cpu_;
    const CpuSample now = sample();
    const auto percent = [&](std::int64_t used_ns) {
        return 100.0 * static_cast<double>(used_ns) / static_cast<double>(now.wall_ns - cpu_sample_.wall_ns);
    };
    cpu_ = {percent(now.render_ns - cpu_sample_.render_ns), percent(now.workers_ns - cpu_sample_.workers_ns),
            percent(now.process_ns - cpu_sample_.process_ns)};
    cpu_sample_ = now;
    return cpu_;
}

void WalkTelemetry::finish(const pager::Pager& pager) {
    const pager::PagerCounters counters = pager.counters();
    telemetry::TileCounters& tiles = recorder_.tiles();
    tiles.requested = counters.requested;
    tiles.loaded = counters.loaded;
    tiles.cancelled = counters.cancelled;
    tiles.failed = counters.failed;
    tiles.retried = counters.retried;
    tiles.evicted = counters.evicted;
    recorder_.finish();
}

Result<void> WalkTelemetry::write(const std::filesystem::path& directory, const pager::Pager& pager) {
    finish(pager);
    return recorder_.write(directory);
}

}  // namespace ridgeline::app
