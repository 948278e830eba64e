// Positioned reads: the one interface through which payloads come, so that HTTP range reads can stand where
// files do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "ridgeline/base/result.h"

namespace ridgeline::io {

class ByteSource {
  public:
    virtual ~ByteSource() = default;
    // Fills `bytes` from `offset`; fewer bytes than asked are an Error. Any thread, several at once.
    virtual Result<void> read(std::uint64_t offset, std::span<std::uint8_t> bytes) = 0;
    virtual std::uint64_t size() const = 0;
};

Result<std::unique_ptr<ByteSource>> open_file(const std::filesystem::path& path);

}  // namespace ridgeline::io
