// frames.csv as a walk wrote it: one row per frame, columns by name, in any order, some of them missing.
//
// What reads it asks for columns by name and lives without those that are not there: telemetry of other
// releases has more of them, or fewer. A file that is no such table (rows of other lengths, words for
// numbers) is refused, for half a run would pass for a whole one. Pure functions of the text; any thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ridgeline/base/result.h"

namespace ridgeline::app::report {

class FrameTable {
  public:
    FrameTable() = default;
    explicit FrameTable(std::vector<std::pair<std::string, std::vector<double>>> columns)
        : columns_(std::move(columns)) {}

    std::size_t frames() const { return columns_.empty() ? 0 : columns_.front().second.size(); }
    // One value a frame, NaN where it was not measured; null where there is no such column.
    const std::vector<double>* find(std::string_view column) const;

  private:
    std::vector<std::pair<std::string, std::vector<double>>> columns_;  // all of one length
};

// `name` is the file's, for messages.
Result<FrameTable> parse_frames_csv(std::string_view text, const std::string& name);
Result<FrameTable> read_frames_csv(const std::filesystem::path& file);

}  // namespace ridgeline::app::report
