// Writes pictures to disk beside the walk: encoding a PNG takes longer than a frame.
//
// save() is called by the render thread; the pictures are written in order by a thread of their own, which
// starts with the first of them and ends with the object, after everything was written. A few may wait to be
// written, then save() waits: memory is bounded. The first failure is kept.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <thread>

#include "ridgeline/base/result.h"
#include "ridgeline/base/thread_annotations.h"
#include "ridgeline/gl/screenshot.h"
#include "ridgeline/jobs/queue.h"

namespace ridgeline::app {

class PictureWriter {
  public:
    PictureWriter() : sender_(pictures_.sender()) {}
    ~PictureWriter();
    PictureWriter(const PictureWriter&) = delete;
    PictureWriter& operator=(const PictureWriter&) = delete;

    void save(std::filesystem::path file, gl::Image image);
    // Waits until all is written. The first failure since the start.
    Result<void> finish() RIDGELINE_EXCLUDES(mutex_);

  private:
    struct Picture {
        std::filesystem::path file;  // empty: the last message
        gl::Image image;
    };
    void run() RIDGELINE_EXCLUDES(mutex_);
    void write(const Picture& picture) RIDGELINE_EXCLUDES(mutex_);

    jobs::Queue<Picture> pictures_;
    jobs::Queue<Picture>::Sender sender_;
    std::atomic<int> waiting_{0};
    Mutex mutex_;
    std::optional<Error> failure_ RIDGELINE_GUARDED_BY(mutex_);
    std::thread thread_;
};

}  // namespace ridgeline::app
