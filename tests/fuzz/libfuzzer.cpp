// The driver under clang's fuzzer.
#include <cstddef>

#include "fuzz/fuzz_body.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    (void)ridgeline::fuzz::try_input({data, size});
    return 0;
}
