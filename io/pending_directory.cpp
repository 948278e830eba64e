#include "ridgeline/io/pending_directory.h"

#include <fcntl.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "ridgeline/io/output_file.h"

namespace ridgeline::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSuffix = ".partial-";

Error system_error(const fs::path& path) { return Error{path.string() + ": " + std::strerror(errno)}; }

fs::path parent_of(const fs::path& target) {
    return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

// The directory itself carries the lock. -1: it is gone, or its maker lives.
int lock_directory(const fs::path& path) {
    const int directory = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (directory < 0) return -1;
    if (::flock(directory, LOCK_EX | LOCK_NB) == 0) return directory;
    ::close(directory);
    return -1;
}

void remove_stale(const fs::path& target) {
    const std::string prefix = target.filename().string() + kSuffix;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(parent_of(target), ignored)) {
        if (!entry.path().filename().string().starts_with(prefix)) continue;
        const int lock = lock_directory(entry.path());
        if (lock < 0) continue;
        fs::remove_all(entry.path(), ignored);
        ::close(lock);
    }
}

Result<void> move_into_place(const fs::path& from, const fs::path& to) {
    if (::rename(from.c_str(), to.c_str()) != 0) return system_error(to);
    return {};
}

// For file systems that cannot swap.
Result<void> replace_by_two_renames(const fs::path& from, const fs::path& to) {
    const fs::path aside = to.string() + ".old";
    if (::rename(to.c_str(), aside.c_str()) != 0) return system_error(to);
    if (const auto moved = move_into_place(from, to); !moved) {
        const int back = ::rename(aside.c_str(), to.c_str());
        return back == 0 ? moved : Error{moved.error().message + "; the old one is now " + aside.string()};
    }
    std::error_code ignored;
    fs::remove_all(aside, ignored);
    return {};
}

}  // namespace

Result<PendingDirectory> PendingDirectory::create(const fs::path& target) {
    remove_stale(target);
    const std::string prefix = target.string() + kSuffix + std::to_string(::getpid()) + "-";
    for (int attempt = 0;; ++attempt) {
        const fs::path path = prefix + std::to_string(attempt);
        if (::mkdir(path.c_str(), 0777) == 0) return PendingDirectory(path, target, lock_directory(path));
        if (errno != EEXIST) return system_error(parent_of(target));
    }
}

PendingDirectory::PendingDirectory(PendingDirectory&& other) noexcept
    : path_(std::exchange(other.path_, {})),
      target_(std::move(other.target_)),
      lock_(std::exchange(other.lock_, -1)) {}

PendingDirectory& PendingDirectory::operator=(PendingDirectory&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(target_, other.target_);
    std::swap(lock_, other.lock_);
    return *this;
}

PendingDirectory::~PendingDirectory() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
    if (lock_ >= 0) ::close(lock_);
}

Result<void> PendingDirectory::take_place() {
    std::error_code ignored;
    if (!fs::exists(target_, ignored)) {
        RIDGELINE_TRY(move_into_place(path_, target_));
    } else if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0) {
        fs::remove_all(path_, ignored);
    } else {
        RIDGELINE_TRY(replace_by_two_renames(path_, target_));
    }
    path_.clear();
    return sync_directory(parent_of(target_));
}

}  // namespace ridgeline::io
