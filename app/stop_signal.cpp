#include "ridgeline/app/stop_signal.h"

#include <time.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>

namespace ridgeline::app {
namespace {

constexpr std::int64_t kSameWish_ns = 1'000'000'000;

std::atomic<bool> stop_asked{false};
std::atomic<std::int64_t> first_asked_ns{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free,
              "a signal handler may touch nothing else");

std::int64_t now_ns() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void on_signal(int signal) {
    const std::int64_t now = now_ns();
    std::int64_t first = 0;
    const bool is_first = first_asked_ns.compare_exchange_strong(first, now);
    stop_asked.store(true);
    // What the shell reports of a program that a signal ended.
    if (!is_first && now - first >= kSameWish_ns) _exit(128 + signal);
}

}  // namespace

const std::atomic<bool>& watch_stop_signals() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    struct sigaction hang_up {};
    sigaction(SIGHUP, nullptr, &hang_up);
    if (hang_up.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
    return stop_asked;
}

void report_file_size_limit() { std::signal(SIGXFSZ, SIG_IGN); }

}  // namespace ridgeline::app
