// Walks through the program's front door: what they leave behind, also where something of it fails.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ridgeline/base/json_text.h"
#include "support/gl_context.h"
#include "unit/app_process.h"

using namespace ridgeline::test;

namespace {

struct WalkedStore {
    Folder folder;
    std::string store = folder.file("dem.terrain");

    WalkedStore() {
        const std::string dem = folder.file("dem.tif");
        REQUIRE(run({"synth", dem, "--size", "300", "--quiet"}).status == 0);
        REQUIRE(run({"build", dem, "--out", store, "--tile", "33", "--quiet"}).status == 0);
    }
    std::vector<std::string> walk(std::vector<std::string> more) const {
        std::vector<std::string> arguments = {"walk", store, "--headless", "--size", "64x48"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
    nlohmann::json summary(const std::string& telemetry) const {
        return ridgeline::parse_json(file_text(folder.path() / telemetry / "summary.json"));
    }
};

bool can_draw() { return static_cast<bool>(GlContext()); }

}  // namespace

TEST_CASE("A walk says in one line what it did, and writes what it was asked for") {
    if (!can_draw()) return;
    const WalkedStore walked;
    const Answer answer =
        run(walked.walk({"--frames", "3", "--shot", "2:" + walked.folder.file("a.png"), "--record",
                         walked.folder.file("r.json"), "--telemetry", walked.folder.file("t")}));
    CHECK(answer.status == 0);
    CHECK(answer.err.empty());
    CHECK(std::count(answer.out.begin(), answer.out.end(), '\n') == 1);
    CHECK(answer.out.find("3 frames") != std::string::npos);
    CHECK(std::filesystem::exists(walked.folder.file("a.png")));
    CHECK(std::filesystem::exists(walked.folder.file("t") + "/thumbs/0.png"));
    CHECK(ridgeline::parse_json(file_text(walked.folder.file("r.json")))["samples"].size() == 3);
    CHECK(walked.summary("t")["options"]["path"] == "orbit");
    CHECK(run(walked.walk({"--frames", "1", "--quiet"})).out.empty());
}

TEST_CASE("A picture that cannot be written costs neither the recording nor the telemetry") {
    if (!can_draw()) return;
    const WalkedStore walked;
    const Answer answer =
        run(walked.walk({"--frames", "3", "--shot", "0:/proc/none.png", "--record",
                         walked.folder.file("r.json"), "--telemetry", walked.folder.file("t")}));
    CHECK(answer.status == 1);
    CHECK(answer.error_lines() == 1);
    CHECK(answer.err.find("/proc/none.png") != std::string::npos);
    CHECK(std::filesystem::exists(walked.folder.file("r.json")));
    CHECK(walked.summary("t")["frames"] == 3);
}

TEST_CASE("A picture that the walk never came to is told") {
    if (!can_draw()) return;
    const WalkedStore walked;
    check_failure(walked.walk({"--seconds", "0.2", "--shot", "100000000:" + walked.folder.file("z.png")}),
                  "--shot of frame 100000000");
    check_failure(walked.walk({"--frames", "2", "--shot", "2:" + walked.folder.file("z.png")}),
                  "--shot of frame 2");
}

TEST_CASE("Every refinement criterion walks") {
    if (!can_draw()) return;
    const WalkedStore walked;
    for (const char* criterion : {"screen_error", "distance", "roughness", "density"})
        CHECK(run(walked.walk({"--frames", "2", "--quiet", "--criterion", criterion, "--path", "ground"}))
                  .status == 0);
    check_usage_error(walked.walk({"--criterion", "best"}), "--criterion");
}

TEST_CASE("Injected faults last until their frame, however often a frame is made ready") {
    if (!can_draw()) return;
    const WalkedStore walked;
    const auto failed = [&](const std::string& until, std::vector<std::string> more) {
        more.insert(more.end(),
                    {"--fault", "error=1,until=" + until, "--telemetry", walked.folder.file("t")});
        REQUIRE(run(walked.walk(more)).status == 0);
        return walked.summary("t")["tiles"]["failed"].get<int>();
    };
    CHECK(failed("0", {"--frames", "2", "--wait-for-tiles", "--pixel-error", "0.1"}) == 0);
    CHECK(failed("1", {"--frames", "2", "--wait-for-tiles", "--pixel-error", "0.1"}) > 0);
}

TEST_CASE("A walk that is watched leaves its seconds behind, and says where they are too few to tell") {
    if (!can_draw()) return;
    const WalkedStore walked;
    const std::string seconds = walked.folder.file("s.csv");
    check_failure(walked.walk({"--frames", "3", "--soak", seconds}), "--soak");
    CHECK(file_text(seconds).starts_with("wall_s,frames,rss_bytes,"));
    check_failure(walked.walk({"--frames", "3", "--soak", "/proc/none/s.csv"}), "/proc/none/s.csv");
}

TEST_CASE("frames.csv says what the process holds") {
    if (!can_draw()) return;
    const WalkedStore walked;
    CHECK(run(walked.walk({"--frames", "2", "--telemetry", walked.folder.file("t")})).status == 0);
    const std::string csv = file_text(walked.folder.path() / "t" / "frames.csv");
    CHECK(csv.substr(0, csv.find('\n')).ends_with(",rss_bytes,handles"));
    CHECK(csv.find(",0,0\n") == std::string::npos);
}
