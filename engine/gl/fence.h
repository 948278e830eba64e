// A point in the GPU's work that the CPU can ask about. Move-only; render thread only.
#pragma once

#include <glad/gl.h>

#include <chrono>
#include <utility>

namespace ridgeline::gl {

class Fence {
  public:
    Fence() = default;
    // After all commands given so far.
    static Fence insert();
    Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
    Fence& operator=(Fence&& other) noexcept {
        std::swap(sync_, other.sync_);
        return *this;
    }
    ~Fence();

    bool empty() const { return sync_ == nullptr; }
    // Never waits. An empty fence has passed.
    bool passed() const;
    // For shutdown, tests and tools; false when the time ran out.
    bool wait(std::chrono::nanoseconds limit) const;

  private:
    explicit Fence(GLsync sync) : sync_(sync) {}
    GLsync sync_ = nullptr;
};

}  // namespace ridgeline::gl
