// ridgeline report as a black box: one file comes of it, whole, or none and a line that says why.
#include <doctest/doctest.h>
#include <sys/stat.h>

#include "unit/app_process.h"

using namespace ridgeline::test;

namespace {

const std::string kSummary =
    R"({"format": "ridgeline-telemetry-1", "dataset": "alps.terrain", "options": {}, "frames": 2})";
const std::string kFrames = "frame,time_s,frame_ms\n0,0,4\n1,0.1,5\n";

std::string write_run(const Folder& folder, const std::string& name, const std::string& frames = kFrames,
                      const std::string& summary = kSummary) {
    std::filesystem::create_directories(folder.path() / name);
    std::ofstream(folder.path() / name / "frames.csv") << frames;
    std::ofstream(folder.path() / name / "summary.json") << summary;
    return folder.file(name);
}

std::size_t files_in(const Folder& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder.path()), {}));
}

}  // namespace

TEST_CASE("one page, named on stdout; with --quiet, nothing is said") {
    const Folder folder;
    const std::string run_folder = write_run(folder, "ridges"), page = folder.file("report.html");
    const Answer answer = run({"report", run_folder, "--out", page});
    CHECK(answer.status == 0);
    CHECK(answer.out == page + "\n");
    CHECK(answer.err.empty());
    CHECK(file_text(page).starts_with("<!DOCTYPE html>"));
    CHECK(run({"report", run_folder, "--out", page, "--quiet"}).out.empty());
    CHECK(files_in(folder) == 2);
}

TEST_CASE("two folders of one name are told apart, wherever --out stands") {
    const Folder folder;
    const std::string a = write_run(folder, "monday/walk"), b = write_run(folder, "tuesday/walk");
    const std::string page = folder.file("report.html");
    for (const auto& arguments : {std::vector<std::string>{"report", a, b, "--out", page},
                                  std::vector<std::string>{"report", "--out", page, a, b}}) {
        CHECK(run(arguments).status == 0);
        CHECK(file_text(page).find("<bdi>monday/walk</bdi>") != std::string::npos);
        CHECK(file_text(page).find("<bdi>tuesday/walk</bdi>") != std::string::npos);
    }
}

TEST_CASE("bad telemetry: one line, exit 1, and the page that stood there still stands") {
    const Folder folder;
    const std::string good = write_run(folder, "good"), page = folder.file("report.html");
    REQUIRE(run({"report", good, "--out", page}).status == 0);
    const std::string stood = file_text(page);
    const auto fails = [&](const std::string& bad, const std::string& what) {
        check_failure({"report", good, bad, "--out", page}, what);
        CHECK(file_text(page) == stood);
    };
    fails(folder.file("absent"), "absent");
    fails(good + "/frames.csv", "frames.csv");
    fails(write_run(folder, "no-json", kFrames, kSummary.substr(0, 30)), "no-json/summary.json");
    fails(write_run(folder, "other-format", kFrames, R"({"format": "x"})"), "other-format/summary.json");
    fails(write_run(folder, "no-columns", "1,2,3\n4,5,6\n"), "no-columns/frames.csv");
    fails(write_run(folder, "cut-short", kFrames.substr(0, kFrames.size() - 3)),
          "cut-short/frames.csv: line 3");
    fails(write_run(folder, "fewer", "frame,time_s,frame_ms\n0,0,4\n"), "fewer");
    fails(write_run(folder, "empty", ""), "empty/frames.csv");
}

TEST_CASE("a page that cannot be written fails and leaves nothing") {
    const Folder folder;
    const std::string good = write_run(folder, "good");
    check_failure({"report", good, "--out", folder.file("absent/report.html")}, "absent/report.html");
    check_failure({"report", good, "--out", "/dev/full"}, "/dev/full");
    check_failure({"report", good, "--out", good}, good);
    CHECK(files_in(folder) == 1);
    CHECK(std::filesystem::is_directory(good));
}

