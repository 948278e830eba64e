// A telemetry folder, read whole, and the name by which the page calls it.
//
// Any thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "ridgeline/app/report/frames_csv.h"
#include "ridgeline/app/report/summary_file.h"
#include "ridgeline/app/report/thumbnails.h"
#include "ridgeline/base/result.h"

namespace ridgeline::app::report {

struct RunFolder {
    std::string name;  // the folder's, as short as tells it apart from the others
    FrameTable frames;
    SummaryFile summary;
    Thumbnails thumbnails;
};

// The folders' own names; where two are the same, with as many of the folders above as tell them apart; a
// folder named twice is numbered.
std::vector<std::string> names_apart(const std::vector<std::filesystem::path>& folders);

// All of them or the first failure. `thumbnails`: how many pictures at most, shared out among the runs.
Result<std::vector<RunFolder>> read_runs(const std::vector<std::filesystem::path>& folders,
                                         std::size_t thumbnails);

}  // namespace ridgeline::app::report
