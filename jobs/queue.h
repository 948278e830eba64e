// A queue of move-only messages from any number of sending threads to one receiving thread.
//
// Messages of one sender arrive in its order; between senders there is none. Lock-free but for the receiver's
// sleep. Preallocated: allocates only when a thread sends for the first time or more messages than `capacity`
// are under way. Ends are views named by role, so that a class that holds one says in its fields which side
// it is on; the queue must outlive them. A message belongs to the queue from send() on, to the receiver from
// receive() on.
#pragma once

#include <concurrentqueue/concurrentqueue.h>
#include <concurrentqueue/lightweightsemaphore.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "ridgeline/base/contract.h"
#include "ridgeline/jobs/queue_traits.h"

namespace ridgeline::jobs {

template <class T>
class Queue {
  public:
    // Any thread.
    class Sender {
      public:
        void send(T message) { queue_->send(std::move(message)); }
        // Makes the receiver's current or next sleep end at once, with no message.
        void wake() { queue_->wake(); }

      private:
        friend class Queue;
        explicit Sender(Queue* queue) : queue_(queue) {}
        Queue* queue_;
    };

    // One thread at a time.
    class Receiver {
      public:
        // Takes a message if there is one.
        bool receive(T& message) { return queue_->messages_.try_dequeue(message); }
        // Sleeps until a message, a wake() or the time-out comes; true with a message.
        bool receive_for(T& message, std::chrono::microseconds timeout) {
            return queue_->receive_for(message, timeout);
        }

      private:
        friend class Queue;
        explicit Receiver(Queue* queue) : queue_(queue) {}
        Queue* queue_;
    };

    explicit Queue(std::size_t capacity = 1024) : messages_(capacity) {}
    Queue(const Queue&) = delete;
    Queue& operator=(const Queue&) = delete;

    Sender sender() { return Sender(this); }
    Receiver receiver() { return Receiver(this); }
    // Messages under way; exact while nobody sends or receives.
    std::size_t size_approx() const { return messages_.size_approx(); }

  private:
    // What the receiver is doing. Sender and receiver both exchange it after having touched the queue, so one
    // of them always sees the other: a message is found before the sleep, or the sleep is ended.
    enum State : std::uint8_t { kAwake, kAsleep, kWoken };

    void send(T&& message) {
        const bool queued = messages_.enqueue(std::move(message));
        RIDGELINE_CHECK(queued);
        end_sleep(kAwake);
    }
    void wake() { end_sleep(kWoken); }

    void end_sleep(State next) {
        auto state = state_.load(std::memory_order_relaxed);
        // A wake() that the receiver has not seen yet must survive a send().
        while (!state_.compare_exchange_weak(state, state == kWoken ? kWoken : next,
                                             std::memory_order_acq_rel)) {
        }
        if (state == kAsleep) sleep_.signal();
    }

    bool receive_for(T& message, std::chrono::microseconds timeout) {
        if (messages_.try_dequeue(message)) return true;
        if (fall_asleep()) {
            const bool signalled = !seems_empty() ? false : sleep_.wait(timeout.count());
            // Whoever ended the sleep in the meantime has signalled or will: the signal must not outlive this
            // call.
            if (!signalled && !rise()) sleep_.wait();
        }
        forget_wake();
        return messages_.try_dequeue(message);
    }
    bool seems_empty() const { return messages_.size_approx() == 0; }
    bool fall_asleep() { return exchange_if(kAwake, kAsleep); }
    bool rise() { return exchange_if(kAsleep, kAwake); }
    void forget_wake() { exchange_if(kWoken, kAwake); }
    bool exchange_if(State from, State to) {
        return state_.compare_exchange_strong(from, to, std::memory_order_acq_rel, std::memory_order_acquire);
    }

    moodycamel::ConcurrentQueue<T, QueueTraits> messages_;
    // Without the semaphore's default spin: who waits here waits long.
    moodycamel::LightweightSemaphore sleep_{0, 0};
    std::atomic<State> state_{kAwake};
};

}  // namespace ridgeline::jobs
