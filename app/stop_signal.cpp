#include "ridgeline/app/stop_signal.h"

#include <unistd.h>
#include <csignal>

namespace ridgeline::app {
namespace {

std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch nothing else");

void on_signal(int signal) {
    // What the shell reports of a program that a signal ended.
    if (stop_asked.exchange(true)) _exit(128 + signal);
}

}  // namespace

const std::atomic<bool>& watch_stop_signals() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    return stop_asked;
}

}  // namespace ridgeline::app
