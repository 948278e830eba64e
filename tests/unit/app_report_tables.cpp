// Telemetry as the report reads it: frames.csv, summary.json, folders and their names, pictures.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "ridgeline/app/report/run_folder.h"
#include "ridgeline/telemetry/frame_record.h"
#include "support/report_folder.h"

using namespace ridgeline;
using namespace ridgeline::app::report;
using namespace ridgeline::test;

namespace {

bool refuses(std::string_view csv, const std::string& why) {
    const auto table = parse_frames_csv(csv, "x/frames.csv");
    if (table) return false;
    INFO(table.error().message);
    CHECK(table.error().message.starts_with("x/frames.csv: "));
    CHECK(table.error().message.find(why) != std::string::npos);
    return true;
}

}  // namespace

TEST_CASE("frames.csv: what the telemetry writes is read back, value by value") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1e6, 1e6);
    std::string csv = telemetry::csv_header();
    std::vector<telemetry::FrameRecord> records(300);
    for (telemetry::FrameRecord& record : records) {
        record.frame = &record - records.data();
        record.frame_ms = std::abs(any(random));
        record.triangles = static_cast<std::int64_t>(random());
        record.eye_east_m = any(random);
        if (random() % 3 != 0) record.gpu_ms = std::abs(any(random));
        telemetry::append_csv_row(record, csv);
    }
    const auto table = parse_frames_csv(csv, "frames.csv");
    REQUIRE(table);
    CHECK(table->frames() == records.size());
    for (const telemetry::FrameColumn& column : telemetry::frame_columns()) {
        INFO(column.name);
        const std::vector<double>* values = table->find(column.name);
        REQUIRE(values != nullptr);
        for (std::size_t i = 0; i < records.size(); ++i) {
            const double written = column.value(records[i]);
            if (std::isnan(written))
                CHECK(std::isnan((*values)[i]));
            else
                CHECK((*values)[i] == doctest::Approx(written).epsilon(1e-8));
        }
    }
}

TEST_CASE("frames.csv: columns by name, in any order, some missing, strange ones beside them") {
    const auto table =
        parse_frames_csv("\xEF\xBB\xBFtriangles, frame_ms ,wings\r\n5,1.5,2\r\n6,nan,\r\n", "f");
    REQUIRE(table);
    CHECK(table->frames() == 2);
    CHECK(*table->find("triangles") == std::vector<double>{5.0, 6.0});
    CHECK(table->find("frame_ms")->front() == 1.5);
    CHECK(std::isnan(table->find("frame_ms")->back()));
    CHECK(std::isnan(table->find("wings")->back()));
    CHECK(table->find("gpu_ms") == nullptr);
}

TEST_CASE("frames.csv: no frames, and one, are tables too") {
    CHECK(parse_frames_csv("frame,frame_ms\n", "f")->frames() == 0);
    CHECK(parse_frames_csv("frame,frame_ms", "f")->frames() == 0);
    CHECK(parse_frames_csv("frame,frame_ms\n0,2", "f")->frames() == 1);
}

