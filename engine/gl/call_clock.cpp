#include "ridgeline/gl/call_clock.h"

#include <glad/gl.h>
#include <time.h>

#include "ridgeline/base/contract.h"
#include "ridgeline/base/thread_role.h"

namespace ridgeline::gl {

#ifdef GLAD_OPTION_GL_DEBUG
namespace {

// glad's callbacks are functions without a context of their own.
struct Bracket {
    std::int64_t since_ns = 0, used_ns = 0, calls = 0;
};
Bracket bracket;
bool in_use = false;

std::int64_t thread_cpu_ns() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void open_bracket(const char*, GLADapiproc, int, ...) { bracket.since_ns = thread_cpu_ns(); }

void close_bracket(void*, const char*, GLADapiproc, int, ...) {
    bracket.used_ns += thread_cpu_ns() - bracket.since_ns;
    ++bracket.calls;
}

// Of brackets about nothing.
double measured_cost_ns() {
    constexpr int kBrackets = 2000;
    const std::int64_t start_ns = thread_cpu_ns();
    for (int i = 0; i < kBrackets; ++i) {
        open_bracket("", nullptr, 0);
        close_bracket(nullptr, "", nullptr, 0);
    }
    const auto all_ns = static_cast<double>(thread_cpu_ns() - start_ns);
    return (all_ns - static_cast<double>(bracket.used_ns)) / kBrackets;
}

}  // namespace

bool CallClock::available() { return true; }

CallClock::CallClock() {
    RIDGELINE_ASSERT_ROLE(render);
    RIDGELINE_CHECK(!in_use);
    in_use = true;
    bracket = {};
    cost_ns_ = measured_cost_ns();
    bracket = {};
    gladSetGLPreCallback(open_bracket);
    gladSetGLPostCallback(close_bracket);
    gladInstallGLDebug();
}

CallClock::~CallClock() {
    gladUninstallGLDebug();
    in_use = false;
}

std::int64_t CallClock::used_ns() const {
    return bracket.used_ns + static_cast<std::int64_t>(cost_ns_ * static_cast<double>(bracket.calls));
}

std::int64_t CallClock::calls() const { return bracket.calls; }

#else

bool CallClock::available() { return false; }
CallClock::CallClock() { RIDGELINE_CHECK(available()); }
CallClock::~CallClock() = default;
std::int64_t CallClock::used_ns() const { return 0; }
std::int64_t CallClock::calls() const { return 0; }

#endif

}  // namespace ridgeline::gl
