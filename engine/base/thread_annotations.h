// clang's thread-safety attributes: a field says which mutex guards it, and the compiler checks it.
#pragma once

#include <mutex>

#if defined(__clang__)
#define RIDGELINE_THREAD_ATTRIBUTE(x) __attribute__((x))
#else
#define RIDGELINE_THREAD_ATTRIBUTE(x)
#endif

#define RIDGELINE_GUARDED_BY(mutex) RIDGELINE_THREAD_ATTRIBUTE(guarded_by(mutex))
#define RIDGELINE_REQUIRES(mutex) RIDGELINE_THREAD_ATTRIBUTE(requires_capability(mutex))
#define RIDGELINE_EXCLUDES(mutex) RIDGELINE_THREAD_ATTRIBUTE(locks_excluded(mutex))

namespace ridgeline {

// std::mutex with the attributes that libstdc++ lacks.
class RIDGELINE_THREAD_ATTRIBUTE(capability("mutex")) Mutex {
  public:
    void lock() RIDGELINE_THREAD_ATTRIBUTE(acquire_capability()) { mutex_.lock(); }
    void unlock() RIDGELINE_THREAD_ATTRIBUTE(release_capability()) { mutex_.unlock(); }
    // For condition variables only.
    std::mutex& native() { return mutex_; }

  private:
    std::mutex mutex_;
};

class RIDGELINE_THREAD_ATTRIBUTE(scoped_lockable) MutexLock {
  public:
    explicit MutexLock(Mutex& mutex) RIDGELINE_THREAD_ATTRIBUTE(acquire_capability(mutex)) : mutex_(mutex) {
        mutex_.lock();
    }
    ~MutexLock() RIDGELINE_THREAD_ATTRIBUTE(release_capability()) { mutex_.unlock(); }
    MutexLock(const MutexLock&) = delete;
    MutexLock& operator=(const MutexLock&) = delete;

  private:
    Mutex& mutex_;
};

}  // namespace ridgeline
