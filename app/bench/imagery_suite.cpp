#include "ridgeline/app/bench/imagery_suite.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <semaphore>
#include <system_error>
#include <thread>

#include "ridgeline/app/bench/temporary_folder.h"
#include "ridgeline/base/thread_annotations.h"
#include "ridgeline/base/units.h"
#include "ridgeline/build/imagery/image_rows.h"
#include "ridgeline/build/imagery/imagery_layer.h"
#include "ridgeline/jobs/job_system.h"
#include "ridgeline/telemetry/clock.h"

namespace ridgeline::app {
namespace {

namespace fs = std::filesystem;
using build::BlockTexels;
using build::Texel;

// Room for the layer's texels and its threads; the source is held beside it.
constexpr std::uint64_t kLayerMemory = 2_GiB;

int thread_count(const ImagerySuiteOptions& options) {
    return options.threads > 0 ? options.threads
                               : std::max(2, static_cast<int>(std::thread::hardware_concurrency()));
}

// A part of the picture with its own texels and blocks, as an encoder takes it.
struct Square {
    std::vector<Texel> texels;
    std::vector<io::Bc1Block> blocks;
    int side = 0;

    build::TexelSquare view() { return {texels, side, blocks}; }
};

Square cut(const DecodedTexels& picture, std::int64_t west, std::int64_t north, std::int64_t side) {
    Square square;
    square.side = static_cast<int>(side);
    for (std::int64_t y = 0; y < side; ++y)
        square.texels.insert(square.texels.end(), &picture.at(west, north + y), &picture.at(west, north + y) + side);
    square.blocks.resize(square.texels.size() / 16);
    return square;
}

// All that fit; none where the picture is smaller than a block.
std::vector<Square> squares_of(const DecodedTexels& picture) {
    const std::int64_t width = picture.info().width, height = picture.info().height;
    const std::int64_t side = std::min({std::int64_t{io::kImageryTile}, width, height}) / 4 * 4;
    std::vector<Square> squares;
    for (std::int64_t y = 0; side > 0 && y + side <= height; y += side)
        for (std::int64_t x = 0; x + side <= width; x += side) squares.push_back(cut(picture, x, y, side));
    return squares;
}

double psnr_db(const std::vector<Square>& squares) {
    SquaredErrors errors;
    for (Square square : squares)
        build::for_each_block(square.view(), [&](const BlockTexels& is, const io::Bc1Block& block) {
            const BlockTexels shown = shown_texels(block);
            for (std::size_t i = 0; i < is.size(); ++i) errors.add(is[i], shown[i]);
        });
    return errors.psnr_db();
}

// What the best of several rounds took.
struct Taken {
    double wall_s = std::numeric_limits<double>::infinity(), cpu_s = wall_s;

    template <class Work>
    Result<void> measure(Work work) {
        const std::int64_t wall_ns = telemetry::now_ns(), cpu_ns = telemetry::process_cpu_ns();
        RIDGELINE_TRY(work());
        wall_s = std::min(wall_s, 1e-9 * static_cast<double>(telemetry::now_ns() - wall_ns));
        cpu_s = std::min(cpu_s, 1e-9 * static_cast<double>(telemetry::process_cpu_ns() - cpu_ns));
        return {};
    }
    void report(Figures& figures, const std::string& variant, double texels) const {
        figures.set(variant, "mpixel_per_s", texels / wall_s / 1e6);
        figures.set(variant, "mpixel_per_cpu_s", texels / cpu_s / 1e6);
    }
};

// Gives all squares to the encoder, as many at once as it takes, and waits for the last.
class SquareEncoding {
  public:
    SquareEncoding(build::ImageEncoder& encoder, jobs::JobSystem& jobs)
        : encoder_(encoder),
          jobs_(jobs),
          lanes_(encoder.tiles_under_way(jobs.worker_count())),
          free_(lanes_) {}

    Result<void> run(std::vector<Square>& squares) {
        for (Square& square : squares) {
            free_.acquire();
            jobs_.submit([this, &square] { encode(square); }, &running_);
        }
        for (std::ptrdiff_t lane = 0; lane < lanes_; ++lane) free_.acquire();
        jobs_.wait(running_);
        free_.release(lanes_);
        const MutexLock lock(mutex_);
        return failure_;
    }

