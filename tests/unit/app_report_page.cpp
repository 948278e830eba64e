// The report's page as a whole: well-formed, of one piece, and true to what it was made from.
#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "ridgeline/app/report/measure_chart.h"
#include "ridgeline/app/report/options_table.h"
#include "ridgeline/app/report/page.h"
#include "support/html_check.h"
#include "support/report_folder.h"

using namespace ridgeline;
using namespace ridgeline::app::report;
using namespace ridgeline::test;

namespace {

std::vector<RunFolder> runs_of(const std::vector<std::filesystem::path>& folders) {
    auto runs = read_runs(folders, kMostPictures);
    REQUIRE(runs);
    return std::move(*runs);
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t times = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++times;
    return times;
}

// One table of one column beside the frame's number, and the summary that goes with it.
RunFolder run_with(const std::string& csv, const Options& options = {}) {
    RunFolder run;
    run.name = "made up";
    auto frames = parse_frames_csv(csv, "f");
    REQUIRE(frames);
    run.frames = std::move(*frames);
    auto summary = parse_summary(summary_text("alps", options), "s");
    REQUIRE(summary);
    run.summary = std::move(*summary);
    return run;
}

}  // namespace

TEST_CASE("a page is well-formed and asks for nothing from elsewhere, for one run and for eight") {
    const ReportFolder folder;
    std::vector<std::filesystem::path> folders;
    for (std::size_t i = 0; i < kMostRuns; ++i) {
        folders.push_back(folder.write_run("run" + std::to_string(i), 50));
        folder.write_picture(folders.back() / "thumbs", 7, {320, 180});
        const std::string page = page_of(runs_of(folders));
        CHECK(markup_fault(page) == "");
        CHECK(page.find("http:") == std::string::npos);
        CHECK(page.find("https:") == std::string::npos);
        CHECK(page.find("url(") == std::string::npos);
        CHECK(page.find("@import") == std::string::npos);
        CHECK(page.find(" src=\"data:image/jpeg;base64,") != std::string::npos);
        CHECK(count(page, " src=") == i + 1);
        CHECK(count(page, "<article") == i + 1);
    }
}

TEST_CASE("names from telemetry never become markup") {
    const std::string hostile =
        "</title><script>alert(1)</script><img src=x onerror=alert(2)>\" onload='alert(3)' \u202Egnp";
    const ReportFolder folder;
    const auto one =
        folder.write_run("a\"><b onclick=x>", 20, hostile, {{hostile, hostile}, {"path", hostile}});
    const auto two = folder.write_run("b' &lt;", 20, hostile + "/", {{"path", "<plaintext>"}});
    ReportFolder::write_text(one / "thumbs" / "3.png", "<script>");
    for (const std::string& page : {page_of(runs_of({one})), page_of(runs_of({one, two}))}) {
        CHECK(markup_fault(page) == "");
        // The page's own, and no other.
        CHECK(count(page, "<script") == 1);
        CHECK(count(page, "<style") == 1);
        CHECK(count(page, "<img") == 0);
        CHECK(page.find("<plaintext") == std::string::npos);
        CHECK(page.find("<b onclick") == std::string::npos);
        CHECK(page.find("&lt;script&gt;alert(1)") != std::string::npos);
    }
}

