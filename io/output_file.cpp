#include "ridgeline/io/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace ridgeline::io {
namespace {

Error system_error(const std::filesystem::path& path) {
    return Error{path.string() + ": " + std::strerror(errno)};
}

}  // namespace

Result<OutputFile> OutputFile::create(const std::filesystem::path& path) {
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0) return system_error(path);
    return OutputFile(file, path);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : file_(std::exchange(other.file_, -1)), size_(other.size_), path_(std::move(other.path_)) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
    std::swap(file_, other.file_);
    std::swap(size_, other.size_);
    std::swap(path_, other.path_);
    return *this;
}

OutputFile::~OutputFile() {
    if (file_ >= 0) ::close(file_);
}

Error OutputFile::failure() const { return system_error(path_); }

Result<void> OutputFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::pwrite(file_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return failure();
        offset += static_cast<std::uint64_t>(written);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return {};
}

Result<void> OutputFile::read_at(std::uint64_t offset, std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t got = ::pread(file_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return failure();
        if (got == 0) return Error{path_.string() + ": cut off while it was in use"};
        offset += static_cast<std::uint64_t>(got);
        bytes = bytes.subspan(static_cast<std::size_t>(got));
    }
    return {};
}

Result<std::uint64_t> OutputFile::append(std::span<const std::byte> bytes) {
    const std::uint64_t offset = size_;
    RIDGELINE_TRY(write_at(offset, bytes));
    size_ += bytes.size();
    return offset;
}

void OutputFile::start_sync() {
    // A hint: the disk works while the caller goes on. Failures show in sync().
    (void)::sync_file_range(file_, 0, 0, SYNC_FILE_RANGE_WRITE);
}

Result<void> OutputFile::sync() {
    if (::fsync(file_) != 0) return failure();
    return {};
}

Result<void> sync_file(const std::filesystem::path& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return system_error(path);
    const bool synced = ::fsync(file) == 0;
    const Error error = system_error(path);
    ::close(file);
    return synced ? Result<void>() : Result<void>(error);
}

Result<void> sync_directory(const std::filesystem::path& path) {
    const int directory = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (directory < 0) return system_error(path);
    const int synced = ::fsync(directory);
    // Some file systems cannot sync directories and say so with EINVAL; there is nothing to gain from
    // failing.
    const bool failed = synced != 0 && errno != EINVAL;
    const Error error = system_error(path);
    ::close(directory);
    return failed ? Result<void>(error) : Result<void>();
}

}  // namespace ridgeline::io
