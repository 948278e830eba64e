#include "ridgeline/io/pending_directory.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>

#include "ridgeline/io/output_file.h"

namespace ridgeline::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSuffix = ".partial-";
// An empty file in every directory of ours, from just after it is made until just after it is in its place.
constexpr const char* kMark = ".ridgeline-partial";

Error system_error(const fs::path& path) { return Error{path.string() + ": " + std::strerror(errno)}; }

fs::path parent_of(const fs::path& target) {
    return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

// NAME.partial-DIGITS-DIGITS.
bool is_named_like_ours(const fs::path& path, const fs::path& target) {
    const std::string name = path.filename().string(), prefix = target.filename().string() + kSuffix;
    if (!name.starts_with(prefix)) return false;
    const std::string_view numbers = std::string_view(name).substr(prefix.size());
    const auto dash = numbers.find('-');
    const auto digits = [](std::string_view text) {
        return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
    };
    return dash != std::string_view::npos && digits(numbers.substr(0, dash)) &&
           digits(numbers.substr(dash + 1));
}

bool is_marked(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(fs::symlink_status(path / kMark, ignored));
}

Result<void> mark(const fs::path& path) {
    auto file = OutputFile::create(path / kMark);
    if (!file) return file.error();
    return {};
}

// The mark goes last: whatever interrupts this leaves a folder that is still known as ours.
void remove_marked(const fs::path& path) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(path, ignored))
        if (entry.path().filename() != kMark) fs::remove_all(entry.path(), ignored);
    fs::remove_all(path, ignored);
}

// The directory itself carries the lock. -1: it is gone, or its maker lives, or the file system has no locks,
// and then nothing is ever taken for stale.
int lock_directory(const fs::path& path) {
    const int directory = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (directory < 0) return -1;
    if (::flock(directory, LOCK_EX | LOCK_NB) == 0) return directory;
    ::close(directory);
    return -1;
}

// The process that NAME.partial-PROCESS-DIGITS names is gone.
bool maker_is_gone(const fs::path& path, const fs::path& target) {
    const std::string number = path.filename().string().substr((target.filename().string() + kSuffix).size());
    const long maker = std::strtol(number.c_str(), nullptr, 10);
    return maker > 0 && ::kill(static_cast<pid_t>(maker), 0) != 0 && errno == ESRCH;
}

// Makers lock before they mark, so what is marked and can be locked has lost its maker. One that was killed
// before it could mark leaves an empty directory.
void remove_stale(const fs::path& target) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(parent_of(target), ignored)) {
        if (!is_named_like_ours(entry.path(), target)) continue;
        if (!is_marked(entry.path())) {
            if (maker_is_gone(entry.path(), target)) ::rmdir(entry.path().c_str());
            continue;
        }
        const int lock = lock_directory(entry.path());
        if (lock < 0) continue;
        remove_marked(entry.path());
        ::close(lock);
    }
}

// Where the old one waits on a file system that cannot swap: no name that anybody gives a copy.
fs::path aside_of(const fs::path& target) { return target.string() + kSuffix + "old"; }

// What a killed maker had put aside.
void settle_aside(const fs::path& target) {
    const fs::path aside = aside_of(target);
    if (!is_marked(aside)) return;
    const int lock = lock_directory(aside);
    if (lock < 0) return;
    std::error_code ignored;
    if (fs::exists(fs::symlink_status(target, ignored)))
        remove_marked(aside);
    else
        ::rename(aside.c_str(), target.c_str());
    ::close(lock);
}

// That of a maker who was killed just before or just after it took its place: living ones hold the lock.
void remove_stale_mark(const fs::path& target) {
    if (!is_marked(target)) return;
    const int lock = lock_directory(target);
    if (lock < 0) return;
    std::error_code ignored;
    fs::remove(target / kMark, ignored);
    ::close(lock);
}

Result<void> move_into_place(const fs::path& from, const fs::path& to) {
    if (::rename(from.c_str(), to.c_str()) != 0) return system_error(to);
    return {};
}

Error in_the_way(const fs::path& target) {
    return Error{target.string() + ": exists already; --force replaces it"};
}

// Nothing may stand at `to`.
Result<void> move_to_free_place(const fs::path& from, const fs::path& to) {
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return {};
    if (errno == EEXIST) return in_the_way(to);
    if (errno != EINVAL) return system_error(to);
    // A file system without that flag: what comes between these two lines is refused by the rename, which
    // replaces no file and no directory but an empty one.
    std::error_code ignored;
    if (fs::exists(fs::symlink_status(to, ignored))) return in_the_way(to);
    return move_into_place(from, to);
}

// For file systems that cannot swap.
Result<void> replace_by_two_renames(const fs::path& from, const fs::path& to) {
    const fs::path aside = aside_of(to);
    if (::rename(to.c_str(), aside.c_str()) != 0) return system_error(to);
    if (const auto moved = move_into_place(from, to); !moved) {
        const int back = ::rename(aside.c_str(), to.c_str());
        return back == 0 ? moved : Error{moved.error().message + "; the old one is now " + aside.string()};
    }
    remove_marked(aside);
    return {};
}

Result<void> swap_marked(const fs::path& from, const fs::path& to) {
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) != 0)
        return replace_by_two_renames(from, to);
    // The old one now has our name beside the target.
    remove_marked(from);
    return {};
}

// The old one is marked before it leaves its place, so that a maker who is killed between that and its removal
// does not leave it behind for good; and locked, so that nobody takes the mark for such a maker's. Where it
// cannot be marked (a full disk), it would only stay there longer.
Result<void> swap_into_place(const fs::path& from, const fs::path& to) {
    const int lock = lock_directory(to);
    (void)mark(to);
    const auto swapped = swap_marked(from, to);
    std::error_code ignored;
    if (!swapped) fs::remove(to / kMark, ignored);
    if (lock >= 0) ::close(lock);
    return swapped;
}

}  // namespace

void PendingDirectory::remove_left(const fs::path& target) {
    remove_stale(target);
    settle_aside(target);
    remove_stale_mark(target);
}

Result<PendingDirectory> PendingDirectory::create(const fs::path& target) {
    remove_left(target);
    const std::string prefix = target.string() + kSuffix + std::to_string(::getpid()) + "-";
    for (int attempt = 0;; ++attempt) {
        const fs::path path = prefix + std::to_string(attempt);
        if (::mkdir(path.c_str(), 0777) == 0) {
            PendingDirectory created(path, target, lock_directory(path));
            RIDGELINE_TRY(mark(path));
            return created;
        }
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
    if (!path_.empty()) remove_marked(path_);
    if (lock_ >= 0) ::close(lock_);
}

Result<void> PendingDirectory::take_place(Replace replace) {
    std::error_code ignored;
    if (replace == Replace::existing && fs::exists(fs::symlink_status(target_, ignored)))
        RIDGELINE_TRY(swap_into_place(path_, target_));
    else
        RIDGELINE_TRY(move_to_free_place(path_, target_));
    path_.clear();
    fs::remove(target_ / kMark, ignored);
    return sync_directory(parent_of(target_));
}

}  // namespace ridgeline::io
