// Files that are whole or not there: written beside their place, flushed, and renamed. Any thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "ridgeline/base/result.h"

namespace ridgeline {

// Replaces `file` at once; on failure what stood there still stands, and nothing is left beside it.
Result<void> write_whole_file(const std::filesystem::path& file, std::span<const std::byte> bytes);
Result<void> write_whole_file(const std::filesystem::path& file, std::string_view text);

// The bytes of a file, of at most `limit_bytes`: for configuration and paths, not for data.
Result<std::string> read_text_file(const std::filesystem::path& file, std::size_t limit_bytes = 1U << 28);

}  // namespace ridgeline
