// A counter behind a lock, which clang's thread-safety analysis must take; and with BREAK_THE_LOCK one that
// forgets it, which the analysis must refuse. Compiled by a test, never linked.
#include "ridgeline/base/thread_annotations.h"

namespace ridgeline {

class GuardedCounter {
  public:
    void add() {
#ifndef BREAK_THE_LOCK
        const MutexLock lock(mutex_);
#endif
        ++count_;
    }

  private:
    Mutex mutex_;
    int count_ RIDGELINE_GUARDED_BY(mutex_) = 0;
};

void use(GuardedCounter& counter) { counter.add(); }

}  // namespace ridgeline
