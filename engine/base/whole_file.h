// Files that are whole or not there: written beside their place, flushed, and renamed. What is no regular
// file (a pipe, a terminal, /dev/null) cannot be replaced, only written into. Any thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "ridgeline/base/result.h"

namespace ridgeline {

// Replaces `file` at once; on failure what stood there still stands, and nothing is left beside it. Of a
// symbolic link, the file that it leads to is replaced. A pipe is waited for until somebody reads it.
Result<void> write_whole_file(const std::filesystem::path& file, std::span<const std::byte> bytes);
Result<void> write_whole_file(const std::filesystem::path& file, std::string_view text);

// The bytes of a file, of at most `limit_bytes`: for configuration and paths, not for data.
Result<std::string> read_text_file(const std::filesystem::path& file, std::size_t limit_bytes = 1U << 28);

}  // namespace ridgeline
