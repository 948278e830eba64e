// From made-up mountains to a store and back, through the program's front door: what it prints, what it
// leaves behind, and what it says when a file is damaged, in the way, or the user has changed their mind.
#include <doctest/doctest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "ridgeline/base/json_text.h"
#include "unit/app_process.h"

using namespace ridgeline::test;

namespace {

// A DEM of a few nodes and its store.
struct SmallStore {
    Folder folder;
    std::string dem = folder.file("dem.tif");
    std::string store = folder.file("dem.terrain");

    SmallStore() {
        run_well({"synth", dem, "--size", "200", "--spacing", "25", "--seed", "3", "--quiet"});
        run_well({"build", dem, "--out", store, "--tile", "33", "--quiet"});
    }
    nlohmann::json info() const { return ridgeline::parse_json(run_well({"info", store, "--json"}).out); }
};

std::string place(double east, double north) { return std::to_string(east) + "," + std::to_string(north); }

void change_byte(const std::filesystem::path& path, std::uintmax_t at) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(static_cast<std::streamoff>(at));
    const char changed = static_cast<char>(file.get() ^ 0x40);
    file.seekp(static_cast<std::streamoff>(at));
    file.put(changed);
    REQUIRE(file.good());
}

}  // namespace

TEST_CASE("a store tells what it holds, to people and as JSON") {
    const SmallStore small;
    const nlohmann::json info = small.info();
    for (const char* key : {"crs", "bounds", "levels", "roots", "tile", "spacing_m", "quantum_m",
                            "height_range_m", "layers", "triangles", "metric", "provenance"})
        CHECK_MESSAGE(info.contains(key), key);
    CHECK(info["tile"] == 33);
    CHECK(info["metric"] == "cone");
    CHECK(info["spacing_m"] == nlohmann::json({25.0, 25.0}));
    CHECK(info["bounds"][2].get<double>() - info["bounds"][0].get<double>() == doctest::Approx(199 * 25.0));
    CHECK(info["height_range_m"][0] < info["height_range_m"][1]);
    for (const char* layer : {"heights", "mesh"})
        for (const char* key : {"tiles", "bytes", "levels", "spacing_m"})
            CHECK_MESSAGE(info["layers"][layer].contains(key), layer << "." << key);
    CHECK(info["crs_authority"] == "EPSG:32633");
    const std::string shown = run_well({"info", small.store}).out;
    CHECK(shown.find("200 x 200") != std::string::npos);
    CHECK(shown.find("WGS 84 / UTM zone 33N (EPSG:32633)") != std::string::npos);
}

TEST_CASE("heights come one a line, in the order asked, with three decimals") {
    const SmallStore small;
    const nlohmann::json bounds = small.info()["bounds"];
    const std::string corner = place(bounds[0], bounds[1]);
    const std::string other = place(bounds[2], bounds[3]);
    const Answer first = run_well({"height", small.store, "--at", corner});
    const Answer second = run_well({"height", small.store, "--at", other});
    CHECK(first.out.find('.') == first.out.size() - 5);  // d.ddd and the line's end
    CHECK(run_well({"height", small.store, "--at", corner, "--at", other}).out == first.out + second.out);
    CHECK(run_well({"height", small.store, "--at", other, corner}).out == second.out + first.out);
}

TEST_CASE("with --detail the source's samples keep their heights, and there is ground between them") {
    const SmallStore small;
    const nlohmann::json info = small.info();
    CHECK(info["detail"]["gains"].size() == 8);
    CHECK(run_well({"info", small.store}).out.find("8 octaves foretold") != std::string::npos);
    const nlohmann::json bounds = info["bounds"];
    std::vector<std::string> samples = {"--at"}, between = {"--at"};
    for (int i = 0; i < 40; ++i) {
        const double east = bounds[0].get<double>() + 25.0 * (3 + 4 * i),
                     north = bounds[1].get<double>() + 25.0 * (5 + 3 * i);
        samples.push_back(place(east, north));
        between.push_back(place(east + 9.0, north + 4.0));
    }
    const auto heights = [&](const std::vector<std::string>& places, const char* levels) {
        std::vector<std::string> arguments = {"height", small.store, "--detail", levels};
        arguments.insert(arguments.end(), places.begin(), places.end());
        return run_well(arguments).out;
    };
    for (const char* levels : {"0", "1", "3", "8"}) CHECK(heights(samples, levels) == heights(samples, "0"));
    CHECK(heights(between, "3") != heights(between, "0"));
    CHECK(heights(between, "3") == heights(between, "3"));
    // The places' corners lie within the terrain.
    CHECK(run_well({"height", small.store, "--detail", "8", "--at", place(bounds[2], bounds[3])}).out ==
          run_well({"height", small.store, "--at", place(bounds[2], bounds[3])}).out);
}

