// The tower paper's pyramid of image tiles with our own order of work: each texel is read once, each mean
// taken once, and serves both as mip 1 of its tile and as content of the level above.
#include "ridgeline/build/imagery/imagery_builder.h"

#include <algorithm>
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

// Working memory of one job.
struct TileWork {
    std::vector<Texel> texels = square<Texel>(kImageryTexels);
    std::vector<Texel> means = square<Texel>(kImageryMipTexels);
    std::vector<io::Bc1Block> blocks = std::vector<io::Bc1Block>(io::kImageryBlockCount);
    io::ImageryScratch scratch;
};

// As many as run at once, made when first needed.
class WorkPool {
  public:
    std::unique_ptr<TileWork> take() {
        const MutexLock lock(mutex_);
        if (free_.empty()) return std::make_unique<TileWork>();
        auto work = std::move(free_.back());
        free_.pop_back();
        return work;
    }
    void give_back(std::unique_ptr<TileWork> work) {
        const MutexLock lock(mutex_);
        free_.push_back(std::move(work));
    }

  private:
    Mutex mutex_;
    std::vector<std::unique_ptr<TileWork>> free_ RIDGELINE_GUARDED_BY(mutex_);
};

// One tile on its way; no payload: the node has no imagery.
struct TileResult {
    io::NodeId node;
    std::vector<std::uint8_t> payload;
    io::Holes holes = io::Holes::none;
    Result<void> encoded;
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

class TileBuild {
  public:
    explicit TileBuild(const ImageryWork& work, io::ImageryWriter& writer)
        : work_(work), writer_(writer), levels_(work.rows.info().width, work.rows.info().height) {}

    Result<void> run() {
        RIDGELINE_TRY(read());
        while (!levels_.complete()) {
            const auto rows = levels_.next();
            start(rows);
            const auto read_on = read();
            work_.jobs.wait(running_);
            RIDGELINE_TRY(read_on);
            levels_.done(rows);
            RIDGELINE_TRY(take());
        }
        return finish();
    }

  private:
    // What the next row of nodes needs into the finest level.
    Result<void> read();
    void start(const std::vector<NodeRow>& rows);
    void make(TileWork& work, TileResult& result);
    Result<void> encode(TileWork& work);
    Result<void> take();
    Result<void> finish() const;

    const ImageryWork& work_;
    io::ImageryWriter& writer_;
    ImageryLevels levels_;
    WorkPool pool_;
    std::vector<TileResult> results_;
    std::size_t started_ = 0;  // the first of them
    jobs::Counter running_;
    std::int64_t rows_read_ = 0;
    bool any_imagery_ = false;
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
        for (std::int32_t x = 0; x < levels_.grid().nodes_x(row.level); ++x) {
            TileResult& result = results_[i++];
            result.node = {row.level, x, row.y};
            work_.jobs.submit(
                [this, &result] {
                    auto work = pool_.take();
                    make(*work, result);
                    pool_.give_back(std::move(work));
                },
                &running_);
        }
}

void TileBuild::make(TileWork& work, TileResult& result) {
    levels_.cut(result.node, work.texels);
    halve(work.texels, kImageryTexels, work.means);
    levels_.give(result.node, work.means);
    result.payload.clear();
    if (!has_content(work.texels)) return;
    result.encoded = encode(work);
    if (!result.encoded) return;
    const std::span blocks(work.blocks);
    result.holes =
        std::any_of(blocks.begin(), blocks.end(), io::has_holes) ? io::Holes::some : io::Holes::none;
    io::encode_imagery(blocks, work.scratch, result.payload);
}

Result<void> TileBuild::encode(TileWork& work) {
    constexpr std::size_t kMip0 = std::size_t{kImageryBlocks} * kImageryBlocks;
    const std::span blocks(work.blocks);
    RIDGELINE_TRY(work_.encoder.encode(work.texels, kImageryTexels, blocks.first(kMip0)));
    return work_.encoder.encode(work.means, kImageryMipTexels, blocks.subspan(kMip0));
}

Result<void> TileBuild::take() {
    for (const TileResult& result : std::span(results_).first(started_)) {
        RIDGELINE_TRY(result.encoded);
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

std::uint64_t imagery_memory_bytes(const io::ImageryInfo& info, int threads) {
    // The program with its libraries; what a thread works in, GDAL's warper included.
    constexpr std::uint64_t kProgram = 40u << 20, kWork = 16u << 20;
    // The record, and its place on the curve as it is sorted.
    constexpr std::uint64_t kNode = sizeof(io::ImageryRecord) + 2 * 24 + 2 * 12;
    // The finest row of tiles and those that come with it, packed; a band of rows of a mosaic's part.
    const auto tiles = static_cast<std::uint64_t>(2 * (info.width / kImageryTile + 1));
    const auto band = static_cast<std::uint64_t>(info.width) * kImageryTile * sizeof(Texel);
    return kProgram + ImageryLevels::memory_bytes(info.width) + tiles * io::kImageryTileBytes + band +
           static_cast<std::uint64_t>(info.grid().node_count()) * kNode +
           static_cast<std::uint64_t>(threads) * kWork;
}

Result<void> build_tiles(const ImageryWork& work, io::ImageryWriter& writer) {
    return TileBuild(work, writer).run();
}

}  // namespace ridgeline::build
