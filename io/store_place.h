// The place of a store that is written: what may stand there.
#pragma once

#include <filesystem>

#include "ridgeline/base/result.h"
#include "ridgeline/io/pending_directory.h"

namespace ridgeline::io {

// "a/b/" and "a/b" are the same directory.
std::filesystem::path normalised(const std::filesystem::path& path);

// Fails where something stands that does not give way: a symbolic link, what is no store, and a store unless
// Replace::existing.
Result<void> check_target(const std::filesystem::path& target, Replace replace);

}  // namespace ridgeline::io
