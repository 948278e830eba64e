#include "ridgeline/build/block_pipeline.h"

#include <utility>

namespace ridgeline::build {

std::unique_ptr<TileMaker> MakerPool::take() {
    {
        const MutexLock lock(mutex_);
        if (!free_.empty()) {
            auto maker = std::move(free_.back());
            free_.pop_back();
            return maker;
        }
    }
    return std::make_unique<TileMaker>();
}

void MakerPool::give_back(std::unique_ptr<TileMaker> maker) {
    const MutexLock lock(mutex_);
    free_.push_back(std::move(maker));
}

BlockPipeline::BlockPipeline(jobs::JobSystem& jobs, MakerPool& makers,
                             std::vector<std::unique_ptr<BlockSlot>>& slots, Work work, Take take)
    : jobs_(jobs), makers_(makers), slots_(slots), work_(std::move(work)), take_(std::move(take)) {}

BlockPipeline::~BlockPipeline() {
    for (auto& slot : slots_) {
        jobs_.wait(slot->counter);
        slot->submitted = false;
    }
}

Result<void> BlockPipeline::take(BlockSlot& slot) {
    jobs_.wait(slot.counter);
    if (!std::exchange(slot.submitted, false)) return {};
    return take_(slot);
}

Result<BlockSlot*> BlockPipeline::next() {
    current_ = (current_ + 1) % slots_.size();
    BlockSlot& slot = *slots_[current_];
    RIDGELINE_TRY(take(slot));
    return &slot;
}

void BlockPipeline::submit() {
    BlockSlot& slot = *slots_[current_];
    slot.submitted = true;
    jobs_.submit(
        [this, &slot] {
            auto maker = makers_.take();
            work_(*maker, slot);
            makers_.give_back(std::move(maker));
        },
        &slot.counter);
}

Result<void> BlockPipeline::drain() {
    for (std::size_t i = 0; i < slots_.size(); ++i)
        if (const auto slot = next(); !slot) return slot.error();
    return {};
}

}  // namespace ridgeline::build
