// Telemetry folders as a walk leaves them, made up for tests of the report; gone with the object.
#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "ridgeline/base/json_text.h"
#include "ridgeline/gl/screenshot.h"
#include "ridgeline/telemetry/frame_record.h"
#include "unit/app_folder.h"

namespace ridgeline::test {

using Options = std::map<std::string, std::string>;

// Without a count of frames, so that it goes with any table.
inline std::string summary_text(const std::string& dataset, const Options& options, int frames = -1) {
    std::string text = R"({"format": "ridgeline-telemetry-1", "dataset": )" + json_text(dataset) +
                       R"(, "gl_renderer": "software", "seconds": 2.5, "fps_mean": 40, )" +
                       R"("frame_ms": {"mean": 5, "p50": 4, "p95": 8, "p99": 9, "p999": 10, "max": 11}, )" +
                       R"("cpu_percent": {"process": 50, "render": 20, "io": 1, "workers": 9}, )" +
                       R"("options": {"pixel-error": 1.5)";
    for (const auto& [name, value] : options) text += ", " + json_text(name) + ": " + json_text(value);
    return text + "}" + (frames >= 0 ? ", \"frames\": " + std::to_string(frames) : "") + "}\n";
}

class ReportFolder {
  public:
    const std::filesystem::path& path() const { return folder_.path(); }

    static void write_text(const std::filesystem::path& file, const std::string& text) {
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << text;
    }

    static void write_picture(const std::filesystem::path& thumbs, int frame, const glm::ivec2& size_px) {
        std::filesystem::create_directories(thumbs);
        const auto bytes = static_cast<std::size_t>(size_px.x) * static_cast<std::size_t>(size_px.y) * 3;
        const gl::Image image{size_px, std::vector<std::byte>(bytes, std::byte{90})};
        REQUIRE(gl::write_png(thumbs / (std::to_string(frame) + ".png"), image));
    }

    // A walk of `frames` frames; returns its folder.
    std::filesystem::path write_run(const std::string& name, int frames,
                                    const std::string& dataset = "/data/alps.terrain",
                                    const Options& options = {}) const {
        std::string csv = telemetry::csv_header();
        for (int frame = 0; frame < frames; ++frame)
            telemetry::append_csv_row({.frame = frame,
                                       .time_s = frame / 60.0,
                                       .frame_ms = 4.0 + frame % 3,
                                       .selection_ms = 0.5,
                                       .triangles = 1000 + frame,
                                       .tiles_wanted = 40,
                                       .ram_cache_bytes = 1 << 20},
                                      csv);
        write_text(path() / name / "frames.csv", csv);
        write_text(path() / name / "summary.json", summary_text(dataset, options, frames));
        return path() / name;
    }

  private:
    Folder folder_;
};

}  // namespace ridgeline::test
