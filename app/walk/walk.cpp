#include "ridgeline/app/walk/walk.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>

#include "ridgeline/app/stop_signal.h"
#include "ridgeline/app/walk/walk_session.h"
#include "ridgeline/base/log.h"
#include "ridgeline/base/thread_role.h"
#include "ridgeline/gl/capabilities.h"
#include "ridgeline/gl/debug_output.h"

namespace ridgeline::app {
namespace {

namespace fs = std::filesystem;

// A file that will be written at the end of a long walk must have a place now.
Result<void> check_place_for(const fs::path& file) {
    std::error_code ignored;
    const fs::path directory = file.has_parent_path() ? file.parent_path() : fs::path(".");
    if (!fs::is_directory(directory, ignored))
        return Error{file.string() + ": there is no directory " + directory.string()};
    if (fs::is_directory(file, ignored)) return Error{file.string() + ": is a directory"};
    return {};
}

Result<void> make_directory(const fs::path& directory) {
    std::error_code error;
    fs::create_directories(directory, error);
    if (error) return Error{directory.string() + ": cannot be made: " + error.message()};
    return {};
}

Result<void> prepare_outputs(const WalkOptions& options) {
    for (const Shot& shot : options.shots) RIDGELINE_TRY(check_place_for(shot.file));
    if (!options.record.empty()) RIDGELINE_TRY(check_place_for(options.record));
    if (!options.soak.empty()) RIDGELINE_TRY(check_place_for(options.soak));
    if (!options.telemetry.empty()) RIDGELINE_TRY(make_directory(options.telemetry / "thumbs"));
    return {};
}

// A shot that can never be taken is a mistake to hear of before the walk, not after.
Result<void> check_shots(const WalkOptions& options, const std::optional<platform::ResolvedPath>& path) {
    const auto limit = WalkSession::frame_limit(options, path ? &*path : nullptr);
    for (const Shot& shot : options.shots)
        if (limit && shot.frame >= *limit)
            return Error{"--shot of frame " + std::to_string(shot.frame) + ": the walk ends after frame " +
                         std::to_string(*limit - 1)};
    return {};
}

Result<std::optional<platform::ResolvedPath>> settle_path(const WalkOptions& options,
                                                          const io::Store& store) {
    const bool steered = !options.path && options.drawing == Drawing::window;
    if (steered) return std::optional<platform::ResolvedPath>();
    auto path = resolve_course(store, options.path.value_or(PathChoice{}), options.exaggeration);
    if (!path) return path.error();
    return std::optional(std::move(path).value());
}

Result<std::unique_ptr<platform::Context>> open_context(const WalkOptions& options, const io::Store& store) {
    const bool headless = options.drawing == Drawing::headless;
    auto context = headless
                       ? platform::open_headless({.size_px = options.size_px})
                       : platform::open_window({.title = store.directory().stem().string() + " - Ridgeline",
                                                .size_px = options.size_px});
    if (!context) return context.error();
    RIDGELINE_TRY(gl::load((*context)->gl_loader()));
    gl::enable_debug_output();
    log_line(LogLevel::info, (*context)->description());
    return context;
}

// Imagery that is not shown need not be whole.
Result<io::Store> open_store(const WalkOptions& options) {
    auto store = io::Store::open(options.directory);
    if (store || options.imagery == "on") return store;
    auto terrain = io::Store::open_terrain(options.directory);
    if (terrain) log_line(LogLevel::warn, "walked without its imagery: " + store.error().message);
    return terrain;
}

}  // namespace

Result<void> run_walk(const WalkOptions& options) {
    const std::atomic<bool>& stop = watch_stop_signals();
    set_thread_role(ThreadRole::render, "render");
    RIDGELINE_TRY(prepare_outputs(options));
    const auto store = open_store(options);
    if (!store) return store.error();
    auto path = settle_path(options, *store);
    if (!path) return path.error();
    RIDGELINE_TRY(check_shots(options, *path));
    const auto window = open_context(options, *store);
    if (!window) return window.error();

    using Keep = WalkTelemetry::Keep;
    WalkTelemetry telemetry(options.telemetry.empty() ? Keep::nothing : Keep::frames);
    auto session = WalkSession::create(options, *store, std::move(path).value(), **window, telemetry);
    if (!session) return session.error();
    // What the first draw costs a driver is no frame's.
    (*session)->rehearse();
    telemetry.start({.dataset = options.directory.string(),
                     .gl_renderer = gl::query_capabilities().renderer,
                     .options = described(options)});
    return (*session)->run(stop);
}

}  // namespace ridgeline::app
