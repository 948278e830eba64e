// A disk that fills up while the program builds: one line, status 1, nothing left, and what stood stands. The
// limit of a file's size stands in for the disk everywhere; a real full disk, a small tmpfs, is tried where the
// system lets users mount one in a name space of their own.
#include <doctest/doctest.h>
#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "unit/app_process.h"

using namespace ridgeline::test;
namespace fs = std::filesystem;

namespace {

// Runs the program where no file may grow beyond `most_bytes`.
Answer run_limited(const std::vector<std::string>& arguments, rlim_t most_bytes) {
    rlimit before{};
    REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
    const rlimit limited{most_bytes, before.rlim_max};
    REQUIRE(setrlimit(RLIMIT_FSIZE, &limited) == 0);
    Process process(arguments);  // inherits it
    REQUIRE(setrlimit(RLIMIT_FSIZE, &before) == 0);
    return process.wait();
}

struct Rasters {
    Folder folder;
    std::string dem = folder.file("dem.tif"), rgb = folder.file("rgb.tif");
    std::string store = folder.file("a.terrain");

    Rasters() { run_well({"synth", dem, "--size", "300", "--imagery", rgb, "--quiet"}); }
};

// From what stops the first file written to what is enough for all of them.
std::vector<rlim_t> limits() {
    std::vector<rlim_t> bytes;
    for (rlim_t limit = 512; limit < (2u << 20); limit *= 2) bytes.push_back(limit);
    return bytes;
}

// Runs at every limit; after what failed, `check` looks.
template <class Check>
void run_at_every_limit(const std::vector<std::string>& arguments, Check&& check) {
    int failed = 0;
    for (const rlim_t limit : limits()) {
        CAPTURE(limit);
        const Answer answer = run_limited(arguments, limit);
        if (answer.status == 0) break;
        ++failed;
        INFO(answer.err);
        CHECK(answer.status == 1);
        CHECK(answer.error_lines() == 1);
        CHECK(answer.err.find("File too large") != std::string::npos);
        check();
    }
    CHECK(failed > 3);
}

// A shell script in name spaces where it may mount; nothing where the system does not allow that.
std::optional<std::string> mounting(const Folder& folder, const std::string& script) {
    if (std::system("unshare -Urm mount -t tmpfs none /tmp 2>/dev/null") != 0) return {};
    std::ofstream(folder.file("script")) << script;
    const std::string command =
        "unshare -Urm bash '" + folder.file("script") + "' > '" + folder.file("answers") + "' 2>&1";
    REQUIRE(std::system(command.c_str()) == 0);
    return file_text(folder.file("answers"));
}

// For disks from tiny to large enough: status, lines on stderr, and names left on the disk, a line each.
std::string script_for(const std::string& prepare, const std::string& arguments) {
    return "d=$(mktemp -d)\n"
           "for kib in 16 64 256 512 1024 2048 8192; do\n"
           "  mount -t tmpfs -o size=$((kib + extra))k none \"$d\"\n" +
           prepare + "  '" RIDGELINE_PROGRAM "' build " + arguments +
           " --quiet 2> /dev/shm/ridgeline-err-$$\n"
           "  echo $? $(wc -l < /dev/shm/ridgeline-err-$$) $(ls \"$d\")\n"
           "  rm /dev/shm/ridgeline-err-$$\n"
           "  '" RIDGELINE_PROGRAM
           "' verify \"$d/a.terrain\" --quiet 2> /dev/null && echo whole || echo none\n"
           "  umount \"$d\"\n"
           "done\n"
           "rmdir \"$d\"\n";
}

}  // namespace

TEST_CASE("a build that the disk has no room for fails in one line, wherever it ends, and leaves nothing") {
    const Rasters rasters;
    const auto before = names_in(rasters.folder.path());
    run_at_every_limit({"build", rasters.dem, "--out", rasters.store, "--imagery", rasters.rgb, "--quiet"},
                       [&] { CHECK(names_in(rasters.folder.path()) == before); });
    run_well({"verify", rasters.store, "--quiet"});
}

TEST_CASE("imagery that the disk has no room for leaves the store as it was") {
    const Rasters rasters;
    run_well({"build", rasters.dem, "--out", rasters.store, "--quiet"});
    const auto names = names_in(rasters.folder.path());
    const auto before = contents_of(rasters.store);
    run_at_every_limit({"build", "--out", rasters.store, "--imagery", rasters.rgb, "--quiet"}, [&] {
        CHECK(names_in(rasters.folder.path()) == names);
        CHECK(contents_of(rasters.store) == before);
    });
    run_well({"verify", rasters.store, "--quiet"});
}

TEST_CASE("on a disk that is really full a build leaves nothing, and imagery leaves the store as it was") {
    const Rasters rasters;
    const std::string full =
        script_for("", "'" + rasters.dem + "' --out \"$d/a.terrain\" --imagery '" + rasters.rgb + "'");
    const auto answers = mounting(rasters.folder, "extra=0\n" + full);
    if (!answers) {
        MESSAGE("skipped: no tmpfs can be mounted here");
        return;
    }
    std::istringstream built(*answers);
    int failed = 0, done = 0;
    for (std::string status, state; std::getline(built, status) && std::getline(built, state);) {
        INFO(status << " / " << state);
        if (state == "none") CHECK(status == "1 1");
        if (state == "whole") CHECK(status == "0 0 a.terrain");
        (state == "none" ? failed : done) += 1;
    }
    INFO(*answers);
    CHECK(failed >= 2);
    CHECK(done >= 1);

    run_well({"build", rasters.dem, "--out", rasters.store, "--quiet"});
    const std::string copy = "  cp -r '" + rasters.store + "' \"$d/a.terrain\"\n";
    const std::string adding = script_for(copy, "--out \"$d/a.terrain\" --imagery '" + rasters.rgb + "'");
    const auto added =
        mounting(rasters.folder, "extra=$(du -sk '" + rasters.store + "' | cut -f 1)\n" + adding);
    REQUIRE(added);
    INFO(*added);
    std::istringstream pictured(*added);
    failed = done = 0;
    for (std::string status, state; std::getline(pictured, status) && std::getline(pictured, state);) {
        INFO(status << " / " << state);
        CHECK(state == "whole");
        CHECK((status == "1 1 a.terrain" || status == "0 0 a.terrain"));
        (status.starts_with("1") ? failed : done) += 1;
    }
    CHECK(failed >= 2);
    CHECK(done >= 1);
}
