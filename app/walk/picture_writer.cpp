#include "ridgeline/app/walk/picture_writer.h"

#include <chrono>
#include <utility>

#include "ridgeline/base/thread_role.h"

namespace ridgeline::app {

PictureWriter::PictureWriter() : sender_(pictures_.sender()), thread_([this] { run(); }) {}

PictureWriter::~PictureWriter() { static_cast<void>(finish()); }

void PictureWriter::save(std::filesystem::path file, gl::Image image) {
    sender_.send({std::move(file), std::move(image)});
}

Result<void> PictureWriter::finish() {
    if (thread_.joinable()) {
        sender_.send({});
        thread_.join();
    }
    const MutexLock lock(mutex_);
    if (failure_) return *failure_;
    return {};
}

void PictureWriter::run() {
    set_thread_role(ThreadRole::unnamed, "pictures");
    auto receiver = pictures_.receiver();
    Picture picture;
    while (true) {
        if (!receiver.receive_for(picture, std::chrono::seconds(1))) continue;
        if (picture.file.empty()) return;
        if (auto written = gl::write_png(picture.file, picture.image); !written) {
            const MutexLock lock(mutex_);
            if (!failure_) failure_ = written.error();
        }
    }
}

}  // namespace ridgeline::app
