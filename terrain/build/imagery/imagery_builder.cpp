// The tower paper's pyramid of image tiles with our own order of work: each texel is read once, each mean taken
// once, and serves both as mip 1 of its tile and as content of the level above.
#include "ridgeline/build/imagery/imagery_builder.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <vector>

#include "ridgeline/base/thread_annotations.h"
#include "ridgeline/build/imagery/imagery_levels.h"
#include "ridgeline/build/imagery/linear_light.h"

namespace ridgeline::build {
namespace {

using io::kImageryBlocks;
using io::kImageryGutter;
using io::kImageryMipTexels;
using io::kImageryTexels;
using io::kImageryTile;

template <class T>
std::vector<T> square(int side) {
    return std::vector<T>(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
}

// One tile on its way; no payload: the node has no imagery.
struct TileResult {
    io::NodeId node;
    std::vector<std::uint8_t> payload;
    io::Holes holes = io::Holes::none;
};

// One tile at a time on its way from texels to payload, and the memory for it.
struct Lane {
    std::vector<Texel> texels = square<Texel>(kImageryTexels);
    std::vector<Texel> means = square<Texel>(kImageryMipTexels);
    std::vector<io::Bc1Block> blocks = std::vector<io::Bc1Block>(io::kImageryBlockCount);
    io::ImageryScratch scratch;
    std::size_t result = 0;  // the tile's
};

bool has_imagery(const Texel& texel) { return texel.alpha != 0; }

// Of the node itself, without the gutter.
bool has_content(std::span<const Texel> texels) {
    for (std::size_t row = kImageryGutter; row < kImageryGutter + kImageryTile; ++row) {
        const auto content = texels.subspan(row * kImageryTexels + kImageryGutter, kImageryTile);
        if (std::any_of(content.begin(), content.end(), has_imagery)) return true;
    }
    return false;
}

// The tiles of the rows of nodes that are ready, each on one of a fixed number of lanes:
//
//   next tile ──► work_on: texels, means ──► encoder ──► pack: payload ──► work_on the lane's next tile
//                 a job                      anywhere     a job
class TileBuild {
  public:
    explicit TileBuild(const ImageryWork& work, io::ImageryWriter& writer)
        : work_(work), writer_(writer), levels_(work.rows.info().width, work.rows.info().height) {
        const int lanes = work_.encoder.tiles_under_way(work_.jobs.worker_count() + 1);
        for (int i = 0; i < lanes; ++i) lanes_.push_back(std::make_unique<Lane>());
    }

    Result<void> run() {
        RIDGELINE_TRY(read());
        while (!levels_.complete()) {
            const auto rows = levels_.next();
            start(rows);
            const auto read_on = read();
            const auto encoded = wait();
            RIDGELINE_TRY(read_on);
            RIDGELINE_TRY(encoded);
            levels_.done(rows);
            RIDGELINE_TRY(take());
        }
        return finish();
    }

  private:
    // What the next row of nodes needs into the finest level.
    Result<void> read();
    void start(const std::vector<NodeRow>& rows);
    void work_on(Lane& lane);
    bool make_texels(Lane& lane);
    void encode(Lane& lane);
    void encoded(Lane& lane, const Result<void>& result);
    void pack(Lane& lane);
    void submit(void (TileBuild::*step)(Lane&), Lane& lane) {
        work_.jobs.submit([this, step, &lane] { (this->*step)(lane); }, &running_);
    }
    Result<void> wait();
    Result<void> take();
    Result<void> finish() const;

    const ImageryWork& work_;
    io::ImageryWriter& writer_;
    ImageryLevels levels_;
    std::vector<std::unique_ptr<Lane>> lanes_;
    std::vector<TileResult> results_;
    std::size_t started_ = 0;  // the first of them
    std::atomic<std::size_t> next_{0};
    jobs::Counter running_;
    std::int64_t rows_read_ = 0;
    bool any_imagery_ = false;

    Mutex mutex_;
    std::condition_variable_any changed_;
    std::size_t lanes_busy_ RIDGELINE_GUARDED_BY(mutex_) = 0;
    Result<void> failure_ RIDGELINE_GUARDED_BY(mutex_);  // the first
};

Result<void> TileBuild::read() {
    const io::ImageryInfo& info = work_.rows.info();
    std::int64_t due = levels_.finest_rows_to_fill();
    if (due == 0) return {};
    while (due > 0) {
        const auto texels = levels_.finest_to_fill(due);
        const auto rows = static_cast<std::int64_t>(texels.size()) / info.width;
        RIDGELINE_TRY(work_.rows.read(rows_read_, rows, texels));
        levels_.filled(rows);
        rows_read_ += rows;
        due -= rows;
    }
    return work_.progress ? work_.progress(rows_read_, info.height) : Result<void>();
}

void TileBuild::start(const std::vector<NodeRow>& rows) {
    std::size_t count = 0;
    for (const NodeRow& row : rows) count += static_cast<std::size_t>(levels_.grid().nodes_x(row.level));
    // Never fewer, so that their memory stays.
    if (results_.size() < count) results_.resize(count);
    started_ = count;
    std::size_t i = 0;
    for (const NodeRow& row : rows)
        for (std::int32_t x = 0; x < levels_.grid().nodes_x(row.level); ++x)
            results_[i++].node = {row.level, x, row.y};
    next_ = 0;
    const std::size_t lanes = std::min(count, lanes_.size());
    {
        const MutexLock lock(mutex_);
        lanes_busy_ = lanes;
    }
    for (std::size_t lane = 0; lane < lanes; ++lane) submit(&TileBuild::work_on, *lanes_[lane]);
}

// On with the next tile that has imagery; the lane ends where there is none.
void TileBuild::work_on(Lane& lane) {
    while ((lane.result = next_.fetch_add(1, std::memory_order_relaxed)) < started_)
        if (make_texels(lane)) return encode(lane);
    const MutexLock lock(mutex_);
    --lanes_busy_;
    changed_.notify_one();
}

bool TileBuild::make_texels(Lane& lane) {
    TileResult& result = results_[lane.result];
    levels_.cut(result.node, lane.texels);
    halve(lane.texels, kImageryTexels, lane.means);
    levels_.give(result.node, lane.means);
    result.payload.clear();
    return has_content(lane.texels);
}

void TileBuild::encode(Lane& lane) {
    constexpr std::size_t kMip0 = std::size_t{kImageryBlocks} * kImageryBlocks;
    const std::span blocks(lane.blocks);
    const std::array squares = {
        TexelSquare{lane.texels, kImageryTexels, blocks.first(kMip0)},
        TexelSquare{lane.means, kImageryMipTexels, blocks.subspan(kMip0)},
    };
    work_.encoder.encode(squares, [this, &lane](const Result<void>& result) { encoded(lane, result); });
}

void TileBuild::encoded(Lane& lane, const Result<void>& result) {
    // Until the end: the lane cannot end meanwhile, nor all this go.
    const MutexLock lock(mutex_);
    if (!result) {
        // No further tile of any lane; this one is packed as it is, for nobody.
        next_.store(started_, std::memory_order_relaxed);
        if (failure_) failure_ = result;
    }
    submit(&TileBuild::pack, lane);
    changed_.notify_one();
}

void TileBuild::pack(Lane& lane) {
    TileResult& result = results_[lane.result];
    result.holes = std::ranges::any_of(lane.blocks, io::has_holes) ? io::Holes::some : io::Holes::none;
    io::encode_imagery(lane.blocks, lane.scratch, result.payload);
    work_on(lane);
}

// Works with the others, and sleeps where all that is left lies with the encoder.
Result<void> TileBuild::wait() {
    for (bool busy = true; busy;) {
        work_.jobs.wait(running_);
        const MutexLock lock(mutex_);
        while (lanes_busy_ != 0 && running_.done()) changed_.wait(mutex_);
        busy = lanes_busy_ != 0;
    }
    work_.jobs.wait(running_);
    const MutexLock lock(mutex_);
    return failure_;
}

Result<void> TileBuild::take() {
    for (const TileResult& result : std::span(results_).first(started_)) {
        if (result.payload.empty()) continue;
        any_imagery_ = true;
        RIDGELINE_TRY(writer_.put(result.node, result.payload, result.holes));
    }
    return {};
}

Result<void> TileBuild::finish() const {
    if (any_imagery_) return {};
    const auto& sources = work_.rows.info().sources;
    return Error{(sources.empty() ? std::string("imagery") : sources.front()) +
                 ": no imagery at all within the terrain"};
}

}  // namespace

std::uint64_t imagery_memory_bytes(const io::ImageryInfo& info, int threads, const ImageEncoder& encoder) {
    // The program with its libraries; what a thread works in, GDAL's warper included.
    constexpr std::uint64_t kProgram = 40u << 20, kWork = 16u << 20;
    // A tile under way.
    constexpr std::uint64_t kLane = 1u << 20;
    // The record, and its place on the curve as it is sorted.
    constexpr std::uint64_t kNode = sizeof(io::ImageryRecord) + 2 * 24 + 2 * 12;
    // The finest row of tiles and those that come with it, packed; a band of rows of a mosaic's part.
    const auto tiles = static_cast<std::uint64_t>(2 * (info.width / kImageryTile + 1));
    const auto band = static_cast<std::uint64_t>(info.width) * kImageryTile * sizeof(Texel);
    return kProgram + ImageryLevels::memory_bytes(info.width) + tiles * io::kImageryTileBytes + band +
           static_cast<std::uint64_t>(info.grid().node_count()) * kNode +
           static_cast<std::uint64_t>(threads) * kWork +
           static_cast<std::uint64_t>(encoder.tiles_under_way(threads) - threads) * kLane +
           encoder.memory_bytes();
}

Result<void> build_tiles(const ImageryWork& work, io::ImageryWriter& writer) {
    return TileBuild(work, writer).run();
}

}  // namespace ridgeline::build
