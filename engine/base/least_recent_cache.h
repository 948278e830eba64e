// A handful of decoded tiles, the least recently used making room. One thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "ridgeline/base/contract.h"

namespace ridgeline {

// So few that looking through all of them beats any index.
template <class Value>
class LeastRecentCache {
  public:
    explicit LeastRecentCache(std::size_t capacity) : entries_(capacity) { RIDGELINE_CHECK(capacity > 0); }

    // The value of a key, or null. Valid until the next make().
    Value* find(std::int64_t key) {
        for (Entry& entry : entries_)
            if (entry.key == key) return entry.used = ++clock_, &entry.value;
        return nullptr;
    }
    // Room for a new key: a used value, whose memory may serve again.
    Value& make(std::int64_t key) {
        Entry& oldest = *std::min_element(entries_.begin(), entries_.end(),
                                          [](const Entry& a, const Entry& b) { return a.used < b.used; });
        oldest.key = key;
        oldest.used = ++clock_;
        return oldest.value;
    }
    void forget(std::int64_t key) {
        for (Entry& entry : entries_)
            if (entry.key == key) entry.key = kNone, entry.used = 0;
    }

  private:
    static constexpr std::int64_t kNone = -1;
    struct Entry {
        std::int64_t key = kNone;
        std::uint64_t used = 0;
        Value value{};
    };
    std::vector<Entry> entries_;
    std::uint64_t clock_ = 0;
};

}  // namespace ridgeline
