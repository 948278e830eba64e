#include "ridgeline/base/contract.h"

#include <cstdio>
#include <cstdlib>

namespace ridgeline {

void contract_broken(const char* condition, const char* file, int line) {
    std::fprintf(stderr, "ridgeline: contract broken: %s (%s:%d)\n", condition, file, line);
    std::abort();
}

}  // namespace ridgeline