TEST_CASE("what stands there is replaced at once: whoever has it open keeps the old page whole") {
    const Folder folder;
    const std::string good = write_run(folder, "good"), page = folder.file("report.html");
    REQUIRE(run({"report", good, "--out", page}).status == 0);
    const std::string old_page = file_text(page);
    std::ifstream reader(page);
    struct stat before {};
    REQUIRE(stat(page.c_str(), &before) == 0);
    const std::string newer = write_run(folder, "newer");
    CHECK(run({"report", good, newer, "--out", page}).status == 0);
    struct stat after {};
    REQUIRE(stat(page.c_str(), &after) == 0);
    CHECK(before.st_ino != after.st_ino);
    CHECK(std::string(std::istreambuf_iterator<char>(reader), {}) == old_page);
    CHECK(file_text(page).ends_with("</html>\n"));
    CHECK(file_text(page).find("<bdi>newer</bdi>") != std::string::npos);
}

TEST_CASE("the telemetry is never written over, by no name and no link") {
    namespace fs = std::filesystem;
    const Folder folder;
    const std::string good = write_run(folder, "good"), other = write_run(folder, "other");
    fs::create_directory(good + "/thumbs");
    for (const char* name : {"/trace.json", "/thumbs/7.png"}) std::ofstream(good + name) << "bytes";
    fs::create_directory_symlink(good, folder.file("again"));
    for (const char* name : {"/summary.json", "/frames.csv", "/trace.json", "/thumbs/7.png"}) {
        const std::string input = good + name, before = file_text(input);
        const std::string soft = folder.file("soft.html"), hard = folder.file("hard.html");
        fs::create_symlink(input, soft);
        fs::create_hard_link(input, hard);
        for (const std::string& out :
             {input, soft, hard, folder.file("again") + name, folder.file("other/../good") + name}) {
            check_failure({"report", other, good, "--out", out}, out + ": is of the telemetry");
            check_failure({"report", folder.file("again"), "--out", out}, out + ": is of the telemetry");
            CHECK(file_text(out) == before);
        }
        CHECK(fs::is_symlink(soft));
        fs::remove(soft);
        fs::remove(hard);
    }
    CHECK(run({"report", good, "--out", folder.file("report.html")}).status == 0);
}

TEST_CASE("what is no report is kept, whatever it begins with; a report gives way, in the telemetry too") {
    const Folder folder;
    const std::string good = write_run(folder, "good"), within = good + "/report.html";
    REQUIRE(run({"report", good, "--out", within}).status == 0);
    const std::string page = file_text(within);
    CHECK(run({"report", good, "--out", within}).status == 0);
    CHECK(file_text(within) == page);

    const std::string kept = folder.file("kept");
    const std::string mark = "ridgeline report";
    for (const std::string& text : {std::string(), std::string("II*"), page.substr(0, 15),
                                    page.substr(0, page.find(mark) + mark.size()), "\n" + page,
                                    "<!DOCTYPE html>\n<html lang=\"en\">\n" + page}) {
        INFO(text.substr(0, 40));
        std::ofstream(kept, std::ios::binary) << text;
        check_failure({"report", good, "--out", kept}, kept + ": stands there and is no report");
        CHECK(file_text(kept) == text);
    }
    std::ofstream(kept, std::ios::binary) << page.substr(0, page.size() / 2);
    CHECK(run({"report", good, "--out", kept}).status == 0);
    CHECK(file_text(kept) == page);
    CHECK(files_in(folder) == 2);
}

TEST_CASE("wrong usage is named") {
    check_usage_error({"report"}, "TELEMETRY_DIR");
    check_usage_error({"report", "x"}, "--out");
    check_usage_error({"report", "x", "--out"}, "--out");
    std::vector<std::string> nine = {"report", "--out", "report.html"};
    for (int i = 0; i < 9; ++i) nine.push_back("x" + std::to_string(i));
    check_usage_error(nine, "TELEMETRY_DIR");
}
