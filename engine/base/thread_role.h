// Thread roles: which thread may call what. A thread takes its role once, at its start; single-thread classes
// assert it. Roles are checked where contracts are (debug and sanitizer builds) and cost nothing elsewhere.
#pragma once

#include "ridgeline/base/contract.h"

namespace ridgeline {

enum class ThreadRole { unnamed, render, worker, io };

// Names the calling thread for debuggers and traces (at most 15 characters are kept) and sets its role.
void set_thread_role(ThreadRole role, const char* name);
ThreadRole thread_role();
// The name given to set_thread_role, or "thread".
const char* thread_name();

}  // namespace ridgeline

// The unnamed role passes, so that tests and tools may own single-thread classes without ceremony.
#define RIDGELINE_ASSERT_ROLE(role)                                                 \
    RIDGELINE_ASSERT(::ridgeline::thread_role() == ::ridgeline::ThreadRole::role || \
                     ::ridgeline::thread_role() == ::ridgeline::ThreadRole::unnamed)
