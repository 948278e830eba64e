#include "ridgeline/app/bench/scheduling_walk.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "ridgeline/app/bench/cpu_lod.h"
#include "ridgeline/app/bench/scheduling_clipmaps.h"

namespace ridgeline::app {
namespace {

// What is walked, and what is reckoned beside it.
enum Drawn { kRidges, kOff, kDisc, kCpuLod, kDrawn };
constexpr std::array<const char*, kDrawn> kDrawnNames = {"ridges", "off", "disc", "cpu_lod"};
enum Reckoned { kClipmap, kRgb8, kLean, kDiscClipmap, kReckoned };
constexpr std::array<const char*, kReckoned> kReckonedNames = {"clipmap", "clipmap_rgb8", "clipmap_lean",
                                                               "clipmap_disc"};

// The clipmap in a variant's own formats, to which its bytes are held.
constexpr int clipmap_of(int drawn) { return drawn == kDisc ? kDiscClipmap : kClipmap; }

// Bytes over a walk.
struct Sum {
    double imagery = 0.0, heights = 0.0;
    double start = 0.0;  // before the first frame

    void add(const SentBytes& sent) {
        imagery += static_cast<double>(sent.imagery);
        heights += static_cast<double>(sent.heights);
    }
    double all() const { return imagery + heights; }
};

struct DrawnSum {
    Sum bytes;
    double frame_ms = 0.0, process_ms = 0.0, render_ms = 0.0;
    double imagery_missing = 0.0;
    double unsampled_bytes = 0.0;

    void add(const LaneFrame& frame, const SentBytes& sent) {
        bytes.add(sent);
        frame_ms += frame.frame_ms;
        process_ms += frame.process_ms;
        render_ms += frame.render_ms;
        imagery_missing += static_cast<double>(frame.report.imagery_missing);
        unsampled_bytes += static_cast<double>(frame.report.bytes_uploaded) - static_cast<double>(sent.all());
    }
};

// Of the disc what it samples: the chunks beneath it, to stand upon, are reported by themselves.
SentBytes uploaded(int variant, const StageReport& report) {
    const auto imagery = static_cast<std::int64_t>(report.imagery_bytes_uploaded);
    if (variant == kDisc)
        return {.imagery = imagery, .heights = static_cast<std::int64_t>(report.heights_bytes_uploaded)};
    return {.imagery = imagery, .heights = static_cast<std::int64_t>(report.bytes_uploaded) - imagery};
}

class Walk {
  public:
    Walk(const io::Store& store, jobs::JobSystem& jobs, const BenchWalk& walk)
        : store_(store), jobs_(jobs), walk_(walk), steps_(walk) {
        const ClipmapView view = clipmap_view(walk.lens, walk.pixel_error_px);
        clipmaps_[kClipmap].emplace(store, view, kStoreFormats);
        clipmaps_[kRgb8].emplace(store, view, kRgb8Formats);
        clipmaps_[kLean].emplace(store, view, kLeanFormats);
        clipmaps_[kDiscClipmap].emplace(store, view, kDiscFormats);
    }

    Result<void> open() {
        for (int variant = 0; variant < kDrawn; ++variant) {
            StageOptions options = walk_.stage_options();
            const bool sees_horizon = variant == kRidges || variant == kDisc;
            options.horizon = sees_horizon ? select::HorizonMode::ridges : select::HorizonMode::off;
            if (variant == kDisc) options.frame.surfaces = render::Surfaces::all;
            auto lane = WalkLane::open(store_, jobs_, options);
            if (!lane) return lane.error();
            lanes_[at(variant)] = std::move(*lane);
        }
        auto sender = CpuLod::create();
        if (!sender) return sender.error();
        cpu_lod_.emplace(std::move(*sender));
        return {};
    }

    void run(std::string& csv, const std::function<void()>& step) {
        start();
        glm::dvec3 before_m = eye_m();
        for (std::int64_t frame = 0; frame < walk_.frames; ++frame) {
            steps_.go_to(frame);
            walked_m_ += glm::distance(before_m, eye_m());
            before_m = eye_m();
            // Each in its turn is the first.
            for (int i = 0; i < kDrawn; ++i) show(static_cast<int>((frame + i) % kDrawn));
            reckon();
            append_row(frame, csv);
            step();
        }
    }