TEST_CASE("places may be given in another system") {
    const SmallStore small;
    const nlohmann::json info = small.info();
    REQUIRE(info["crs"].get<std::string>().find("UTM zone 33N") != std::string::npos);
    // The meridian of zone 33 is 15 degrees east, and the raster lies around it at 47 degrees north.
    const Answer by_degrees = run_well({"height", small.store, "--crs", "EPSG:4326", "--at", "15.0,47.0"});
    CHECK(std::stod(by_degrees.out) >= info["height_range_m"][0].get<double>());
    check_failure({"height", small.store, "--crs", "EPSG:999999", "--at", "15,47"}, "EPSG:999999");
}

TEST_CASE("a place outside fails and prints nothing, whatever stands beside it; negative places are places") {
    const SmallStore small;
    const nlohmann::json bounds = small.info()["bounds"];
    const std::string inside = place(bounds[0], bounds[1]);
    const std::vector<std::string> arguments = {"height", small.store, "--at", inside, "-100.5,-200"};
    check_failure(arguments, "-100.5");
    CHECK(run(arguments).out.empty());
}

TEST_CASE("a store stands in the way unless it is to be replaced, and what is no store is never replaced") {
    const SmallStore small;
    check_failure({"build", small.dem, "--out", small.store}, "--force");
    run_well({"verify", small.store, "--quiet"});
    run_well({"build", small.dem, "--out", small.store, "--force", "--quiet"});

    std::filesystem::create_directory(small.folder.file("photos"));
    std::ofstream(small.folder.file("photos/cat.jpg")) << "cat";
    check_failure({"build", small.dem, "--out", small.folder.file("photos"), "--force"}, "photos");
    CHECK(file_text(small.folder.file("photos/cat.jpg")) == "cat");
}

TEST_CASE("a symbolic link to a store is read as one, and called what it is where a store is to be built") {
    const SmallStore small;
    const std::string link = small.folder.file("link.terrain");
    std::filesystem::create_directory_symlink(small.store, link);
    run_well({"verify", link, "--quiet"});
    check_failure({"build", small.dem, "--out", link, "--quiet"}, "link.terrain: is a symbolic link");
    check_failure({"build", small.dem, "--out", link, "--force", "--quiet"}, "is a symbolic link");
    CHECK(std::filesystem::is_symlink(link));
}

TEST_CASE("a build leaves folders alone that only look like a killed build's") {
    const SmallStore small;
    for (const char* name : {"new.terrain.partial-mine", "new.terrain.partial-12-0"}) {
        std::filesystem::create_directory(small.folder.file(name));
        std::ofstream(small.folder.file(name) + "/notes.txt") << "precious";
    }
    run_well({"build", small.dem, "--out", small.folder.file("new.terrain"), "--quiet"});
    for (const char* name : {"new.terrain.partial-mine", "new.terrain.partial-12-0"})
        CHECK(file_text(small.folder.file(name) + "/notes.txt") == "precious");
}

TEST_CASE("synth replaces a file only with --force, and nothing but a file") {
    const Folder folder;
    const std::string survey = folder.file("survey.tif");
    std::ofstream(survey) << "years of work";
    std::filesystem::create_directory(folder.file("folder.tif"));
    std::filesystem::create_symlink("survey.tif", folder.file("link.tif"));
    const auto before = names_in(folder.path());
    check_failure({"synth", survey, "--size", "17", "--quiet"}, "survey.tif: exists already; --force");
    check_failure({"synth", folder.file("link.tif"), "--size", "17", "--quiet"}, "link.tif: exists already");
    check_failure({"synth", folder.file("link.tif"), "--size", "17", "--force"}, "is no file");
    // Were it not refused first, this would compute for minutes.
    check_failure({"synth", folder.file("folder.tif"), "--size", "65537", "--force"}, "is no file");
    CHECK(file_text(survey) == "years of work");
    run_well({"synth", survey, "--size", "17", "--quiet", "--force"});
    CHECK(file_text(survey).starts_with("II*"));
    CHECK(names_in(folder.path()) == before);
}

