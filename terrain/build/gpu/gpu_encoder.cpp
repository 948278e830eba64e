#include "ridgeline/gpu_encoder/gpu_encoder.h"

#include <glad/gl.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "ridgeline/base/contract.h"
#include "ridgeline/base/thread_role.h"
#include "ridgeline/gl/capabilities.h"
#include "ridgeline/platform/context.h"

namespace ridgeline::build {
namespace {

// Tiles at once; more would only wait for each other.
constexpr std::size_t kMostTiles = 8;
constexpr std::size_t kMostBlocks = kMostTiles * io::kImageryBlocks * io::kImageryBlocks;

static_assert(sizeof(shaders::Bc1Texels) == 16 * sizeof(Texel));

// Squares of four by four, row by row.
void arrange(std::span<const Texel> texels, int side, std::span<shaders::Bc1Texels> blocks) {
    const auto stride = static_cast<std::size_t>(side), across = stride / 4;
    for (std::size_t row = 0; row < stride; ++row)
        for (std::size_t column = 0; column < across; ++column)
            std::memcpy(&blocks[row / 4 * across + column].rows[row % 4], &texels[row * stride + column * 4],
                        4 * sizeof(Texel));
}

}  // namespace

Result<std::unique_ptr<GpuEncoder>> GpuEncoder::create() {
    std::unique_ptr<GpuEncoder> made(new GpuEncoder);
    made->thread_ = std::thread([encoder = made.get()] { encoder->run(); });
    Result<void> opened;
    {
        MutexLock lock(made->mutex_);
        while (!made->opened_) made->changed_.wait(made->mutex_);
        opened = *made->opened_;
    }
    RIDGELINE_TRY(opened);
    return made;
}

GpuEncoder::~GpuEncoder() {
    {
        const MutexLock lock(mutex_);
        ending_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

Result<void> GpuEncoder::encode(std::span<const Texel> texels, int side, std::span<io::Bc1Block> blocks) {
    const auto wide = static_cast<std::size_t>(side);
    RIDGELINE_CHECK(side % 4 == 0 && texels.size() == wide * wide && blocks.size() == wide * wide / 16 &&
                    blocks.size() <= kMostBlocks);
    Request request{texels, side, blocks, {}};
    MutexLock lock(mutex_);
    queue_.push_back(&request);
    changed_.notify_all();
    while (!request.done) changed_.wait(mutex_);
    return *request.done;
}

// --- the encoder's thread

void GpuEncoder::run() {
    set_thread_role(ThreadRole::render, "gpu encoder");
    std::unique_ptr<platform::Context> context;
    auto encoder = [&]() -> Result<BlockEncoder> {
        auto headless = platform::open_headless({});
        if (!headless) return headless.error();
        context = std::move(headless).value();
        RIDGELINE_TRY(gl::load(context->gl_loader()));
        renderer_ = gl::query_capabilities().renderer;
        return BlockEncoder::create(kMostBlocks);
    }();
    {
        const MutexLock lock(mutex_);
        opened_ = encoder ? Result<void>() : encoder.error();
    }
    changed_.notify_all();
    if (encoder) serve(*encoder);
}

// What waits, as much as fits; nothing at the end.
std::vector<GpuEncoder::Request*> GpuEncoder::take() {
    MutexLock lock(mutex_);
    while (queue_.empty() && !ending_) changed_.wait(mutex_);
    std::vector<Request*> taken;
    std::size_t blocks = 0;
    for (Request* request : queue_) {
        if (blocks + request->blocks.size() > kMostBlocks) break;
        blocks += request->blocks.size();
        taken.push_back(request);
    }
    queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(taken.size()));
    return taken;
}

Result<void> GpuEncoder::encode(BlockEncoder& encoder, std::span<Request* const> requests) {
    std::size_t count = 0;
    for (const Request* request : requests) {
        arrange(request->texels, request->side, encoder.texels().subspan(count, request->blocks.size()));
        count += request->blocks.size();
    }
    const auto encoded = encoder.encode(count);
    if (!encoded) return encoded.error();
    auto next = encoded->begin();
    for (Request* request : requests) {
        const auto end = next + static_cast<std::ptrdiff_t>(request->blocks.size());
        std::copy(next, end, request->blocks.begin());
        next = end;
    }
    return {};
}

void GpuEncoder::serve(BlockEncoder& encoder) {
    for (auto requests = take(); !requests.empty(); requests = take()) {
        const Result<void> done = encode(encoder, requests);
        {
            const MutexLock lock(mutex_);
            for (Request* request : requests) request->done = done;
        }
        changed_.notify_all();
    }
}

}  // namespace ridgeline::build
