// Contracts: what a caller owes a function. A broken contract is a bug, so it stops the program at the place.
//
// RIDGELINE_CHECK holds in every build; RIDGELINE_ASSERT where contracts are checked (debug, sanitizers).
#pragma once

namespace ridgeline {

[[noreturn]] void contract_broken(const char* condition, const char* file, int line);

}  // namespace ridgeline

#define RIDGELINE_CHECK(condition) \
    (static_cast<bool>(condition) ? void(0) : ::ridgeline::contract_broken(#condition, __FILE__, __LINE__))

#if !defined(NDEBUG) || defined(RIDGELINE_CONTRACTS)
#define RIDGELINE_ASSERT(condition) RIDGELINE_CHECK(condition)
#else
#define RIDGELINE_ASSERT(condition) (true ? void(0) : void(condition))
#endif