  private:
    void encode(Square& square) {
        const auto view = square.view();
        encoder_.encode({&view, 1}, [this](const Result<void>& encoded) {
            const MutexLock lock(mutex_);
            if (failure_ && !encoded) failure_ = encoded;
            free_.release();
        });
    }

    build::ImageEncoder& encoder_;
    jobs::JobSystem& jobs_;
    std::ptrdiff_t lanes_;
    std::counting_semaphore<> free_;
    jobs::Counter running_;
    Mutex mutex_;
    Result<void> failure_ RIDGELINE_GUARDED_BY(mutex_);
};

class EncoderRace {
  public:
    EncoderRace(DecodedTexels& picture, const std::vector<NamedEncoder>& encoders,
                const ImagerySuiteOptions& options)
        : picture_(picture), encoders_(encoders), options_(options), squares_(squares_of(picture)) {}

    Result<void> run(Figures& figures) {
        if (squares_.empty()) return Error{"the source has no 4 x 4 texels within the terrain"};
        std::int64_t done = 0;
        const std::int64_t rounds = options_.rounds + 1;
        for (std::int64_t round = 0; round < rounds; ++round) {
            for (Lane& lane : lanes_) {
                // The first warms up: shaders are compiled, memory is touched.
                if (round == 1) lane.blocks = lane.layer = {};
                RIDGELINE_TRY(encode_squares(lane));
                if (round == 0) lane.psnr_db = psnr_db(squares_);
                RIDGELINE_TRY(build_layer(lane));
            }
            if (options_.progress) options_.progress(++done, rounds);
        }
        report(figures);
        return {};
    }

  private:
    struct Lane {
        const NamedEncoder& named;
        Taken blocks, layer;
        double psnr_db = 0.0;
        std::int64_t layer_bytes = 0;
    };
    static std::vector<Lane> lanes_of(const std::vector<NamedEncoder>& encoders) {
        std::vector<Lane> lanes;
        for (const NamedEncoder& named : encoders) lanes.push_back({named, {}, {}});
        return lanes;
    }

    Result<void> encode_squares(Lane& lane) {
        jobs::JobSystemOptions job_options;
        job_options.workers = thread_count(options_);
        jobs::JobSystem jobs(job_options);
        SquareEncoding encoding(lane.named.encoder, jobs);
        return lane.blocks.measure([&] { return encoding.run(squares_); });
    }

    Result<void> build_layer(Lane& lane) {
        const TemporaryFolder folder;
        const fs::path scratch = folder.path() / "scratch";
        std::error_code failed;
        if (!fs::create_directory(scratch, failed))
            return Error{scratch.string() + ": cannot make the folder: " + failed.message()};
        build::LayerOptions layer;
        layer.threads = thread_count(options_);
        layer.memory_bytes = kLayerMemory;
        layer.encoder = &lane.named.encoder;
        return lane.layer.measure([&]() -> Result<void> {
            const auto info = build::build_imagery_layer(picture_, folder.path(), scratch, layer);
            if (!info) return info.error();
            lane.layer_bytes = info->bytes;
            return {};
        });
    }

    void report(Figures& figures) const {
        const double encoded = static_cast<double>(squares_.size()) * squares_[0].side * squares_[0].side;
        for (const Lane& lane : lanes_) {
            const std::string variant = "encoder/" + lane.named.name;
            lane.blocks.report(figures, variant, encoded);
            figures.set(variant, "psnr_db", lane.psnr_db);
        }
        const auto texels = static_cast<double>(picture_.count());
        for (const Lane& lane : lanes_) {
            const std::string variant = "layer/" + lane.named.name;
            lane.layer.report(figures, variant, texels);
            figures.set(variant, "bytes", static_cast<double>(lane.layer_bytes));
            figures.set(variant, "bytes_per_texel", static_cast<double>(lane.layer_bytes) / texels);
        }
    }