TEST_CASE("verify passes what is whole and names what is damaged") {
    const SmallStore small;
    CHECK(run_well({"verify", small.store}).out.find("whole") != std::string::npos);
    for (const char* file : {"heights.tiles", "mesh.tiles", "nodes.bin"}) {
        const std::filesystem::path path = std::filesystem::path(small.store) / file;
        const auto middle = std::filesystem::file_size(path) / 2;
        change_byte(path, middle);
        check_failure({"verify", small.store, "--quiet"}, small.store);
        change_byte(path, middle);
    }
    run_well({"verify", small.store, "--quiet"});
}

TEST_CASE("verify finds whatever terrain.json says wrongly, and bytes that belong to nothing") {
    const SmallStore small;
    const std::filesystem::path store = small.store;
    const std::string json = file_text(store / "terrain.json");
    nlohmann::json said = ridgeline::parse_json(json);
    const auto check_falsified = [&](const nlohmann::json::json_pointer& what, const nlohmann::json& value) {
        INFO(what.to_string());
        nlohmann::json falsified = said;
        REQUIRE(falsified[what] != value);
        falsified[what] = value;
        std::ofstream(store / "terrain.json", std::ios::binary) << ridgeline::json_text(falsified, 2) << "\n";
        check_failure({"verify", small.store, "--quiet"}, "terrain.json");
        check_failure({"info", small.store, "--quiet"}, "terrain.json");
    };
    using Pointer = nlohmann::json::json_pointer;
    check_falsified(Pointer("/frame/west_m"), 1.0);
    check_falsified(Pointer("/triangles"), 1);
    check_falsified(Pointer("/triangles"), -5);
    check_falsified(Pointer("/heights/invalid_samples"), 77);
    check_falsified(Pointer("/layers/heights/bytes"), 7);
    check_falsified(Pointer("/layers/mesh/tiles"), 7);
    check_falsified(Pointer("/heights/range_m/1"), 9000.0);
    check_falsified(Pointer("/thresholds_m/0"), 1e9);
    check_falsified(Pointer("/provenance/generator"), "somebody else");
    std::ofstream(store / "terrain.json", std::ios::binary) << json;
    run_well({"verify", small.store, "--quiet"});

    for (const char* file : {"heights.tiles", "mesh.tiles", "nodes.bin"}) {
        const auto size = std::filesystem::file_size(store / file);
        std::ofstream(store / file, std::ios::binary | std::ios::app) << "five.";
        check_failure({"verify", small.store, "--quiet"}, file);
        std::filesystem::resize_file(store / file, size);
    }
    change_byte(store / "nodes.bin", 12);  // a header's word that means nothing yet
    check_failure({"verify", small.store, "--quiet"}, "nodes.bin");
}

TEST_CASE("a build that its memory is too small for says how much it needs, and that much does") {
    const SmallStore small;
    const std::string out = small.folder.file("other.terrain");
    check_failure({"build", small.dem, "--out", out, "--tile", "33", "--memory", "1", "--quiet"}, "--memory");
    const std::string why =
        run({"build", small.dem, "--out", out, "--tile", "33", "--memory", "1", "--quiet"}).err;
    const std::string intro = "use --memory ";
    const auto at = why.find(intro);
    REQUIRE(at != std::string::npos);
    const std::string least =
        why.substr(at + intro.size(), why.find(' ', at + intro.size()) - at - intro.size());
    INFO(least);
    run_well({"build", small.dem, "--out", out, "--tile", "33", "--memory", least, "--quiet"});
    CHECK(file_text(out + "/mesh.tiles") == file_text(small.store + "/mesh.tiles"));
}

TEST_CASE("what cannot be read or written fails with its name, and leaves nothing") {
    const Folder folder;
    std::ofstream(folder.file("words.tif")) << "no raster at all";
    const auto before = names_in(folder.path());
    check_failure({"build", folder.file("absent.tif"), "--out", folder.file("x.terrain"), "--quiet"},
                  "absent.tif");
    check_failure({"build", folder.file("words.tif"), "--out", folder.file("x.terrain"), "--quiet"},
                  "words.tif");
    const std::string once = run({"build", "absent.tif", "--out", folder.file("x.terrain"), "--quiet"}).err;
    CHECK(once == "ridgeline: error: absent.tif: cannot be read: No such file or directory\n");
    check_failure({"synth", folder.file("no/such/folder.tif"), "--size", "64", "--quiet"}, "folder.tif");
    check_failure({"info", folder.file("absent.terrain")}, "absent.terrain");
    CHECK(names_in(folder.path()) == before);
}

