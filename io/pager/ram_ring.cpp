#include "ridgeline/pager/ram_ring.h"

#include <utility>

#include "ridgeline/base/units.h"

namespace ridgeline::pager {

Result<RamRing> RamRing::create(std::uint64_t bytes) {
    const std::uint64_t count = bytes / kPageBytes;
    RIDGELINE_CHECK(count > 0);
    if (count > PageAllocator::kMaxPages)
        return Error{"RAM cache of " + format_bytes(bytes) + ": too large: 4 TiB is the most"};
    Memory memory(new (std::align_val_t{kPageBytes}, std::nothrow) std::byte[count * kPageBytes]);
    auto pages = PageAllocator::create(static_cast<std::uint32_t>(count));
    if (!memory || !pages)
        return Error{"RAM cache of " + format_bytes(bytes) +
                     ": the system has not that much memory: use a smaller --ram-cache"};
    return RamRing(std::move(memory), std::move(pages).value());
}

RamBlock RamRing::allocate(std::size_t bytes) {
    RIDGELINE_CHECK(bytes > 0);
    if (bytes > capacity_bytes() - used_bytes()) return {};
    return pages_.allocate(pages_for(bytes));
}

}  // namespace ridgeline::pager
