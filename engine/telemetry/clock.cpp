#include "ridgeline/telemetry/clock.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

#include "ridgeline/base/contract.h"

namespace ridgeline::telemetry {
namespace {

// Zero where the clock does not exist (any more).
std::int64_t read_clock_ns(clockid_t clock) {
    timespec now{};
    if (clock_gettime(clock, &now) != 0) return 0;
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

std::int64_t now_ns() { return read_clock_ns(CLOCK_MONOTONIC); }

ThreadCpuClock ThreadCpuClock::of_this_thread() {
    ThreadCpuClock made;
    RIDGELINE_CHECK(pthread_getcpuclockid(pthread_self(), &made.clock_) == 0);
    return made;
}

std::int64_t ThreadCpuClock::used_ns() const { return read_clock_ns(clock_); }

std::int64_t waits_of_this_thread() {
    rusage usage{};
    return getrusage(RUSAGE_THREAD, &usage) == 0 ? usage.ru_nvcsw : 0;
}

std::int64_t process_cpu_ns() { return read_clock_ns(CLOCK_PROCESS_CPUTIME_ID); }

std::uint64_t peak_rss_bytes() {
    rusage usage{};
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::uint64_t current_rss_bytes() {
    // "total resident shared ...", in pages. Read without a stream, which would allocate.
    const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    if (file < 0) return 0;
    char text[128] = {};
    const auto length = read(file, text, sizeof text - 1);
    close(file);
    const char* const resident = length > 0 ? std::strchr(text, ' ') : nullptr;
    if (!resident) return 0;
    return std::strtoull(resident, nullptr, 10) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::int64_t open_handles() {
    DIR* const folder = opendir("/proc/self/fd");
    if (!folder) return 0;
    std::int64_t count = 0;
    while (const dirent* entry = readdir(folder)) count += entry->d_name[0] != '.';
    closedir(folder);
    return count - 1;  // the folder itself
}

}  // namespace ridgeline::telemetry
