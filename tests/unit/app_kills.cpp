// The program killed while it builds, at random moments of an undisturbed build's time: never a store that
// opens and is wrong, leftovers that do not grow, and the next run ends in the bytes of a build that was let
// alone. A few dozen kills by default, over a hundred of each kind with RIDGELINE_LONG=1.
#include <doctest/doctest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "unit/app_process.h"

using namespace ridgeline::test;
namespace fs = std::filesystem;

namespace {

using Seconds = std::chrono::duration<double>;
using Contents = std::map<std::string, std::string>;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
// The sanitized program takes ten times as long, and dies no otherwise.
constexpr int kUsualKills = 4;
#else
constexpr int kUsualKills = 25;
#endif

int kills_to_try() { return std::getenv("RIDGELINE_LONG") != nullptr ? 120 : kUsualKills; }

// How long an undisturbed run takes.
Seconds time_of(const std::vector<std::string>& arguments) {
    const auto start = std::chrono::steady_clock::now();
    run_well(arguments);
    return std::chrono::steady_clock::now() - start;
}

// False: it had ended before.
bool run_killed(const std::vector<std::string>& arguments, Seconds after) {
    Process process(arguments);
    // The moment itself is what is tried.
    std::this_thread::sleep_for(after);
    kill(process.id(), SIGKILL);
    const Answer answer = process.wait();
    if (answer.status == 128 + SIGKILL) return true;
    CHECK(answer.status == 0);
    return false;
}

// A killed build may leave a mark in what it put in place; the next removes it.
Contents without_mark(Contents contents) {
    contents.erase(".ridgeline-partial");
    return contents;
}

// What is left beside the target; one that opens must be right.
std::vector<fs::path> check_leftovers(const fs::path& folder) {
    std::vector<fs::path> left;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().filename().string().find(".partial-") == std::string::npos) continue;
        left.push_back(entry.path());
        if (run({"info", entry.path(), "--quiet"}).status == 0)
            CHECK(run({"verify", entry.path(), "--quiet"}).status == 0);
    }
    CHECK(left.size() <= 1);
    return left;
}

// Kills spread over a run's time and a little beyond; each lands on what the one before left. What ends before
// its moment counts as no kill.
class Kills {
  public:
    explicit Kills(Seconds undisturbed) : undisturbed_(undisturbed) {}

    template <class Check>
    void run(const std::vector<std::string>& arguments, Check&& check) {
        const int wanted = kills_to_try();
        int killed = 0, runs = 0;
        for (; killed < wanted && runs < 4 * wanted; ++runs) {
            const Seconds after = undisturbed_ * moment_(random_);
            CAPTURE(after.count());
            killed += run_killed(arguments, after) ? 1 : 0;
            check();
        }
        MESSAGE(killed, " of ", runs, " runs killed within ", undisturbed_.count(), " s");
        CHECK(killed > 0);
    }

  private:
    Seconds undisturbed_;
    std::mt19937 random_{20};
    std::uniform_real_distribution<double> moment_{0.0, 1.05};
};

struct Rasters {
    Folder folder;
    std::string dem = folder.file("dem.tif"), rgb = folder.file("rgb.tif");
    std::string store = folder.file("a.terrain");

    Rasters() { run_well({"synth", dem, "--size", "400", "--imagery", rgb, "--quiet"}); }
};

}  // namespace

TEST_CASE(
    "a build killed at any moment leaves no store or the whole one; run again it ends in the same bytes") {
    const Rasters rasters;
    const std::vector<std::string> build = {"build",     rasters.dem, "--out", rasters.store, "--imagery",
                                            rasters.rgb, "--jobs",    "2",     "--quiet"};
    const Seconds undisturbed = time_of(build);
    const Contents whole = contents_of(rasters.store);
    fs::remove_all(rasters.store);
    Kills(undisturbed).run(build, [&] {
        check_leftovers(rasters.folder.path());
        if (!fs::exists(rasters.store)) return;
        CHECK(without_mark(contents_of(rasters.store)) == whole);
        // What refuses to build has tidied up.
        check_failure(build, "exists already");
        CHECK(contents_of(rasters.store) == whole);
        CHECK(names_in(rasters.folder.path()) == std::set<std::string>{"a.terrain", "dem.tif", "rgb.tif"});
        fs::remove_all(rasters.store);
    });
    run_well(build);
    CHECK(contents_of(rasters.store) == whole);
    CHECK(names_in(rasters.folder.path()) == std::set<std::string>{"a.terrain", "dem.tif", "rgb.tif"});
}

TEST_CASE("a build that replaces a store, killed at any moment, leaves the old one or the new one") {
    const Rasters rasters;
    run_well({"build", rasters.dem, "--out", rasters.store, "--tile", "33", "--quiet"});
    const Contents old = contents_of(rasters.store);
    const std::vector<std::string> build = {"build",  rasters.dem, "--out",   rasters.store,
                                            "--jobs", "2",         "--quiet", "--force"};
    const Seconds undisturbed = time_of(build);
    const Contents whole = contents_of(rasters.store);
    REQUIRE(whole != old);
    bool replaced = true;
    Kills(undisturbed).run(build, [&] {
        const Contents now = without_mark(contents_of(rasters.store));
        CHECK((now == whole || (!replaced && now == old)));
        check_leftovers(rasters.folder.path());
        // The old one again, for the next kill.
        fs::remove_all(rasters.store);
        fs::create_directory(rasters.store);
        for (const auto& [name, text] : old)
            std::ofstream(fs::path(rasters.store) / name, std::ios::binary) << text;
        replaced = false;
    });
    run_well(build);
    CHECK(contents_of(rasters.store) == whole);
    CHECK(names_in(rasters.folder.path()) == std::set<std::string>{"a.terrain", "dem.tif", "rgb.tif"});
}

TEST_CASE(
    "imagery for a store that stands, killed at any moment: the old store stands, or the new one, whole") {
    const Rasters rasters;
    run_well({"build", rasters.dem, "--out", rasters.store, "--quiet"});
    const Contents old = contents_of(rasters.store);
    const std::vector<std::string> add = {"build",  "--out", rasters.store, "--imagery", rasters.rgb,
                                          "--jobs", "2",     "--quiet",     "--force"};
    const Seconds undisturbed = time_of(add);
    const Contents pictured = contents_of(rasters.store);
    bool has_imagery = true;
    Kills(undisturbed).run(add, [&] {
        const Contents now = without_mark(contents_of(rasters.store));
        CHECK((now == pictured || (!has_imagery && now == old)));
        has_imagery = now == pictured;
        check_leftovers(rasters.folder.path());
        // Of what is shared by hard links nothing may go with the imagery.
        if (!has_imagery) return;
        fs::remove(fs::path(rasters.store) / "imagery.bin");
        fs::remove(fs::path(rasters.store) / "imagery.tiles");
        std::ofstream(fs::path(rasters.store) / "terrain.json.new", std::ios::binary)
            << old.at("terrain.json");
        fs::rename(fs::path(rasters.store) / "terrain.json.new", fs::path(rasters.store) / "terrain.json");
        has_imagery = false;
    });
    run_well(add);
    CHECK(contents_of(rasters.store) == pictured);
    CHECK(names_in(rasters.folder.path()) == std::set<std::string>{"a.terrain", "dem.tif", "rgb.tif"});
}
