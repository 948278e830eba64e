// Blocks through jobs: one thread reads windows and takes results, in order, while workers compute.
//
// The thread that owns the pipeline does all input and output. Slots go round: before a slot is used again
// its job is waited for (the thread works meanwhile) and its result taken, so results come in the order of
// submission and memory is that of the slots. Thread rules: every method from the owning thread; `work` runs
// on any.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/base/thread_annotations.h"
#include "ridgeline/build/thresholds.h"
#include "ridgeline/build/tile_maker.h"
#include "ridgeline/jobs/job_system.h"

namespace ridgeline::build {

// One unit of work: a block, or a node larger than one.
struct BlockSlot {
    std::int64_t block = 0;
    io::NodeId node;
    io::ReliefBounds bounds;  // of the node's children
    std::vector<std::int32_t> packed;
    TileBatch batch;
    std::unique_ptr<BlockCounts> counts;
    std::vector<io::NodeId> nodes_with_data;
    bool deferred = false;

    jobs::Counter counter;
    bool submitted = false;
};

// Working memory for jobs: as many as run at once, made when first needed.
class MakerPool {
  public:
    std::unique_ptr<TileMaker> take();
    void give_back(std::unique_ptr<TileMaker> maker);

  private:
    Mutex mutex_;
    std::vector<std::unique_ptr<TileMaker>> free_ RIDGELINE_GUARDED_BY(mutex_);
};

class BlockPipeline {
  public:
    using Work = std::function<void(TileMaker& maker, BlockSlot& slot)>;
    using Take = std::function<Result<void>(BlockSlot& slot)>;

    BlockPipeline(jobs::JobSystem& jobs, MakerPool& makers, std::vector<std::unique_ptr<BlockSlot>>& slots,
                  Work work, Take take);
    // Waits for what still runs; results not taken are dropped.
    ~BlockPipeline();

    // The next slot, free: its former result has been taken.
    Result<BlockSlot*> next();
    // Runs `work` on the slot that next() returned last.
    void submit();
    // Takes all results.
    Result<void> drain();

  private:
    Result<void> take(BlockSlot& slot);

    jobs::JobSystem& jobs_;
    MakerPool& makers_;
    std::vector<std::unique_ptr<BlockSlot>>& slots_;
    Work work_;
    Take take_;
    std::size_t current_ = 0;
};

}  // namespace ridgeline::build
