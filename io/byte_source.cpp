#include "ridgeline/io/byte_source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace ridgeline::io {
namespace {

class FileSource final : public ByteSource {
  public:
    FileSource(int file, std::uint64_t size, std::filesystem::path path)
        : file_(file), size_(size), path_(std::move(path)) {}
    ~FileSource() override { ::close(file_); }
    FileSource(const FileSource&) = delete;
    FileSource& operator=(const FileSource&) = delete;

    std::uint64_t size() const override { return size_; }

    Result<void> read(std::uint64_t offset, std::span<std::uint8_t> bytes) override {
        while (!bytes.empty()) {
            const ssize_t got = ::pread(file_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
            if (got < 0 && errno == EINTR) continue;
            if (got < 0) return Error{path_.string() + ": " + std::strerror(errno)};
            if (got == 0)
                return Error{path_.string() + ": the file ends too early: it was cut off, build it again"};
            offset += static_cast<std::uint64_t>(got);
            bytes = bytes.subspan(static_cast<std::size_t>(got));
        }
        return {};
    }

  private:
    int file_;
    std::uint64_t size_;
    std::filesystem::path path_;
};

}  // namespace

Result<std::unique_ptr<ByteSource>> open_file(const std::filesystem::path& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return Error{path.string() + ": " + std::strerror(errno)};
    struct stat status {};
    if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) {
        ::close(file);
        return Error{path.string() + ": not a regular file"};
    }
    return std::unique_ptr<ByteSource>(
        new FileSource(file, static_cast<std::uint64_t>(status.st_size), path));
}

}  // namespace ridgeline::io
