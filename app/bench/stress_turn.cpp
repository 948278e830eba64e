#include "ridgeline/app/bench/stress_turn.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ridgeline/app/bench/stress_look.h"
#include "ridgeline/pager/read_group.h"
#include "ridgeline/pager/tile_source.h"

namespace ridgeline::app {
namespace {

using Clock = std::chrono::steady_clock;

// A disk that fails may need several rounds of two seconds.
constexpr std::chrono::seconds kLongestTurn{60};
constexpr double kFloorFrames = 2.0;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Turn {
    double sharp_s = 0.0;  // nothing missing in the picture
    double there_s = 0.0;  // ... nor of what is wanted beside it
    double floor_s = 0.0;
    double bytes = 0.0;
    std::int64_t frames = 0;
    std::int64_t missing = 0;
    bool finished = true;  // within kLongestTurn
};

class TurnRound {
  public:
    TurnRound(const StressTurns& turns, const StressVariant& variant, WalkLane& lane)
        : turns_(turns), variant_(variant), lane_(lane) {}

    Turn from(const platform::Pose& pose) {
        platform::Pose behind = pose;
        behind.heading = behind.heading + Angle::from_degrees(180.0);
        wait_at(pose);
        return wait_at(behind);
    }

  private:
    StageMoment moment(const platform::Pose& pose) {
        return {.number = number_++,
                .camera = {pose, turns_.walk.lens},
                .turn_per_second = {},
                .now = platform::Seconds(seconds_since(start_)),
                .daylight = {},
                .background = kStressBackground};
    }

    Turn wait_at(const platform::Pose& pose) {
        const auto start = Clock::now();
        const pager::PagerCounters before = lane_.stage().pager().counters();
        Turn turn;
        double sum_ms = 0.0;
        std::optional<double> sharp_s;
        do {
            const LaneFrame frame = lane_.show(moment(pose));
            ++turn.frames;
            sum_ms += frame.frame_ms;
            turn.missing = missing_tiles(lane_.stage(), frame.report);
            turn.there_s = seconds_since(start);
            const bool sharp = frame.report.selection.missing + frame.report.imagery_missing == 0;
            if (sharp && !sharp_s) sharp_s = turn.there_s;
        } while (!is_there(turn) && Clock::now() - start < kLongestTurn);
        turn.finished = is_there(turn);
        const pager::PagerCounters after = lane_.stage().pager().counters();
        turn.sharp_s = sharp_s.value_or(turn.there_s);
        turn.bytes = static_cast<double>(after.bytes_read - before.bytes_read);
        const double delay_s = std::chrono::duration<double>(variant_.fault.delay).count();
        turn.floor_s = turn.bytes / turns_.disk_bytes_per_s +
                       delay_s * static_cast<double>(after.reads - before.reads) +
                       kFloorFrames * sum_ms * 1e-3 / static_cast<double>(turn.frames);
        return turn;
    }

    // Nor may other tiles be wanted for those that came. Where nothing fails, what is missing when nothing is
    // under way has no room.
    bool is_there(const Turn& turn) const {
        TerrainStage& stage = lane_.stage();
        if (turn.missing == 0) return !stage.selection().unsettled;
        return !variant_.fault.any() && stage.pager().settled();
    }

    const StressTurns& turns_;
    const StressVariant& variant_;
    WalkLane& lane_;
    Clock::time_point start_ = Clock::now();
    std::uint64_t number_ = 0;
};

void report(const std::vector<Turn>& turns, const std::string& name, Figures& figures) {
    const auto summarise = [&](const std::string& metric, const auto& value) {
        double sum = 0.0, most = 0.0;
        for (const Turn& turn : turns) {
            const auto one = static_cast<double>(value(turn));
            sum += one;
            most = std::max(most, one);
        }
        figures.set(name, metric + ".mean", sum / static_cast<double>(turns.size()));
        figures.set(name, metric + ".max", most);
    };
    summarise("turn_sharp_ms", [](const Turn& turn) { return 1e3 * turn.sharp_s; });
    summarise("turn_there_ms", [](const Turn& turn) { return 1e3 * turn.there_s; });
    summarise("turn_floor_ms", [](const Turn& turn) { return 1e3 * turn.floor_s; });
    summarise("turn_floor_ratio", [](const Turn& turn) { return turn.there_s / turn.floor_s; });
    summarise("turn_frames", [](const Turn& turn) { return turn.frames; });
    summarise("turn_bytes", [](const Turn& turn) { return turn.bytes; });
    summarise("turn_unfinished", [](const Turn& turn) { return turn.finished ? 0 : 1; });
    summarise("turn_missing", [](const Turn& turn) { return turn.missing; });
}

// Reads a file in pieces; returns how many bytes.
Result<std::uint64_t> read_pieces(io::ByteSource& file, std::uint64_t most_bytes) {
    std::vector<std::uint8_t> piece(pager::ReadLimits{}.max_read_bytes);
    const std::uint64_t size = std::min(file.size(), most_bytes);
    for (std::uint64_t at = 0; at < size; at += piece.size())
        RIDGELINE_TRY(
            file.read(at, std::span(piece).first(std::min<std::uint64_t>(piece.size(), size - at))));
    return size;
}

}  // namespace

Result<double> disk_bytes_per_s(const io::Store& store) {
    constexpr std::uint64_t kMost = 256_MiB;
    const pager::TileSource source = pager::tile_source(store);
    double best = 0.0;
    // The first round fetches what the system had not in memory.
    for (int round = 0; round < 3; ++round) {
        std::uint64_t bytes = 0;
        const auto start = Clock::now();
        for (io::ByteSource* file : {source.mesh, source.heights, source.imagery.tiles}) {
            if (!file) continue;
            const auto read = read_pieces(*file, kMost);
            if (!read) return read.error();
            bytes += *read;
        }
        best = std::max(best, static_cast<double>(bytes) / std::max(seconds_since(start), 1e-9));
    }
    return best;
}

Result<void> turn_round(const StressGround& ground, const StressTurns& turns, const StressVariant& variant,
                        Figures& figures, const std::function<void()>& step) {
    StageOptions options = turns.walk.stage_options();
    const CacheSizes caches = variant.caches(turns.walk.caches);
    options.frame.gpu_cache_bytes = caches.gpu_bytes;
    options.pager.ram_bytes = caches.ram_bytes;
    options.pager.fault = variant.fault;
    auto lane = WalkLane::open(ground.store, ground.jobs, options);
    if (!lane) return lane.error();
    TurnRound round(turns, variant, **lane);
    std::vector<Turn> turned;
    const platform::ResolvedPath& path = turns.walk.path;
    for (int i = 0; i < turns.count; ++i) {
        turned.push_back(round.from(path.frame(path.frame_count() * static_cast<std::size_t>(i) /
                                               static_cast<std::size_t>(turns.count))));
        step();
    }
    report(turned, std::string("turn/") + variant.name, figures);
    return {};
}

}  // namespace ridgeline::app
