// Writes pictures to disk beside the walk: encoding a PNG takes longer than a frame.
//
// save() is called by the render thread and never waits; the pictures are written in order by a thread of
// their own, which ends with the object, after everything was written. The first failure is kept.
#pragma once

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
    PictureWriter();
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

    jobs::Queue<Picture> pictures_;
    jobs::Queue<Picture>::Sender sender_;
    Mutex mutex_;
    std::optional<Error> failure_ RIDGELINE_GUARDED_BY(mutex_);
    std::thread thread_;
};

}  // namespace ridgeline::app
