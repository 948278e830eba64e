#include "ridgeline/base/thread_role.h"

#include <pthread.h>

#include <cstdio>

namespace ridgeline {
namespace {

// The kernel keeps 15 characters and a zero.
constexpr int kNameBytes = 16;

struct Identity {
    ThreadRole role = ThreadRole::unnamed;
    char name[kNameBytes] = "thread";
};
thread_local Identity identity;

}  // namespace

void set_thread_role(ThreadRole role, const char* name) {
    identity.role = role;
    std::snprintf(identity.name, kNameBytes, "%s", name);
    pthread_setname_np(pthread_self(), identity.name);
}

ThreadRole thread_role() { return identity.role; }
const char* thread_name() { return identity.name; }

}  // namespace ridgeline
