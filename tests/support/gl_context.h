// A headless GL 4.5 debug context for tests, loaded and set to the program's conventions; none where the
// machine has no EGL, which prints that the test was skipped. Fails the test when GL reports an error during
// it.
#pragma once

#include <doctest/doctest.h>

#include <memory>

#include "ridgeline/gl/capabilities.h"
#include "ridgeline/gl/debug_output.h"
#include "ridgeline/gl/framebuffer.h"
#include "ridgeline/platform/context.h"

namespace ridgeline::test {

class GlContext {
  public:
    GlContext() {
        auto opened = platform::open_headless({.size_px = {64, 64}, .debug = platform::ContextDebug::on});
        if (!opened) {
            MESSAGE("skipped: ", opened.error().message);
            return;
        }
        context_ = std::move(*opened);
        REQUIRE(gl::load(context_->gl_loader()));
        gl::enable_debug_output();
        gl::set_frame_conventions();
        errors_before_ = gl::debug_error_count();
    }
    ~GlContext() {
        if (context_) CHECK(gl::debug_error_count() == errors_before_ + expected_errors_);
    }
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    explicit operator bool() const { return context_ != nullptr; }
    platform::Context& context() { return *context_; }
    std::uint64_t errors_before() const { return errors_before_; }
    // For tests that provoke errors.
    void expect_errors(std::uint64_t count) { expected_errors_ += count; }

  private:
    std::unique_ptr<platform::Context> context_;
    std::uint64_t errors_before_ = 0;
    std::uint64_t expected_errors_ = 0;
};

}  // namespace ridgeline::test