TEST_CASE("a hundred thousand frames make a small page, and the one slow frame among them is on it") {
    std::string csv = "frame,time_s,frame_ms,triangles,bytes_read,ram_cache_bytes,selection_ms,gpu_ms\n";
    for (int frame = 0; frame < 100'000; ++frame)
        csv += std::to_string(frame) + "," + std::to_string(frame / 60.0) + "," +
               (frame == 77'777 ? "987" : std::to_string(4 + frame % 7)) + "," +
               std::to_string(1'000'000 + frame * 37 % 99991) + "," + std::to_string(frame * 991 % 65537) +
               "," + std::to_string(frame) + ",0." + std::to_string(frame * 7 % 97) + "," +
               std::to_string(frame * 13 % 11) + "\n";
    const std::vector<RunFolder> runs(3, run_with(csv));
    const std::string page = page_of(runs);
    CHECK(page.size() < 2'000'000);
    CHECK(page.find("3 frames above the scale, up to 987\u202Fms") != std::string::npos);
    const auto walk = walk_axis(runs);
    REQUIRE(walk);
    const CurveChart chart = chart_of(frame_time_measure(), runs, *walk);
    double most = 0.0;
    for (const Column& column : chart.curves[0].columns) most = std::max(most, column.most);
    CHECK(most == 987.0);
    CHECK(chart.y.last < 100.0);
}

TEST_CASE("columns that are missing are said to be, and the rest is drawn") {
    const std::vector<RunFolder> runs = {run_with("frame_ms,frame\n3,0\n4,1\n5,2\n")};
    const std::string page = page_of(runs);
    CHECK(markup_fault(page) == "");
    CHECK(page.find("<h3>Frame time ") != std::string::npos);
    CHECK(page.find("<h3>Triangles") == std::string::npos);
    CHECK(page.find("Not recorded: Triangles, ") != std::string::npos);
    // Without times, frames are what charts have across.
    CHECK(page.find("data-unit=\"frames\"") != std::string::npos);

    const std::string without = page_of(std::vector{run_with("frame,triangles\n0,3\n1,4\n")});
    CHECK(markup_fault(without) == "");
    CHECK(without.find("Frame times were not recorded.") != std::string::npos);
    CHECK(without.find("<h3>Triangles") != std::string::npos);
}

TEST_CASE("what is 0 in every frame is a line, not a chart; what was never measured is not recorded") {
    const std::string page =
        page_of(std::vector{run_with("frame,time_s,frame_ms,eye_lift_m,gpu_ms\n0,0,3,0,nan\n1,1,3,0,nan\n")});
    CHECK(page.find("0 in every frame: Eye lift.") != std::string::npos);
    CHECK(page.find("<h3>Eye lift") == std::string::npos);
    CHECK(page.find("Not recorded: Render thread, GPU, ") != std::string::npos);
}

TEST_CASE("a run of no frames, or one, or times that stand still, is a page all the same") {
    for (const char* csv :
         {"frame,time_s,frame_ms\n", "frame,time_s,frame_ms\n0,0,5\n", "frame,time_s,frame_ms\n0,nan,nan\n",
          "frame,time_s,frame_ms\n0,0,0\n", "frame,time_s,frame_ms\n0,3,5\n1,3,6\n2,3,7\n",
          "frame,time_s,frame_ms\n0,1e18,1e18\n1,-1e18,-1e18\n",
          "frame,time_s,frame_ms\n0,0,1e-18\n1,1,1e18\n"}) {
        INFO(csv);
        const RunFolder run = run_with(csv);
        for (const auto& runs :
             {std::vector{run}, std::vector{run, run_with("frame,time_s,frame_ms\n0,0,5\n1,1,9\n")}}) {
            const std::string page = page_of(runs);
            CHECK(markup_fault(page) == "");
            CHECK(page.find("nan%") == std::string::npos);
            CHECK(page.find("inf%") == std::string::npos);
        }
    }
    const std::string none = page_of(std::vector{run_with("frame,time_s,frame_ms\n")});
    CHECK(none.find("No frames were recorded.") != std::string::npos);
    CHECK(none.find("<dt>triangles a frame</dt><dd>–</dd>") != std::string::npos);
    CHECK(none.find("nan<") == std::string::npos);
}

TEST_CASE("telemetry damaged at random is refused, or makes a page that is well-formed") {
    std::string csv = telemetry::csv_header();
    for (int frame = 0; frame < 8; ++frame)
        telemetry::append_csv_row(
            {.frame = frame, .time_s = frame / 60.0, .frame_ms = 4.0 + frame, .gpu_ms = 1.5}, csv);
    const std::string json = summary_text("alps.terrain", {{"path", "ground"}, {"ram-cache", "4096"}}, 8);
    const std::string_view digits = "0123456789-+.e,\n\"<>&naif{}[] \x80";
    std::mt19937 random(15);
    int pages = 0;
    for (int trial = 0; trial < 400; ++trial) {
        std::string frames = csv, summary = json;
        for (int changes = 1 + static_cast<int>(random() % 3); changes > 0; --changes) {
            std::string& changed = trial % 2 == 0 ? frames : summary;
            changed[random() % changed.size()] = digits[random() % digits.size()];
        }
        const auto table = parse_frames_csv(frames, "f");
        const auto figures = parse_summary(summary, "s");
        if (!table || !figures) continue;
        RunFolder run{.name = "damaged", .frames = *table, .summary = *figures, .thumbnails = {}};
        INFO(frames << summary);
        CHECK(markup_fault(page_of(std::vector{run})) == "");
        ++pages;
    }
    CHECK(pages > 100);
}

TEST_CASE("a run that did not measure what another did has no curve there") {
    const std::vector<RunFolder> runs = {
        run_with("frame,time_s,gpu_ms\n0,0,nan\n1,1,nan\n"), run_with("frame,time_s\n0,0\n1,1\n"),
        run_with("frame,time_s,gpu_ms\n"), run_with("frame,time_s,gpu_ms\n0,0,nan\n1,1,4\n")};
    const auto gpu = std::find_if(measures().begin(), measures().end(),
                                  [](const Measure& measure) { return measure.title == std::string("GPU"); });
    const CurveChart chart = chart_of(*gpu, runs, *walk_axis(runs));
    REQUIRE(chart.curves.size() == 1);
    CHECK(chart.curves[0].run == 3);
    // The page's script reads every path there is.
    CHECK(page_of(runs).find("d=\"\"") == std::string::npos);
}

TEST_CASE("imagery has a section where a walk showed some, and none elsewhere") {
    constexpr const char* kTitle = "<h2>Imagery and tiles over the ground</h2>";
    const ReportFolder folder;
    // Every column is there, 0 in every frame.
    const RunFolder bare = runs_of({folder.write_run("bare", 30)}).front();
    CHECK(page_of(std::vector{bare}).find(kTitle) == std::string::npos);
    CHECK(page_of(std::vector{bare}).find("Imagery missing") == std::string::npos);
    std::string csv = telemetry::csv_header();
    for (int frame = 0; frame < 30; ++frame)
        telemetry::append_csv_row({.frame = frame,
                                   .time_s = frame / 60.0,
                                   .frame_ms = 5.0,
                                   .schedule_ms = 0.2,
                                   .readback_age_frames = frame < 10 ? telemetry::kNotMeasured : 2.0,
                                   .tiles_scheduled = 70,
                                   .heights_wanted = 25,
                                   .imagery_wanted = 60,
                                   .imagery_missing = 30 - frame,
                                   .imagery_gpu_bytes = 1 << 20},
                                  csv);
    RunFolder run = run_with(csv);
    run.summary.figures = {{"frames", 30.0}, {"frames_with_missing_imagery", 27.0}};
    for (const auto& runs : {std::vector{run}, std::vector{bare, run}}) {
        const std::string page = page_of(runs);
        CHECK(markup_fault(page) == "");
        CHECK(count(page, kTitle) == 1);
        for (const char* title : {"Heights wanted", "Imagery wanted", "Imagery missing", "Imagery on the GPU",
                                  "Tiles scheduled", "Scheduling", "Age of what was seen"})
            CHECK(count(page, "<h3>" + std::string(title)) == 1);
        CHECK(
            page.find("0 in every frame: Heights missing, Imagery loaded so far, Stalls of the readback.") !=
            std::string::npos);
        // In the card of the run that had some.
        CHECK(count(page, "of frames lacked imagery") == 1);
        CHECK(page.find("<dt>of frames lacked imagery</dt><dd>90\u202F%</dd>") != std::string::npos);
    }
    // Telemetry of before there was imagery.
    const RunFolder older = run_with("frame,time_s,frame_ms\n0,0,5\n1,1,9\n");
    CHECK(page_of(std::vector{older}).find(kTitle) == std::string::npos);
}

TEST_CASE("before the first readback its age is a gap, not 0") {
    const std::vector<RunFolder> runs = {run_with(
        "frame,time_s,imagery_wanted,readback_age_frames\n0,0,9,nan\n1,1,9,nan\n2,2,9,3\n3,3,9,2\n")};
    const auto age = std::find_if(measures().begin(), measures().end(), [](const Measure& measure) {
        return measure.column == std::string("readback_age_frames");
    });
    REQUIRE(age != measures().end());
    const WalkAxis walk = *walk_axis(runs);
    const CurveChart chart = chart_of(*age, runs, walk);
    REQUIRE(chart.curves.size() == 1);
    REQUIRE(chart.curves[0].columns.size() == 2);
    CHECK(chart.curves[0].columns[0].index ==
          ColumnGrid{walk.axis.first, walk.axis.last, walk.columns}.column_of(2.0));
    CHECK(chart.curves[0].columns[0].least == 3.0);
    CHECK(chart.description.find("median 2\u202Fframes") != std::string::npos);
}

TEST_CASE("several runs: the options that differ are named, figures have ratios to the first") {
    const ReportFolder folder;
    const auto a = folder.write_run("a", 30, "alps.terrain", {{"horizon", "ridges"}, {"path", "ground"}});
    const auto b = folder.write_run("b", 60, "alps.terrain",
                                    {{"horizon", "off"}, {"path", "ground"}, {"fault", "delay=50ms"}});
    const std::vector<RunFolder> runs = runs_of({a, b});
    CHECK(options_that_differ(runs) == std::vector<std::string>{"fault", "horizon"});
    CHECK(differing_options(runs).find("not given") != std::string::npos);
    CHECK(differing_options(std::vector{runs[0]}).empty());
    CHECK(differing_options(std::vector{runs[0], runs[0]}).find("the same options") != std::string::npos);
    // Twice as many frames; the same times.
    const std::string page = page_of(runs);
    CHECK(page.find("<td>60<small>×2.00</small></td>") != std::string::npos);
    CHECK(page.find("<td>9\u202Fms<small class=\"alike\">=</small></td>") != std::string::npos);
}

TEST_CASE("charts of several runs have one axis, with room for all of them and for their capacities") {
    const std::string head = "frame,time_s,ram_cache_bytes,nodes_horizon_culled,nodes_frustum_culled\n";
    const std::vector<RunFolder> runs = {
        run_with(head + "0,0,100,5,1\n1,1,200,6,2\n", {{"ram-cache", "1000"}}),
        run_with(head + "0,0,100,90,1\n1,2.5,300,7,2\n", {{"ram-cache", "4000"}})};
    const auto walk = walk_axis(runs);
    REQUIRE(walk);
    CHECK(walk->axis.first == 0.0);
    CHECK(walk->axis.last == 2.5);
    for (const Measure& measure : measures()) {
        if (shown(measure, runs) != Shown::chart) continue;
        const CurveChart chart = chart_of(measure, runs, *walk);
        CHECK(chart.curves.size() == 2);
        const std::string column = measure.column;
        if (column == "ram_cache_bytes") {
            CHECK(chart.y.last > 4000.0);
            CHECK(chart.levels.size() == 2);
        } else {
            // What the frustum culls is drawn on the axis of what the horizon does.
            CHECK(chart.y.last > 90.0);
        }
    }
}
