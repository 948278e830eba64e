// Directories in the making: what they may remove, and what they may take the place of.
#include <doctest/doctest.h>
#include <signal.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>

#include "ridgeline/io/pending_directory.h"

using namespace ridgeline;
using namespace ridgeline::io;
namespace fs = std::filesystem;

namespace {

class Folder {
  public:
    Folder() {
        fs::remove_all(path_);
        fs::create_directories(path_);
    }
    ~Folder() { fs::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    fs::path operator/(const std::string& name) const { return path_ / name; }
    long entries() const { return std::distance(fs::directory_iterator(path_), {}); }

  private:
    fs::path path_ = fs::temp_directory_path() / ("ridgeline-pending-" + std::to_string(::getpid()));
};

void write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

std::string text_of(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

PendingDirectory pending(const fs::path& target) {
    auto created = PendingDirectory::create(target);
    REQUIRE(created);
    write(created->path() / "content", "new");
    return std::move(*created);
}

// What a maker leaves that is killed at work.
void leave_behind(const fs::path& target) {
    const pid_t maker = ::fork();
    if (maker == 0) {
        const auto created = PendingDirectory::create(target);
        ::_exit(created ? 0 : 1);
    }
    int status = 1;
    REQUIRE(::waitpid(maker, &status, 0) == maker);
    REQUIRE(status == 0);
}

enum class End { killed, finished, not_allowed };

// Runs `work` in a process that is killed at its n-th step into or out of a system call.
End run_killed(int n, const std::function<void()>& work) {
    const pid_t child = ::fork();
    if (child == 0) {
        if (::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) ::_exit(1);
        ::raise(SIGSTOP);
        work();
        ::_exit(0);
    }
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    if (!WIFSTOPPED(status)) return End::not_allowed;
    for (int step = 0; step < n; ++step) {
        REQUIRE(::ptrace(PTRACE_SYSCALL, child, nullptr, nullptr) == 0);
        REQUIRE(::waitpid(child, &status, 0) == child);
        if (WIFEXITED(status)) return End::finished;
    }
    ::kill(child, SIGKILL);
    REQUIRE(::waitpid(child, &status, 0) == child);
    return End::killed;
}

// Whether the target holds what `content` says, whole, and nothing else but a mark.
bool holds(const fs::path& target, const std::string& content) {
    const bool marked = fs::exists(target / ".ridgeline-partial");
    return text_of(target / "content") == content &&
           std::distance(fs::directory_iterator(target), {}) == (marked ? 2 : 1);
}

}  // namespace

TEST_CASE("pending directory: killed at any system call, the old stands or the new, and the next tidies up") {
    for (const Replace replace : {Replace::never, Replace::existing})
        for (int n = 0;; ++n) {
            const Folder folder;
            const fs::path target = folder / "x.terrain";
            if (replace == Replace::existing) write(target / "content", "old");
            const End end = run_killed(n, [&] {
                auto made = PendingDirectory::create(target);
                if (!made) return;
                write(made->path() / "content", "new");
                (void)made->take_place(replace);
            });
            if (end == End::not_allowed) {
                MESSAGE("skipped: processes may not be traced here");
                return;
            }
            CAPTURE(n);
            if (replace == Replace::existing || fs::exists(target))
                CHECK((holds(target, "new") || (replace == Replace::existing && holds(target, "old"))));
            CHECK(folder.entries() <= 2);
            const bool stood = fs::exists(target);
            PendingDirectory::remove_left(target);
            CHECK(folder.entries() == (stood ? 1 : 0));
            if (stood) CHECK(std::distance(fs::directory_iterator(target), {}) == 1);
            if (end == End::finished) break;
        }
}

TEST_CASE(
    "pending directory: an old one that a killed maker had put aside comes back, or goes where a new one "
    "stands") {
    const Folder folder;
    const fs::path target = folder / "x.terrain", aside = folder / "x.terrain.partial-old";
    write(aside / "content", "precious");
    PendingDirectory::remove_left(target);
    CHECK(text_of(aside / "content") == "precious");
    CHECK_FALSE(fs::exists(target));
    write(aside / ".ridgeline-partial", "");
    PendingDirectory::remove_left(target);
    CHECK(holds(target, "precious"));
    CHECK(folder.entries() == 1);
    write(aside / "content", "older");
    write(aside / ".ridgeline-partial", "");
    PendingDirectory::remove_left(target);
    CHECK(holds(target, "precious"));
    CHECK(folder.entries() == 1);
}

TEST_CASE(
    "pending directory: what a killed maker left goes, what a living one makes and what others made stays") {
    const Folder folder;
    const fs::path target = folder / "x.terrain";
    leave_behind(target);
    CHECK(folder.entries() == 1);
    write(folder / "x.terrain.partial-mine" / "notes.txt", "precious");
    write(folder / "x.terrain.partial-12345-0" / "notes.txt", "precious");
    write(folder / "x.terrain.partial-12345-1" / "scratch" / "notes.txt", "precious");
    const PendingDirectory living = pending(target);
    const PendingDirectory another = pending(target);
    CHECK(folder.entries() == 5);
    CHECK(fs::exists(living.path() / "content"));
    CHECK(text_of(folder / "x.terrain.partial-mine" / "notes.txt") == "precious");
    CHECK(text_of(folder / "x.terrain.partial-12345-0" / "notes.txt") == "precious");
    CHECK(text_of(folder / "x.terrain.partial-12345-1" / "scratch" / "notes.txt") == "precious");
}

TEST_CASE("pending directory: an empty one goes where its maker was killed before it could mark it") {
    const Folder folder;
    const fs::path target = folder / "x.terrain";
    const pid_t killed = ::fork();
    if (killed == 0) ::_exit(0);
    REQUIRE(::waitpid(killed, nullptr, 0) == killed);
    const auto unmarked = [&](pid_t maker) {
        const fs::path path = folder / ("x.terrain.partial-" + std::to_string(maker) + "-77");
        fs::create_directory(path);
        return path;
    };
    const fs::path left = unmarked(killed), just_begun = unmarked(::getpid());
    const PendingDirectory next = pending(target);
    CHECK_FALSE(fs::exists(left));
    CHECK(fs::exists(just_begun));
}

TEST_CASE("pending directory: one that is not completed goes, one that is stands alone, as it was made") {
    const Folder folder;
    const fs::path target = folder / "x.terrain";
    { const PendingDirectory given_up = pending(target); }
    CHECK(folder.entries() == 0);
    PendingDirectory made = pending(target);
    REQUIRE(made.take_place(Replace::never));
    CHECK(folder.entries() == 1);
    CHECK(text_of(target / "content") == "new");
    CHECK(std::distance(fs::directory_iterator(target), {}) == 1);
}

TEST_CASE("pending directory: what came to the target meanwhile is replaced only on demand") {
    const Folder folder;
    const fs::path target = folder / "x.terrain";
    {
        PendingDirectory late = pending(target);
        write(target / "content", "old");
        const auto refused = late.take_place(Replace::never);
        REQUIRE_FALSE(refused);
        CHECK(refused.error().message == target.string() + ": exists already; --force replaces it");
    }
    CHECK(folder.entries() == 1);
    CHECK(text_of(target / "content") == "old");
    PendingDirectory forced = pending(target);
    REQUIRE(forced.take_place(Replace::existing));
    CHECK(folder.entries() == 1);
    CHECK(text_of(target / "content") == "new");
}

TEST_CASE("pending directory: not even an empty directory or a file gives way unasked") {
    const Folder folder;
    const fs::path target = folder / "x.terrain";
    PendingDirectory made = pending(target);
    fs::create_directory(target);
    CHECK_FALSE(made.take_place(Replace::never));
    fs::remove(target);
    write(target, "a file");
    CHECK_FALSE(made.take_place(Replace::never));
    CHECK(text_of(target) == "a file");
}
