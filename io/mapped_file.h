// A file mapped for reading; unmapped when the object goes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <utility>

#include "ridgeline/base/result.h"

namespace ridgeline::io {

class MappedFile {
  public:
    static Result<MappedFile> open(const std::filesystem::path& path);
    MappedFile() = default;
    MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}
    MappedFile& operator=(MappedFile&& other) noexcept {
        std::swap(bytes_, other.bytes_);
        return *this;
    }
    ~MappedFile();

    std::span<const std::byte> bytes() const { return bytes_; }

    // Gives back the memory of pages that were looked at: after a look at all of a large file of which little is
    // used later. They come again as they are looked at, from the system's cache. Any thread.
    void forget_pages() const;

  private:
    explicit MappedFile(std::span<const std::byte> bytes) : bytes_(bytes) {}
    std::span<const std::byte> bytes_;
};

}  // namespace ridgeline::io