TEST_CASE("frames.csv: what is no table of frames is refused with the line that is wrong") {
    CHECK(refuses("", "is empty"));
    CHECK(refuses("\n", "is empty"));
    CHECK(refuses("east,north\n1,2\n", "no telemetry"));
    CHECK(refuses("frame,frame\n1,2\n", "two columns 'frame'"));
    CHECK(refuses("frame,frame_ms\n0,1\n1\n", "line 3"));
    CHECK(refuses("frame,frame_ms\n0,1\n\n2,3\n", "line 3"));
    CHECK(refuses("frame,frame_ms\n0,1,2\n", "3 cells for 2 columns"));
    for (const char* word : {"fast", "1.5x", "0x10", "1e400", "inf", "-inf", "1e300", "--1", "nan(1)"}) {
        INFO(word);
        CHECK(refuses(std::string("frame,frame_ms\n0,") + word + "\n", word));
    }
    CHECK(refuses(std::string("frame,frame_ms\n0,") + std::string(100'000, 'x') + "\n", "…"));
}

TEST_CASE("frames.csv: cut anywhere, it is refused or has fewer frames, never others") {
    std::string csv = telemetry::csv_header();
    for (int frame = 0; frame < 5; ++frame)
        telemetry::append_csv_row({.frame = frame, .triangles = 100 + frame}, csv);
    for (std::size_t size = 0; size < csv.size(); ++size) {
        const auto table = parse_frames_csv(std::string_view(csv).substr(0, size), "f");
        if (!table) continue;
        const std::vector<double>* triangles = table->find("triangles");
        for (std::size_t i = 0; triangles != nullptr && i < table->frames(); ++i)
            CHECK((*triangles)[i] == 100.0 + static_cast<double>(i));
    }
}

TEST_CASE("summary.json: options as text, figures by their names; other formats and damage are refused") {
    const auto summary = parse_summary(summary_text("C:\\alps", {{"horizon", "ridges"}}), "s");
    REQUIRE(summary);
    CHECK(summary->dataset == "C:\\alps");
    CHECK(*summary->find_option("horizon") == "ridges");
    CHECK(summary->find_option("wings") == nullptr);
    CHECK(*summary->find("frame_ms.p99") == 9.0);
    CHECK(summary->find("frame_ms") == nullptr);
    CHECK(summary->find("options.pixel-error") == nullptr);
    CHECK(*summary->find_option("pixel-error") == "1.5");
    const std::string whole = summary_text("alps", {});
    for (std::size_t size = 0; size + 2 < whole.size(); ++size)
        CHECK(!parse_summary(whole.substr(0, size), "s"));
    for (const char* text : {"[]", "3", "{}", R"({"format": 1})", R"({"format": "ridgeline-telemetry-9"})"})
        CHECK(!parse_summary(text, "s"));
    CHECK(!parse_summary(std::string(100'000, '['), "s"));
    // Nothing but the format is asked for.
    CHECK(parse_summary(R"({"format": "ridgeline-telemetry-1", "frames": "many", "options": [1]})", "s"));
}

TEST_CASE("folders are called as short as tells them apart") {
    using Names = std::vector<std::string>;
    CHECK(names_apart({"/a/ridges", "/a/off/"}) == Names{"ridges", "off"});
    CHECK(names_apart({"/a/monday/walk", "/a/tuesday/walk/."}) == Names{"monday/walk", "tuesday/walk"});
    CHECK(names_apart({"/a/x/walk", "/b/x/walk", "/b/y"}) == Names{"a/x/walk", "b/x/walk", "y"});
    CHECK(names_apart({"/walk", "/a/walk"}) == Names{"walk", "a/walk"});
    CHECK(names_apart({"/a/walk", "/a/b/../walk"}) == Names{"walk", "walk (2)"});
    CHECK(names_apart({"/"}) == Names{"/"});
}

TEST_CASE("a folder is read whole, or the failure names the file") {
    const ReportFolder folder;
    folder.write_run("good", 4);
    const auto why = [&](const std::string& name) {
        const auto runs = read_runs({folder.path() / "good", folder.path() / name}, 8);
        return runs ? std::string() : runs.error().message;
    };
    CHECK(why("good").empty());
    CHECK(why("absent").find("absent: is no folder") != std::string::npos);
    folder.write_run("headless", 4);
    std::filesystem::remove(folder.path() / "headless" / "summary.json");
    CHECK(why("headless").find("headless/summary.json: ") != std::string::npos);
    folder.write_run("frameless", 4);
    std::filesystem::remove(folder.path() / "frameless" / "frames.csv");
    CHECK(why("frameless").find("frameless/frames.csv: ") != std::string::npos);
    folder.write_run("mixed", 4);
    std::filesystem::copy_file(folder.path() / "good" / "summary.json",
                               folder.path() / "mixed" / "summary.json",
                               std::filesystem::copy_options::overwrite_existing);
    CHECK(why("mixed").empty());
    folder.write_run("longer", 5);
    std::filesystem::copy_file(folder.path() / "good" / "summary.json",
                               folder.path() / "longer" / "summary.json",
                               std::filesystem::copy_options::overwrite_existing);
    CHECK(why("longer").find("different runs") != std::string::npos);
}

TEST_CASE("pictures: spread over the walk, made small; what is no picture is left out and said") {
    const ReportFolder folder;
    const auto thumbs = folder.path() / "thumbs";
    CHECK(read_thumbnails(thumbs, 8).pictures.empty());
    for (int frame = 0; frame <= 90; frame += 10) folder.write_picture(thumbs, frame, {1000, 500});
    folder.write_text(thumbs / "notes.txt", "not a picture");
    folder.write_text(thumbs / "x1.png", "not a frame");
    const Thumbnails four = read_thumbnails(thumbs, 4);
    REQUIRE(four.pictures.size() == 4);
    CHECK(four.left_out.empty());
    CHECK(four.pictures[0].frame == 0);
    CHECK(four.pictures[1].frame == 30);
    CHECK(four.pictures[3].frame == 90);
    CHECK(four.pictures[0].width_px == 333);
    CHECK(four.pictures[0].height_px == 166);
    // A JPEG's first bytes.
    CHECK(four.pictures[0].jpeg_base64.starts_with("/9j/"));
    CHECK(read_thumbnails(thumbs, 1).pictures.size() == 1);
    CHECK(read_thumbnails(thumbs, 0).pictures.empty());
    CHECK(read_thumbnails(thumbs, 99).pictures.size() == 10);

    const std::string whole = file_text(thumbs / "0.png");
    folder.write_text(thumbs / "10.png", whole.substr(0, whole.size() / 2));
    folder.write_text(thumbs / "20.png", "");
    folder.write_text(thumbs / "30.png", "<svg onload=alert(1)>");
    const Thumbnails damaged = read_thumbnails(thumbs, 99);
    CHECK(damaged.pictures.size() == 7);
    REQUIRE(damaged.left_out.size() == 3);
    CHECK(damaged.left_out[0].find("10.png: ") != std::string::npos);
}