TEST_CASE("a signal ends a build tidily, even when sent twice: one line, status 1, nothing left") {
    const Folder folder;
    run_well({"synth", folder.file("dem.tif"), "--size", "2049", "--quiet"});
    const auto before = names_in(folder.path());
    const std::vector<std::vector<int>> kSignals = {{SIGINT}, {SIGTERM}, {SIGHUP}, {SIGTERM, SIGINT, SIGHUP}};
    for (const std::vector<int>& signals : kSignals) {
        Process build({"build", folder.file("dem.tif"), "--out", folder.file("dem.terrain"), "--quiet"});
        while (names_in(folder.path()) == before) std::this_thread::yield();  // until its scratch stands
        for (const int signal : signals) kill(build.id(), signal);
        const Answer answer = build.wait();
        INFO(signals.front() << " said: " << answer.err);
        CHECK(answer.status == 1);
        CHECK(answer.error_lines() == 1);
        CHECK(names_in(folder.path()) == before);
    }
}

TEST_CASE("a build that reaches the limit of a file's size says so and leaves nothing") {
    const Folder folder;
    run_well({"synth", folder.file("dem.tif"), "--size", "1025", "--quiet"});
    const auto before = names_in(folder.path());
    const std::string command = "ulimit -f 100; exec '" + std::string(RIDGELINE_PROGRAM) + "' build '" +
                                folder.file("dem.tif") + "' --out '" + folder.file("dem.terrain") +
                                "' --quiet 2> '" + folder.file("err") + "'";
    const int status = std::system(("bash -c \"" + command + "\"").c_str());
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 1);
    CHECK(file_text(folder.file("err")).find("File too large") != std::string::npos);
    std::filesystem::remove(folder.file("err"));
    CHECK(names_in(folder.path()) == before);
}

TEST_CASE("a build under nohup goes on when its terminal goes") {
    const SmallStore small;
    const std::string out = small.folder.file("other.terrain");
    const std::string command = "trap '' HUP; '" + std::string(RIDGELINE_PROGRAM) + "' build '" + small.dem +
                                "' --out '" + out + "' --quiet & kill -HUP $!; wait $!";
    CHECK(std::system(command.c_str()) == 0);
    run_well({"verify", out, "--quiet"});
}

TEST_CASE("output that cannot be written is a failure") {
    const SmallStore small;
    const std::string command =
        std::string(RIDGELINE_PROGRAM) + " info '" + small.store + "' > /dev/full 2> /dev/null";
    if (!std::filesystem::exists("/dev/full")) return;
    CHECK(WEXITSTATUS(std::system(command.c_str())) == 1);
}