    void report(Figures& figures) {
        for (int variant = 0; variant < kDrawn; ++variant) report_drawn(variant, figures);
        for (int variant = 0; variant < kReckoned; ++variant) {
            const std::string name = of(kReckonedNames[at(variant)]);
            report_bytes(name, reckoned_[at(variant)], figures);
            report_windows(name, *clipmaps_[at(variant)], figures);
        }
        compare(figures);
    }

  private:
    static std::size_t at(int variant) { return static_cast<std::size_t>(variant); }
    glm::dvec3 eye_m() const { return steps_.moment().camera.pose.eye_m; }
    std::string of(const char* variant) const { return walk_.name + "/" + variant; }

    void start() {
        steps_.go_to(0);
        for (int variant = 0; variant < kDrawn; ++variant) {
            const StageReport arrived = lanes_[at(variant)]->arrive(moment(variant));
            const auto bytes = static_cast<double>(uploaded(variant, arrived).all());
            // One that keeps nothing has no start.
            drawn_[at(variant)].bytes.start = variant == kCpuLod ? 0.0 : bytes;
        }
        for (int variant = 0; variant < kReckoned; ++variant)
            reckoned_[at(variant)].start = static_cast<double>(clipmaps_[at(variant)]->start(eye_m()).all());
    }

    StageMoment moment(int variant) const {
        StageMoment moment = steps_.moment();
        if (variant == kDisc) moment.surface = render::Surface::disc;
        return moment;
    }

    void show(int variant) {
        WalkLane& lane = *lanes_[at(variant)];
        SentBytes sent;
        std::function<void()> also;
        if (variant == kCpuLod) also = [&] { sent = cpu_lod_->send(lane.stage()); };
        const LaneFrame frame = lane.show(moment(variant), also);
        if (variant != kCpuLod) sent = uploaded(variant, frame.report);
        drawn_[at(variant)].add(frame, sent);
        frames_[at(variant)] = frame;
        drawn_sent_[at(variant)] = sent;
    }

    void reckon() {
        for (int variant = 0; variant < kReckoned; ++variant) {
            reckoned_sent_[at(variant)] = clipmaps_[at(variant)]->move_to(steps_.moment().camera.pose.eye_m);
            reckoned_[at(variant)].add(reckoned_sent_[at(variant)]);
        }
    }

    void append_row(std::int64_t frame, std::string& csv) const {
        csv += walk_.name + "," + std::to_string(frame);
        for (const SentBytes& sent : drawn_sent_) append(sent, csv);
        for (const SentBytes& sent : reckoned_sent_) append(sent, csv);
        for (const LaneFrame& drawn : frames_) {
            std::array<char, 96> text{};
            std::snprintf(text.data(), text.size(), ",%.3f,%.1f,%.1f", drawn.frame_ms,
                          100.0 * drawn.process_ms / drawn.frame_ms,
                          100.0 * drawn.render_ms / drawn.frame_ms);
            csv += text.data();
        }
        csv += '\n';
    }
    static void append(const SentBytes& sent, std::string& csv) {
        csv += "," + std::to_string(sent.all()) + "," + std::to_string(sent.imagery);
    }

    void report_bytes(const std::string& name, const Sum& sum, Figures& figures) const {
        const auto frames = static_cast<double>(walk_.frames);
        figures.set(name, "frames", frames);
        figures.set(name, "pixel_error_px", walk_.pixel_error_px);
        figures.set(name, "bytes_per_frame", sum.all() / frames);
        figures.set(name, "imagery_bytes_per_frame", sum.imagery / frames);
        figures.set(name, "heights_bytes_per_frame", sum.heights / frames);
        figures.set(name, "start_bytes", sum.start);
        if (walked_m_ > 0.0) figures.set(name, "bytes_per_m", sum.all() / walked_m_);
    }

