// A job: a callable of bounded size, stored inline, run once.
//
// Move-only, so that captures may be; never allocates, so that submitting costs no heap. A job belongs to
// whoever holds it: the submitter until submit(), the queue, then the thread that runs it, which also
// destroys the captures. Jobs must not throw, and must not block on I/O or GL.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace ridgeline::jobs {

class Counter;

class Job {
  public:
    // Room for eight references; a larger capture belongs behind a pointer.
    static constexpr std::size_t kCapacityBytes = 64;

    Job() = default;

    template <class F>
    requires(!std::is_same_v<std::remove_cvref_t<F>, Job> &&
             std::is_invocable_v<std::decay_t<F>&>) explicit Job(F&& callable)
        : operations_(&kOperations<std::decay_t<F>>) {
        using Callable = std::decay_t<F>;
        static_assert(sizeof(Callable) <= kCapacityBytes, "capture less, or a pointer to it");
        static_assert(alignof(Callable) <= alignof(std::max_align_t));
        static_assert(std::is_nothrow_move_constructible_v<Callable>);
        ::new (static_cast<void*>(storage_)) Callable(std::forward<F>(callable));
    }

    Job(Job&& other) noexcept { take(other); }
    Job& operator=(Job&& other) noexcept {
        if (this == &other) return *this;
        discard();
        take(other);
        return *this;
    }
    ~Job() { discard(); }

    explicit operator bool() const { return operations_ != nullptr; }

    // Runs the callable and destroys its captures; the job is empty afterwards.
    void run() { std::exchange(operations_, nullptr)->run_and_destroy(storage_); }

    // The counter that this job lowers when it is done, or null. Set by the job system.
    Counter* counter = nullptr;

  private:
    struct Operations {
        void (*run_and_destroy)(void* callable);
        // Null where a copy of the bytes will do.
        void (*relocate)(void* from, void* to);
        // Null where there is nothing to do.
        void (*destroy)(void* callable);
    };

    template <class Callable>
    static void run_and_destroy(void* storage) {
        auto* callable = static_cast<Callable*>(storage);
        (*callable)();
        std::destroy_at(callable);
    }
    template <class Callable>
    static void relocate(void* from, void* to) {
        ::new (to) Callable(std::move(*static_cast<Callable*>(from)));
        std::destroy_at(static_cast<Callable*>(from));
    }
    template <class Callable>
    static void destroy(void* storage) {
        std::destroy_at(static_cast<Callable*>(storage));
    }
    template <class Callable>
    static constexpr Operations kOperations = {
        &run_and_destroy<Callable>, std::is_trivially_copyable_v<Callable> ? nullptr : &relocate<Callable>,
        std::is_trivially_destructible_v<Callable> ? nullptr : &destroy<Callable>};

    void take(Job& other) {
        counter = other.counter;
        operations_ = std::exchange(other.operations_, nullptr);
        if (!operations_) return;
        if (operations_->relocate)
            operations_->relocate(other.storage_, storage_);
        else
            std::memcpy(storage_, other.storage_, kCapacityBytes);
    }
    void discard() {
        if (operations_ && operations_->destroy) operations_->destroy(storage_);
        operations_ = nullptr;
    }

    const Operations* operations_ = nullptr;
    alignas(std::max_align_t) std::byte storage_[kCapacityBytes];
};

}  // namespace ridgeline::jobs
