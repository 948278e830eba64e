// What suite `stress` does to caches and disks.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "ridgeline/app/options.h"
#include "ridgeline/base/units.h"
#include "ridgeline/pager/fault.h"

namespace ridgeline::app {

struct StressVariant {
    const char* name;
    // Of RAM and of the GPU each; 0: the suite's.
    std::uint64_t cache_bytes = 0;
    pager::FaultSpec fault{};

    CacheSizes caches(const CacheSizes& usual) const {
        return cache_bytes > 0 ? CacheSizes{cache_bytes, cache_bytes} : usual;
    }
};

inline constexpr std::chrono::milliseconds kSlowRead{50};

// The first one is the others' measure.
inline constexpr std::array<StressVariant, 10> kStressVariants = {
    {{.name = "clean"},
     {.name = "cache_32MiB", .cache_bytes = 32_MiB},
     {.name = "cache_128MiB", .cache_bytes = 128_MiB},
     {.name = "cache_1GiB", .cache_bytes = 1_GiB},
     {.name = "slow", .fault = {.delay = kSlowRead}},
     {.name = "errors", .fault = {.error = 0.1}},
     {.name = "short_reads", .fault = {.short_read = 0.1}},
     {.name = "corrupt", .fault = {.corrupt = 0.1}},
     {.name = "slow_errors", .fault = {.delay = kSlowRead, .error = 0.1}},
     {.name = "all_faults",
      .fault = {.delay = kSlowRead / 2, .error = 0.1, .short_read = 0.05, .corrupt = 0.05}}}};

inline std::vector<std::string> stress_variant_names() {
    std::vector<std::string> names;
    for (const StressVariant& variant : kStressVariants) names.emplace_back(variant.name);
    return names;
}

}  // namespace ridgeline::app
