#include "ridgeline/base/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace ridgeline {
namespace {

namespace fs = std::filesystem;

Error file_error(const std::filesystem::path& file, int code) {
    return Error{file.string() + ": " + std::generic_category().message(code)};
}

// The errno of what failed, or 0.
int write_all(int descriptor, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    // Pipes and devices hold nothing that could be flushed, and say so with EINVAL.
    return ::fsync(descriptor) == 0 || errno == EINVAL ? 0 : errno;
}

int write_into(const fs::path& file, int flags, std::span<const std::byte> bytes) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC | flags, 0666);
    if (descriptor < 0) return errno;
    const int failed = write_all(descriptor, bytes);
    const int not_closed = ::close(descriptor) == 0 ? 0 : errno;
    return failed != 0 ? failed : not_closed;
}

// Where writing to the name would end up: links are followed, also to files that are not there yet.
fs::path behind_links(fs::path file) {
    constexpr int kMostLinks = 40;  // what the system itself follows
    std::error_code ignored;
    for (int link = 0; link < kMostLinks && fs::is_symlink(fs::symlink_status(file, ignored)); ++link)
        file = file.parent_path() / fs::read_symlink(file, ignored);
    return file;
}

bool is_replaceable(const fs::path& file) {
    std::error_code ignored;
    const fs::file_status status = fs::status(file, ignored);
    return !fs::exists(status) || fs::is_regular_file(status) || fs::is_directory(status);
}

int replace(const fs::path& file, std::span<const std::byte> bytes) {
    // The process id keeps two runs that write the same file from writing into each other.
    const fs::path beside = file.string() + "." + std::to_string(::getpid()) + ".part";
    int failed = write_into(beside, O_CREAT | O_TRUNC, bytes);
    if (failed == 0 && ::rename(beside.c_str(), file.c_str()) != 0) failed = errno;
    if (failed != 0) ::unlink(beside.c_str());
    return failed;
}

}  // namespace

Result<void> write_whole_file(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    const int failed = is_replaceable(file) ? replace(behind_links(file), bytes) : write_into(file, 0, bytes);
    if (failed != 0) return file_error(file, failed);
    return {};
}

Result<void> write_whole_file(const std::filesystem::path& file, std::string_view text) {
    return write_whole_file(file, std::as_bytes(std::span(text)));
}

Result<std::string> read_text_file(const std::filesystem::path& file, std::size_t limit_bytes) {
    std::error_code failed;
    const auto size = std::filesystem::file_size(file, failed);
    if (failed) return Error{file.string() + ": " + failed.message()};
    if (size > limit_bytes) return Error{file.string() + ": is larger than any such file"};
    std::string text(size, '\0');
    std::ifstream stream(file, std::ios::binary);
    if (!stream.read(text.data(), static_cast<std::streamsize>(size))) return file_error(file, EIO);
    return text;
}

}  // namespace ridgeline
