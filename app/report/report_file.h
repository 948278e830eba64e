// Where the page goes: beside the telemetry, never over it, nor over anything else that a page did not make.
//
// Any thread.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "ridgeline/base/result.h"

namespace ridgeline::app::report {

// A file that stands there is replaced only if it is a page of ours. What belongs to the telemetry in
// `folders`, by whatever name or link, is refused as such. Pipes and devices hold nothing and are written
// into.
Result<void> write_report(const std::filesystem::path& file, std::string_view page,
                          std::span<const std::filesystem::path> folders);

}  // namespace ridgeline::app::report
