#include "ridgeline/app/build/gpu_encoder.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <future>
#include <numeric>
#include <thread>
#include <vector>

#include "ridgeline/base/thread_annotations.h"
#include "ridgeline/base/thread_role.h"
#include "ridgeline/base/units.h"
#include "ridgeline/gl/capabilities.h"
#include "ridgeline/jobs/queue.h"
#include "ridgeline/platform/context.h"
#include "ridgeline/render/block_encoder.h"

namespace ridgeline::app {
namespace {

using build::BlockTexels;
using build::TexelSquare;
using shaders::Bc1Texels;
using namespace std::chrono_literals;

// Beyond those that threads work on: enough to keep a GPU busy while others are filled and packed.
constexpr int kSlotsAhead = 8;
constexpr std::size_t kMostSlots = 32;

// The driver's, which compiles the shader: llvmpipe's takes 130 MiB at its most (Mesa 22.3).
constexpr std::uint64_t kDriverBytes = 160_MiB;

// All slots at once are a few tenths of a second for a CPU's core.
constexpr auto kPatience = 60s;

static_assert(sizeof(BlockTexels) == sizeof(Bc1Texels));

// A slot whose texels are there, and where its blocks are to go. No slot: the end.
struct Request {
    std::vector<std::span<io::Bc1Block>> squares;
    build::ImageEncoder::Done done;
    std::size_t slot = 0;
    bool end = false;
};

class Encoder final : public GpuEncoder {
  public:
    Encoder() = default;
    ~Encoder() override {
        if (!thread_.joinable()) return;
        Request last;
        last.end = true;
        requests_.sender().send(std::move(last));
        thread_.join();
    }
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;

    Result<void> start() {
        std::promise<Result<void>> opened;
        auto answer = opened.get_future();
        thread_ = std::thread([this, &opened] { run_on_render_thread(opened); });
        return answer.get();
    }

    void encode(std::span<const TexelSquare> squares, Done done) override;
    int tiles_under_way(int threads) const override {
        return std::min(threads + kSlotsAhead, static_cast<int>(kMostSlots));
    }
    std::uint64_t memory_bytes() const override {
        return kDriverBytes +
               kMostSlots * io::kImageryBlockCount * (sizeof(Bc1Texels) + sizeof(io::Bc1Block));
    }
    const std::string& renderer() const override { return renderer_; }

  private:
    std::size_t take_slot() {
        const MutexLock lock(mutex_);
        RIDGELINE_CHECK(!free_.empty());
        const std::size_t slot = free_.back();
        free_.pop_back();
        return slot;
    }
    void give_slot_back(std::size_t slot) {
        const MutexLock lock(mutex_);
        free_.push_back(slot);
    }

    void run_on_render_thread(std::promise<Result<void>>& opened);
    Result<void> open_on_render_thread();
    void serve_on_render_thread();
    // False at the end.
    bool take_batch_on_render_thread();
    void encode_batch_on_render_thread();

    std::thread thread_;
    jobs::Queue<Request> requests_;
    std::string renderer_;
    Mutex mutex_;
    std::vector<std::size_t> free_ RIDGELINE_GUARDED_BY(mutex_);

    // The render thread's, but for slots' memory.
    std::unique_ptr<platform::Context> context_;
    render::BlockEncoder blocks_;
    std::vector<Request> batch_;
    Result<void> health_;
};

void Encoder::encode(std::span<const TexelSquare> squares, Done done) {
    Request request;
    request.slot = take_slot();
    const auto texels = blocks_.texels(request.slot);
    std::size_t block = 0;
    for (const TexelSquare& square : squares) {
        RIDGELINE_CHECK(block + square.blocks.size() <= texels.size());
        for_each_block(square, [&](const BlockTexels& from, const io::Bc1Block&) {
            std::memcpy(&texels[block++], from.data(), sizeof from);
        });
        request.squares.push_back(square.blocks);
    }
    request.done = std::move(done);
    requests_.sender().send(std::move(request));
}

void Encoder::run_on_render_thread(std::promise<Result<void>>& opened) {
    set_thread_role(ThreadRole::render, "render");
    const auto result = open_on_render_thread();
    // Whoever waits for it may be gone once it is set.
    opened.set_value(result);
    if (result) serve_on_render_thread();
    blocks_ = {};
    context_ = nullptr;
}

Result<void> Encoder::open_on_render_thread() {
    auto context = platform::open_headless({});
    if (!context) return context.error();
    context_ = std::move(*context);
    RIDGELINE_TRY(gl::load(context_->gl_loader()));
    renderer_ = gl::query_capabilities().renderer;
    auto blocks = render::BlockEncoder::create(kMostSlots, io::kImageryBlockCount);
    if (!blocks) return blocks.error();
    blocks_ = std::move(*blocks);
    const MutexLock lock(mutex_);
    free_.resize(kMostSlots);
    std::iota(free_.begin(), free_.end(), std::size_t{0});
    return {};
}

void Encoder::serve_on_render_thread() {
    while (take_batch_on_render_thread()) encode_batch_on_render_thread();
}

bool Encoder::take_batch_on_render_thread() {
    batch_.clear();
    Request request;
    auto receiver = requests_.receiver();
    while (!receiver.receive_for(request, 1s)) {
    }
    do {
        // Nobody asks for more after it.
        if (request.end) return false;
        batch_.push_back(std::move(request));
    } while (receiver.receive(request));
    return true;
}

void Encoder::encode_batch_on_render_thread() {
    for (const Request& request : batch_) {
        std::size_t count = 0;
        for (const auto& square : request.squares) count += square.size();
        if (health_) blocks_.start(request.slot, count);
    }
    if (health_) health_ = blocks_.finish(kPatience);
    for (Request& request : batch_) {
        auto from = blocks_.blocks(request.slot);
        for (const auto& square : request.squares) {
            std::ranges::copy(from.first(square.size()), square.begin());
            from = from.subspan(square.size());
        }
        give_slot_back(request.slot);
        request.done(health_);
    }
}

}  // namespace

Result<std::unique_ptr<GpuEncoder>> GpuEncoder::open() {
    auto encoder = std::make_unique<Encoder>();
    RIDGELINE_TRY(encoder->start());
    return std::unique_ptr<GpuEncoder>(std::move(encoder));
}

}  // namespace ridgeline::app
