// A file that is being written: positioned reads and writes whose failures are Errors that name the file.
//
// Thread rules: reads and writes at given places from any thread, several at once; append() and sync() from
// one. Move-only; closes with the object, and stays on disk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "ridgeline/base/result.h"

namespace ridgeline::io {

class OutputFile {
  public:
    // Creates the file; one that exists is an Error.
    static Result<OutputFile> create(const std::filesystem::path& path);
    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&& other) noexcept;
    ~OutputFile();

    Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes);
    Result<void> read_at(std::uint64_t offset, std::span<std::byte> bytes) const;
    // Returns the offset at which the bytes lie.
    Result<std::uint64_t> append(std::span<const std::byte> bytes);
    // Bytes appended so far.
    std::uint64_t size() const { return size_; }
    // Begins to bring to the disk what is written so far, so that sync() has less to wait for.
    void start_sync();
    // Returns once everything is on the disk.
    Result<void> sync();

  private:
    OutputFile(int file, std::filesystem::path path) : file_(file), path_(std::move(path)) {}
    Error failure() const;

    int file_ = -1;
    std::uint64_t size_ = 0;
    std::filesystem::path path_;
};

// Returns once a file that others wrote is on the disk.
Result<void> sync_file(const std::filesystem::path& path);

// Makes renames and new files in a directory durable.
Result<void> sync_directory(const std::filesystem::path& path);

}  // namespace ridgeline::io
