#include "ridgeline/app/walk/picture_writer.h"

#include <chrono>
#include <new>
#include <utility>

#include "ridgeline/base/thread_role.h"

namespace ridgeline::app {
namespace {

constexpr int kMostWaiting = 8;

}  // namespace

PictureWriter::~PictureWriter() { static_cast<void>(finish()); }

void PictureWriter::save(std::filesystem::path file, gl::Image image) {
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
    for (int waiting = waiting_.load(); waiting >= kMostWaiting; waiting = waiting_.load())
        waiting_.wait(waiting);
    waiting_.fetch_add(1);
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
        write(picture);
        waiting_.fetch_sub(1);
        waiting_.notify_one();
    }
}

void PictureWriter::write(const Picture& picture) {
    Result<void> written;
    try {
        written = gl::write_png(picture.file, picture.image);
    } catch (const std::bad_alloc&) {
        written = Error{picture.file.string() + ": no memory to encode it"};
    }
    if (written) return;
    const MutexLock lock(mutex_);
    if (!failure_) failure_ = written.error();
}

}  // namespace ridgeline::app