TEST_CASE(
    "without OpenGL the bench of metrics gives its figures and says in a line that pictures are left out") {
    const SmallStore small;
    const std::string out = small.folder.file("figures");
    // No driver for the loader of EGL to find.
    REQUIRE(setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/dev/null", 1) == 0);
    const Answer answer = run({"bench", small.store, "--suite", "metric", "--out", out, "--quiet"});
    unsetenv("__EGL_VENDOR_LIBRARY_FILENAMES");
    CHECK(answer.status == 0);
    CHECK(answer.error_lines() == 1);
    CHECK(answer.err.find("pictures are left out") != std::string::npos);
    CHECK(names_in(out) == std::set<std::string>{"metric.json"});
}

TEST_CASE("imagery is built with the heights or given to a store that stands, and told of") {
    const Folder folder;
    const std::string dem = folder.file("dem.tif"), rgb = folder.file("rgb.tif");
    run_well({"synth", dem, "--size", "200", "--spacing", "25", "--imagery", rgb, "--quiet"});
    const std::string together = folder.file("a.terrain"), later = folder.file("b.terrain");
    run_well({"build", dem, "--out", together, "--imagery", rgb, "--quiet"});
    run_well({"build", dem, "--out", later, "--quiet"});
    CHECK_FALSE(nlohmann::json::parse(run_well({"info", later, "--json"}).out)["layers"].contains("imagery"));
    const Answer added = run_well({"build", "--out", later, "--imagery", rgb});
    CHECK(added.out.find("imagery of 598 x 598 texels") != std::string::npos);
    for (const char* name :
         {"terrain.json", "nodes.bin", "heights.tiles", "mesh.tiles", "imagery.bin", "imagery.tiles"})
        CHECK(file_text(std::filesystem::path(together) / name) ==
              file_text(std::filesystem::path(later) / name));

    const auto info = nlohmann::json::parse(run_well({"info", later, "--json"}).out);
    const auto& layer = info["layers"]["imagery"];
    CHECK(layer["levels"] == 3);
    CHECK(layer["tiles"] == 9 + 4 + 1);
    CHECK(layer["spacing_m"][0].get<double>() == doctest::Approx(25.0 / 3));
    CHECK(layer["bytes"] == std::filesystem::file_size(std::filesystem::path(later) / "imagery.tiles"));
    CHECK(info["provenance"]["imagery"]["sources"] == nlohmann::json({rgb}));
    CHECK(run_well({"verify", later}).out.find("14 tiles of imagery") != std::string::npos);
    CHECK(run_well({"info", later}).out.find("598 x 598 texels") != std::string::npos);

    const Answer again = run({"build", "--out", later, "--imagery", rgb});
    CHECK(again.status == 1);
    CHECK(again.err == "ridgeline: error: " + later + ": has imagery already; --force replaces it\n");
    run_well({"build", "--out", later, "--imagery", rgb, "--force", "--quiet"});
    const Answer nowhere = run({"build", "--out", folder.file("c.terrain"), "--imagery", rgb});
    CHECK(nowhere.status == 1);
    CHECK(nowhere.error_lines() == 1);
    CHECK(nowhere.err.find("rasters after --imagery are pictures; name the DEM first") != std::string::npos);
    check_failure({"build", "--out", folder.file("c.terrain"), "--imagery", rgb, dem}, "name the DEM first");
    change_byte(std::filesystem::path(later) / "imagery.tiles", 5000);
    const Answer damaged = run({"verify", later, "--quiet"});
    CHECK(damaged.status == 1);
    CHECK(damaged.error_lines() == 1);
    CHECK(damaged.err.find("imagery.tiles") != std::string::npos);
    // Heights need no imagery.
    const std::filesystem::path table = std::filesystem::path(later) / "imagery.bin";
    std::filesystem::resize_file(table, std::filesystem::file_size(table) - 1);
    const Answer no_info = run({"info", later});
    CHECK(no_info.status == 1);
    CHECK(no_info.error_lines() == 1);
    const auto middle = [&](int axis) {
        return 0.5 * (info["bounds"][axis].get<double>() + info["bounds"][axis + 2].get<double>());
    };
    const std::string at = std::to_string(middle(0)) + "," + std::to_string(middle(1));
    CHECK(run_well({"height", later, "--at", at}).out == run_well({"height", together, "--at", at}).out);
    // Damaged imagery can be replaced.
    run_well({"build", "--out", later, "--imagery", rgb, "--force", "--quiet"});
    run_well({"verify", later, "--quiet"});
    CHECK(names_in(folder.path()) == std::set<std::string>{"a.terrain", "b.terrain", "dem.tif", "rgb.tif"});
}

TEST_CASE("imagery: stopped by a signal, or killed, the store stands as it was") {
    const Folder folder;
    const std::string dem = folder.file("dem.tif"), rgb = folder.file("rgb.tif"),
                      store = folder.file("a.terrain");
    run_well({"synth", dem, "--size", "500", "--imagery", rgb, "--quiet"});
    run_well({"build", dem, "--out", store, "--quiet"});
    const std::string before = file_text(std::filesystem::path(store) / "terrain.json");
    for (const int signal : {SIGINT, SIGKILL}) {
        Process adding({"build", "--out", store, "--imagery", rgb, "--jobs", "2"});
        const auto stands = [&] {
            return file_text(std::filesystem::path(store) / "terrain.json") == before;
        };
        // Once it has begun its directory it is under way; it may be over before that is seen.
        while (names_in(folder.path()).size() < 4 && stands()) std::this_thread::yield();
        kill(adding.id(), signal);
        const Answer answer = adding.wait();
        run_well({"verify", store, "--quiet"});
        if (answer.status == 0) return;
        CHECK(answer.status == (signal == SIGKILL ? 128 + SIGKILL : 1));
        if (signal == SIGINT) CHECK(stands());
    }
    run_well({"build", "--out", store, "--imagery", rgb, "--quiet"});
    CHECK(names_in(folder.path()) == std::set<std::string>{"a.terrain", "dem.tif", "rgb.tif"});
}