    DecodedTexels& picture_;
    const std::vector<NamedEncoder>& encoders_;
    const ImagerySuiteOptions& options_;
    std::vector<Square> squares_;
    std::vector<Lane> lanes_ = lanes_of(encoders_);
};

// --- the store's own imagery

bool same_lattice(const io::ImageryInfo& a, const io::ImageryInfo& b) {
    return a.west_m == b.west_m && a.north_m == b.north_m && a.spacing_x_m == b.spacing_x_m &&
           a.spacing_y_m == b.spacing_y_m && a.width == b.width;
}

Result<void> add_errors(const io::Store& store, io::NodeId node, const DecodedTexels& picture,
                        SquaredErrors& errors) {
    std::vector<std::uint8_t> bytes;
    RIDGELINE_TRY(store.read_payload(io::Layer::imagery, node, bytes));
    std::vector<io::Bc1Block> blocks(io::kImageryBlockCount);
    io::ImageryScratch scratch;
    RIDGELINE_TRY(io::decode_imagery(bytes, scratch, std::as_writable_bytes(std::span(blocks))));
    const io::LatticePoint origin = store.imagery_grid().origin(node);
    for (std::int64_t y = 0; y < io::kImageryTile; y += 4)
        for (std::int64_t x = 0; x < io::kImageryTile; x += 4) {
            const std::int64_t row = (y + io::kImageryGutter) / 4, column = (x + io::kImageryGutter) / 4;
            const BlockTexels shown =
                shown_texels(blocks[static_cast<std::size_t>(row * io::kImageryBlocks + column)]);
            for (std::int64_t i = 0; i < 16; ++i) {
                const std::int64_t east = origin.x + x + i % 4, south = origin.y + y + i / 4;
                if (east < picture.info().width && south < picture.info().height)
                    errors.add(picture.at(east, south), shown[static_cast<std::size_t>(i)]);
            }
        }
    return {};
}

Result<void> judge_store(const io::Store& store, const DecodedTexels& picture, Figures& figures) {
    if (!store.info().imagery) return {};
    const io::ImageryInfo& info = *store.info().imagery;
    const auto bytes = static_cast<double>(info.bytes);
    figures.set("store/imagery", "bytes", bytes);
    figures.set("store/imagery", "bytes_per_texel",
                bytes / (static_cast<double>(info.width) * static_cast<double>(info.height)));
    if (!same_lattice(info, picture.info())) return {};
    const io::Grid& grid = store.imagery_grid();
    SquaredErrors errors;
    for (std::int64_t i = grid.first(grid.finest()); i < grid.first(grid.finest() + 1); ++i)
        if (const io::NodeId node = grid.node_at(i); store.imagery_record(node).has_data())
            RIDGELINE_TRY(add_errors(store, node, picture, errors));
    figures.set("store/imagery", "psnr_db", errors.psnr_db());
    return {};
}

// Zero where one of them is no file.
double file_bytes(const std::vector<std::string>& sources) {
    double bytes = 0.0;
    for (const std::string& source : sources) {
        std::error_code failed;
        const auto size = fs::file_size(source, failed);
        if (failed) return 0.0;
        bytes += static_cast<double>(size);
    }
    return bytes;
}

}  // namespace

Result<Figures> compare_encoders(const io::Store& store, const std::vector<std::string>& sources,
                                 const std::vector<NamedEncoder>& encoders,
                                 const ImagerySuiteOptions& options) {
    build::ImageSources images;
    images.paths = sources;
    images.threads = thread_count(options);
    const auto rows = build::open_imagery(images, store.info());
    if (!rows) return rows.error();
    const auto picture = DecodedTexels::read_from(**rows, options.most_texels);
    if (!picture) return picture.error();
    Figures figures;
    RIDGELINE_TRY(EncoderRace(**picture, encoders, options).run(figures));
    RIDGELINE_TRY(judge_store(store, **picture, figures));
    // Of a part of the source a ratio would say nothing.
    const double source_bytes = file_bytes(sources);
    if (source_bytes == 0.0 || (*picture)->info().height != (*rows)->info().height) return figures;
    for (const std::string& variant : figures.variants()) {
        const double* bytes = figures.find(variant, "bytes");
        if (bytes == nullptr) continue;
        const double ratio = *bytes / source_bytes;
        figures.set(variant, "source_bytes", source_bytes);
        figures.set(variant, "bytes_ratio", ratio);
    }
    return figures;
}

}  // namespace ridgeline::app
