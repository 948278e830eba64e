#include "ridgeline/pager/read_group.h"

#include "ridgeline/base/contract.h"

namespace ridgeline::pager {
namespace {

// A run of sorted candidates that grows at either end while it keeps the limits.
class Group {
  public:
    Group(std::span<ReadCandidate> sorted, std::size_t head, const ReadLimits& limits)
        : sorted_(sorted), limits_(limits), first_(head), last_(head + 1), ranges_(sorted[head].ranges) {}

    void grow() {
        while (last_ - first_ < limits_.max_members) {
            const bool before = first_ > 0 && takes(sorted_[first_ - 1]);
            const bool after = last_ < sorted_.size() && takes(sorted_[last_]);
            if (!before && !after) return;
            // The nearer one first: children lie together.
            const bool nearer_before = before && (!after || ranges_.gap(sorted_[first_ - 1].ranges) <
                                                                ranges_.gap(sorted_[last_].ranges));
            const std::size_t next = nearer_before ? --first_ : last_++;
            ranges_ = ranges_.joined(sorted_[next].ranges);
        }
    }
    std::span<ReadCandidate> members() const { return sorted_.subspan(first_, last_ - first_); }

  private:
    bool takes(const ReadCandidate& candidate) const {
        const ReadRanges together = ranges_.joined(candidate.ranges);
        return ranges_.gap(candidate.ranges) <= limits_.max_gap_bytes &&
               together.first.bytes() <= limits_.max_read_bytes &&
               together.second.bytes() <= limits_.max_read_bytes;
    }

    std::span<ReadCandidate> sorted_;
    const ReadLimits& limits_;
    std::size_t first_, last_;
    ReadRanges ranges_;
};

}  // namespace

std::span<ReadCandidate> choose_group(std::span<ReadCandidate> candidates, const ReadLimits& limits) {
    RIDGELINE_CHECK(!candidates.empty());
    const std::uint32_t head_index = candidates.front().index;
    std::sort(candidates.begin(), candidates.end(), [](const ReadCandidate& a, const ReadCandidate& b) {
        return std::pair(a.ranges.first.begin, a.index) < std::pair(b.ranges.first.begin, b.index);
    });
    const auto head = std::find_if(candidates.begin(), candidates.end(), [&](const ReadCandidate& candidate) {
        return candidate.index == head_index;
    });
    Group group(candidates, static_cast<std::size_t>(head - candidates.begin()), limits);
    group.grow();
    const auto members = group.members();
    std::sort(members.begin(), members.end(),
              [](const ReadCandidate& a, const ReadCandidate& b) { return a.index < b.index; });
    return members;
}

}  // namespace ridgeline::pager