    void report_drawn(int variant, Figures& figures) const {
        const DrawnSum& sum = drawn_[at(variant)];
        const std::string name = of(kDrawnNames[at(variant)]);
        report_bytes(name, sum.bytes, figures);
        lanes_[at(variant)]->report(name, figures);
        const auto frames = static_cast<double>(walk_.frames);
        figures.set(name, "fps_mean", 1000.0 * frames / sum.frame_ms);
        figures.set(name, "cpu_percent.process", 100.0 * sum.process_ms / sum.frame_ms);
        figures.set(name, "cpu_percent.render", 100.0 * sum.render_ms / sum.frame_ms);
        figures.set(name, "per_frame.imagery_missing", sum.imagery_missing / frames);
        if (variant == kDisc) figures.set(name, "chunk_bytes_per_frame", sum.unsampled_bytes / frames);
    }

    static void report_windows(const std::string& name, const StoreClipmaps& clipmaps, Figures& figures) {
        const auto widest = [](const Clipmap& clipmap) {
            std::int64_t texels = 0;
            for (const ClipmapWindow& window : clipmap.windows())
                texels = std::max({texels, window.size_texels().x, window.size_texels().y});
            return static_cast<double>(texels);
        };
        figures.set(name, "imagery_window_texels", widest(clipmaps.imagery()));
        figures.set(name, "heights_window_texels", widest(clipmaps.heights()));
    }

    // Ratios to the clipmap in the same formats; none where that sends nothing.
    void compare(Figures& figures) const {
        for (int variant = 0; variant < kDrawn; ++variant)
            compare(kDrawnNames[at(variant)], clipmap_of(variant), figures);
        for (const int variant : {kRgb8, kLean}) compare(kReckonedNames[at(variant)], kClipmap, figures);
    }
    void compare(const char* variant, int reckoned, Figures& figures) const {
        const auto ratio = [&](const char* metric, const auto& value) {
            const double clipmap = value(of(kReckonedNames[at(reckoned)]));
            if (clipmap > 0.0) figures.set(of(variant), metric, value(of(variant)) / clipmap);
        };
        const auto found = [&](const char* metric) {
            return [&figures, metric](const std::string& name) { return *figures.find(name, metric); };
        };
        ratio("bytes_ratio", found("bytes_per_frame"));
        ratio("imagery_bytes_ratio", found("imagery_bytes_per_frame"));
        ratio("heights_bytes_ratio", found("heights_bytes_per_frame"));
        ratio("bytes_ratio_with_start", [&](const std::string& name) {
            return *figures.find(name, "start_bytes") +
                   static_cast<double>(walk_.frames) * *figures.find(name, "bytes_per_frame");
        });
    }

    const io::Store& store_;
    jobs::JobSystem& jobs_;
    const BenchWalk& walk_;
    WalkSteps steps_;
    std::array<std::unique_ptr<WalkLane>, kDrawn> lanes_;
    std::optional<CpuLod> cpu_lod_;
    std::array<std::optional<StoreClipmaps>, kReckoned> clipmaps_;
    double walked_m_ = 0.0;
    std::array<DrawnSum, kDrawn> drawn_;
    std::array<Sum, kReckoned> reckoned_;
    // Of the last frame.
    std::array<LaneFrame, kDrawn> frames_;
    std::array<SentBytes, kDrawn> drawn_sent_;
    std::array<SentBytes, kReckoned> reckoned_sent_;
};

}  // namespace

std::string scheduling_csv_header() {
    std::string line = "path,frame";
    const auto add_bytes = [&](const char* variant) {
        line += "," + std::string(variant) + "_bytes," + variant + "_imagery_bytes";
    };
    for (const char* variant : kDrawnNames) add_bytes(variant);
    for (const char* variant : kReckonedNames) add_bytes(variant);
    for (const char* variant : kDrawnNames)
        for (const char* metric : {"frame_ms", "cpu_process_percent", "cpu_render_percent"})
            line += "," + std::string(variant) + "_" + metric;
    return line + "\n";
}

Result<void> walk_scheduling(const io::Store& store, jobs::JobSystem& jobs, const BenchWalk& walk,
                             Figures& figures, std::string& csv, const std::function<void()>& step) {
    Walk walked(store, jobs, walk);
    RIDGELINE_TRY(walked.open());
    walked.run(csv, step);
    walked.report(figures);
    return {};
}

}  // namespace ridgeline::app
