#include "ridgeline/telemetry/recorder.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>

#include "ridgeline/base/json_text.h"
#include "ridgeline/base/whole_file.h"

namespace ridgeline::telemetry {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

// A directory of its own, removed at the end.
class ScratchDirectory {
  public:
    explicit ScratchDirectory(const std::string& name)
        : path_(fs::temp_directory_path() / ("ridgeline-" + name + "-" + std::to_string(getpid()))) {
        fs::remove_all(path_);
    }
    ~ScratchDirectory() { fs::remove_all(path_); }
    ScratchDirectory(const ScratchDirectory&) = delete;
    ScratchDirectory& operator=(const ScratchDirectory&) = delete;
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
    return parts;
}

std::string text_of(const fs::path& file) {
    auto text = read_text_file(file);
    REQUIRE(text.ok());
    return *text;
}

FrameRecord frame_of(std::int64_t number) {
    FrameRecord record;
    record.frame = number;
    record.time_s = static_cast<double>(number) / 60.0;
    record.frame_ms = 10.0 + static_cast<double>(number % 10);
    record.triangles = 1000 * number;
    record.tiles_missing = number % 4 == 0 ? 2 : 0;
    record.heights_missing = number % 5 == 1 ? 3 : 0;
    record.imagery_missing = number % 10 == 3 ? 5 : 0;
    record.ram_cache_bytes = 100 - number;
    record.eye_east_m = 1234567.89;
    return record;
}

TEST_CASE("frames.csv has the promised columns first, and a cell for each column in each row") {
    const std::string promised =
        "frame,time_s,frame_ms,cpu_render_ms,selection_ms,gpu_ms,triangles,draws,nodes_visited,nodes_frustum_"
        "culled,"
        "nodes_horizon_culled,nodes_drawn,tiles_wanted,tiles_missing,eye_lift_m,bytes_read,bytes_uploaded,"
        "ram_cache_bytes,gpu_cache_bytes,";
    CHECK(csv_header().starts_with(promised));
    std::string row;
    append_csv_row(frame_of(3), row);
    const auto cells = split(row, ',');
    REQUIRE(cells.size() == frame_columns().size());
    CHECK(row.ends_with('\n'));
    for (std::size_t column = 0; column < cells.size(); ++column) {
        const double expected = frame_columns()[column].value(frame_of(3));
        CAPTURE(frame_columns()[column].name);
        if (std::isnan(expected))
            CHECK(split(cells[column], '\n')[0] == "nan");
        else
            CHECK(std::stod(cells[column]) == doctest::Approx(expected).epsilon(1e-8));
    }
}

TEST_CASE("what was recorded is what is written, across blocks of memory") {
    const ScratchDirectory scratch("recorder-written");
    Recorder recorder;
    recorder.describe({.dataset = "alps.terrain",
                       .gl_renderer = "llvmpipe",
                       .options = {{"surface", std::string("mesh")},
                                   {"pixel_error", 1.5},
                                   {"frames", std::int64_t{20000}},
                                   {"headless", true}}});
    constexpr std::int64_t kFrames = 20'000;
    for (std::int64_t number = 0; number < kFrames; ++number) {
        recorder.add_frame(frame_of(number));
        if (number >= 3) recorder.set_gpu_ms(number - 3, 4.0);
    }
    recorder.tiles().requested += 7;
    recorder.tiles().evicted += 2;
    recorder.request_to_ready_ns().record(50'000'000);
    recorder.request_to_drawn_frames().record(4);
    REQUIRE(recorder.write(scratch.path() / "new" / "folder").ok());

    const fs::path written = scratch.path() / "new" / "folder";
    const auto lines = split(text_of(written / "frames.csv"), '\n');
    REQUIRE(lines.size() == kFrames + 1);
    CHECK(lines[0] + '\n' == csv_header());
    CHECK(lines[17'000].starts_with("16999,"));

    const Json summary = parse_json(text_of(written / "summary.json"));
    CHECK(summary.at("format") == "ridgeline-telemetry-1");
    CHECK(summary.at("dataset") == "alps.terrain");
    CHECK(summary.at("gl_renderer") == "llvmpipe");
    CHECK(summary.at("options") ==
          Json({{"surface", "mesh"}, {"pixel_error", 1.5}, {"frames", 20000}, {"headless", true}}));
    CHECK(summary.at("frames") == kFrames);
    CHECK(summary.at("seconds") > 0.0);
    CHECK(summary.at("fps_mean").get<double>() * summary.at("seconds").get<double>() ==
          doctest::Approx(kFrames));
    CHECK(summary.at("frame_ms") ==
          Json({{"mean", 14.5}, {"p50", 14.0}, {"p95", 19.0}, {"p99", 19.0}, {"p999", 19.0}, {"max", 19.0}}));
    CHECK(summary.at("gpu_ms").at("mean") == 4.0);
    CHECK(summary.at("selection_ms").at("max") == 0.0);
    CHECK(summary.at("request_to_ready_ms").at("max") == 50.0);
    CHECK(summary.at("request_to_drawn_frames").at("p50") == 4.0);
    CHECK(summary.at("per_frame").at("triangles") == doctest::Approx(1000.0 * (kFrames - 1) / 2));
    for (const auto* key :
         {"nodes_drawn", "nodes_frustum_culled", "nodes_horizon_culled", "bytes_uploaded", "bytes_read"})
        CHECK(summary.at("per_frame").at(key) == 0.0);
    CHECK(summary.at("tiles") == Json({{"requested", 7},
                                       {"loaded", 0},
                                       {"cancelled", 0},
                                       {"failed", 0},
                                       {"retried", 0},
                                       {"evicted", 2}}));
    CHECK(summary.at("frames_with_missing_tiles") == kFrames / 4);
    CHECK(summary.at("frames_with_missing_heights") == kFrames / 5);
    CHECK(summary.at("frames_with_missing_imagery") == kFrames / 10);
    CHECK(summary.at("peak_rss_bytes") > 0);
    CHECK(summary.at("ram_cache_bytes_max") == 100);
    CHECK(summary.at("gpu_cache_bytes_max") == 0);
    CHECK(!parse_json(text_of(written / "trace.json")).is_discarded());
    // Nothing else is left beside them.
    CHECK(std::distance(fs::directory_iterator(written), fs::directory_iterator()) == 3);
}

TEST_CASE("the metrics are the numbers of summary.json by their joined keys") {
    Recorder recorder;
    recorder.describe({.dataset = "", .gl_renderer = "", .options = {{"fov", 75.0}}});
    recorder.add_frame(frame_of(0));
    const auto run = recorder.summary();
    const Json json = parse_json(to_json(run));
    for (const auto& metric : metrics(run)) {
        const auto& [key, value] = metric;
        CAPTURE(metric.first);
        Json::json_pointer pointer;
        for (const auto& part : split(key, '.')) pointer /= part;
        CHECK(json.at(pointer).get<double>() == value);
        CHECK(key.find("options") == std::string::npos);
    }
    CHECK(metrics(run).size() > 40);
}

TEST_CASE("a run without frames is written too") {
    const ScratchDirectory scratch("recorder-empty");
    Recorder recorder;
    REQUIRE(recorder.write(scratch.path()).ok());
    CHECK(parse_json(text_of(scratch.path() / "summary.json")).at("frame_ms").at("p999") == 0.0);
    CHECK(text_of(scratch.path() / "frames.csv") == csv_header());
}

TEST_CASE("names that are no UTF-8 do not stop the writing") {
    Recorder recorder;
    recorder.describe({.dataset = "caf\xe9.terrain", .gl_renderer = ""});
    CHECK(!parse_json(to_json(recorder.summary())).is_discarded());
}

TEST_CASE("a directory that cannot be made is an error that names it") {
    const ScratchDirectory scratch("recorder-blocked");
    fs::create_directories(scratch.path());
    REQUIRE(write_whole_file(scratch.path() / "file", std::string_view("x")).ok());
    Recorder recorder;
    const auto written = recorder.write(scratch.path() / "file" / "telemetry");
    REQUIRE(!written.ok());
    CHECK(written.error().message.find("telemetry") != std::string::npos);
}

void use_cpu(std::int64_t duration_ns) {
    const auto clock = ThreadCpuClock::of_this_thread();
    const auto end = clock.used_ns() + duration_ns;
    while (clock.used_ns() < end) {
    }
}

TEST_CASE(
    "CPU time is counted by group, from start() to finish(), of threads that live and that have ended") {
    constexpr std::int64_t kWorkNs = 20'000'000;
    Recorder recorder;
    recorder.count_this_thread(CpuGroup::render);
    use_cpu(kWorkNs);
    recorder.start();
    std::thread([&] {
        recorder.count_this_thread(CpuGroup::io);
        use_cpu(kWorkNs);
        recorder.release_this_thread();
    }).join();
    std::atomic<bool> worked{false};
    std::atomic<bool> end{false};
    std::thread worker([&] {
        recorder.count_this_thread(CpuGroup::workers);
        use_cpu(2 * kWorkNs);
        worked = true;
        while (!end) std::this_thread::yield();
        recorder.release_this_thread();
    });
    while (!worked) {
    }
    recorder.finish();
    const auto run = recorder.summary();
    end = true;
    worker.join();
    const auto used_ns = [&run](double percent) { return percent / 100.0 * run.seconds * 1e9; };
    CHECK(used_ns(run.cpu_percent.io) >= kWorkNs);
    CHECK(used_ns(run.cpu_percent.workers) >= 2 * kWorkNs);
    CHECK(run.cpu_percent.io < run.cpu_percent.workers);
    CHECK(run.cpu_percent.render <= 100.1);
    CHECK(run.cpu_percent.process >= run.cpu_percent.io + run.cpu_percent.workers);
    // Settled: asking again after more work gives the same.
    use_cpu(kWorkNs);
    CHECK(recorder.summary().cpu_percent.process == run.cpu_percent.process);
    CHECK(recorder.summary().seconds == run.seconds);
}

}  // namespace
}  // namespace ridgeline::telemetry
