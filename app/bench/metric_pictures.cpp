#include "ridgeline/app/bench/metric_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "ridgeline/app/bench/picture_sheet.h"
#include "ridgeline/app/bench/rendered_skyline.h"
#include "ridgeline/app/bench/view_triangles.h"
#include "ridgeline/app/walk/stage.h"
#include "ridgeline/telemetry/summary.h"

namespace ridgeline::app {
namespace {

// What the source is drawn with: nobody sees a quarter of a pixel.
constexpr double kSource_px = 0.25;
constexpr int kDivider_px = 4;
// How much the strips enlarge what they show.
constexpr int kStripScale = 8;

constexpr glm::u8vec3 kPaper{255, 255, 255};
constexpr Ink kAxis{{150, 150, 150}};
constexpr Ink kTooHigh{{217, 95, 2}};
constexpr Ink kTooLow{{49, 104, 189}};
constexpr Ink kSourceLine{{225, 20, 40}};
constexpr Ink kFrame{{255, 255, 255}};

// Where what lies on a sheet.
struct Layout {
    explicit Layout(const MetricPictureOptions& options)
        : half(options.lens.size_px),
          width((2 * half.x) + kDivider_px),
          inset((width - 2 * kDivider_px) / 3, half.y * 3 / 5),
          strip(half.x, half.y / 6) {}

    glm::ivec2 size() const { return {width, half.y + inset.y + strip.y + 2 * kDivider_px}; }
    glm::ivec2 half_at(int side) const { return {side * (half.x + kDivider_px), 0}; }
    // Three beside each other.
    glm::ivec2 inset_at(int place) const { return {place * (width - inset.x) / 2, half.y + kDivider_px}; }
    glm::ivec2 strip_at(int side) const { return {half_at(side).x, half.y + inset.y + 2 * kDivider_px}; }

    glm::ivec2 half;
    int width;
    glm::ivec2 inset, strip;
};

struct Counted {
    double pixel_error_px = 0.0;
    double triangles = 0.0;
};

struct Variant {
    const char* name;
    const io::Store* store;
    Counted counted{};
    Still still{};
};

// One view of everything, magnified.
struct View {
    Still source;
    std::array<Variant, 2> variants;

    double most_lift_m() const {
        return std::max({source.lift_m, variants[0].still.lift_m, variants[1].still.lift_m});
    }
};

// Of the magnified stills: where the two skylines are farthest apart, whichever is the better one.
PixelBox telling_part(const Still& source, const SkylineDeviation& a, const SkylineDeviation& b,
                      const glm::ivec2& size_px) {
    // A cliff that is drawn a little aside does not outweigh a whole mountain.
    const int most = size_px.y / 8;
    const auto apart = [&](int x) {
        const auto at = static_cast<std::size_t>(x);
        return std::min(std::abs(a.upwards_px()[at] - b.upwards_px()[at]), most);
    };
    int sum = 0, best_sum = -1, best = 0;
    for (int end = 1; end <= source.image.size_px.x; ++end) {
        sum += apart(end - 1);
        if (end > size_px.x) sum -= apart(end - 1 - size_px.x);
        if (end < size_px.x || sum <= best_sum) continue;
        best_sum = sum;
        best = end - size_px.x;
    }
    std::vector<int> rows(source.skyline.begin() + best, source.skyline.begin() + best + size_px.x);
    const auto middle = rows.begin() + size_px.x / 2;
    std::ranges::nth_element(rows, middle);
    return {{best, std::clamp(*middle - size_px.y / 2, 0, source.image.size_px.y - size_px.y)}, size_px};
}

std::string caption(const Variant& variant, const telemetry::Summary& skyline_px) {
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  "%s at %.1f px: %.0f triangles; skyline off by %.2f px (99%% by less than %.1f)",
                  variant.name, variant.counted.pixel_error_px, variant.counted.triangles, skyline_px.mean,
                  skyline_px.p99);
    return text.data();
}

class Sheet {
  public:
    Sheet(const Layout& layout, int magnification, const Still& source)
        : layout_(layout), magnification_(magnification), source_(source), sheet_(layout.size(), kPaper) {}

    void lay_half(int side, const Still& still, const PixelBox& part, const std::string& label) {
        const glm::ivec2 at = layout_.half_at(side);
        sheet_.lay(gl::shrink(still.image, magnification_), at);
        sheet_.outline({at + part.origin / magnification_, part.size / magnification_}, kFrame);
        sheet_.label(label, at);
    }

    enum class Line { none, source_skyline };
    void lay_inset(int place, const Still& still, const PixelBox& part, Line line, const std::string& label) {
        const glm::ivec2 at = layout_.inset_at(place);
        sheet_.lay(still.image, part, at);
        if (line == Line::source_skyline) draw_source_skyline(part, at);
        // The sky's part of the picture is what is looked at.
        sheet_.label(label, at + glm::ivec2(0, layout_.inset.y - PictureSheet::label_height_px()));
    }

    void lay_strip(int side, const SkylineDeviation& deviation) {
        const glm::ivec2 at = layout_.strip_at(side);
        const int middle = layout_.strip.y / 2;
        for (int x = 0; x < layout_.strip.x; ++x) {
            const auto off = static_cast<int>(std::lround(upwards_px(deviation, x) * kStripScale));
            const int length = std::min(std::abs(off), middle);
            const int top = off > 0 ? middle - length : middle;
            sheet_.fill({at + glm::ivec2(x, top), {1, length}}, off > 0 ? kTooHigh : kTooLow);
        }
        sheet_.fill({at + glm::ivec2(0, middle), {layout_.strip.x, 1}}, kAxis);
        sheet_.label("off the source's skyline, x" + std::to_string(kStripScale), at);
    }

    const gl::Image& image() const { return sheet_.image(); }

  private:
    // Of a column as shown, in pixels as shown.
    double upwards_px(const SkylineDeviation& deviation, int column) const {
        const auto first = deviation.upwards_px().begin() + column * magnification_;
        return std::accumulate(first, first + magnification_, 0.0) / (magnification_ * magnification_);
    }

    void draw_source_skyline(const PixelBox& part, const glm::ivec2& at) {
        const auto row = [&](int x) {
            return source_.skyline[static_cast<std::size_t>(part.origin.x + x)] - part.origin.y;
        };
        for (int x = 0; x < part.size.x; ++x) {
            const int before = row(std::max(x - 1, 0)), here = row(x);
            const int top = std::clamp(std::min(before, here), 0, part.size.y);
            const int end = std::clamp(std::max(before, here) + 1, 0, part.size.y);
            sheet_.fill({at + glm::ivec2(x, top), {1, end - top}}, kSourceLine);
        }
    }

    const Layout& layout_;
    int magnification_;
    const Still& source_;
    PictureSheet sheet_;
};

// A sixteenth of an octave apart.
std::vector<Counted> counts(const io::Store& store, const platform::Camera& camera, Range<double> octaves,
                            double pixel_error_px) {
    ViewTriangles triangles(store, select::kErrorAlone);
    std::vector<Counted> list;
    for (double octave = octaves.least; octave <= octaves.most; octave += 1.0 / 16.0) {
        const double at_px = pixel_error_px * std::exp2(octave);
        list.push_back({at_px, triangles.count(camera, at_px)});
    }
    return list;
}

// Both variants' pixel errors become such that they draw as many triangles. A whole branch may refine at
// once, so the geometric store's may also stray a little from the one asked for.
void balance(const platform::Camera& camera, double pixel_error_px, std::array<Variant, 2>& variants) {
    // An octave astray weighs as much as such a share of the triangles more or less.
    constexpr double kStraying = 0.05, kConeStraying = 0.002;
    const auto astray = [&](const Counted& counted) {
        return std::abs(std::log2(counted.pixel_error_px / pixel_error_px));
    };
    const auto of_geometric = counts(*variants[0].store, camera, {-0.5, 0.5}, pixel_error_px);
    const auto of_cone = counts(*variants[1].store, camera, {-3.0, 3.0}, pixel_error_px);
    double least = std::numeric_limits<double>::infinity();
    for (const Counted& geometric : of_geometric)
        for (const Counted& cone : of_cone) {
            const double apart =
                std::abs(cone.triangles - geometric.triangles) / std::max(geometric.triangles, 1.0) +
                kStraying * astray(geometric) + kConeStraying * astray(cone);
            if (apart >= least) continue;
            least = apart;
            variants[0].counted = geometric;
            variants[1].counted = cone;
        }
}

// The same picture, larger: neither the view nor its triangles change.
StillOptions magnified(const platform::Camera& camera, double pixel_error_px, int magnification) {
    StillOptions options{.camera = camera, .pixel_error_px = pixel_error_px * magnification};
    options.camera.lens.size_px *= magnification;
    return options;
}

Result<View> take_stills(jobs::JobSystem& jobs, const platform::Camera& camera, int magnification,
                         std::array<Variant, 2> variants) {
    StillOptions of_source = magnified(camera, kSource_px, magnification);
    of_source.horizon = select::HorizonMode::ridges;  // changes no pixel, saves most of the triangles
    auto source = take_still(*variants[0].store, jobs, of_source);
    if (!source) return source.error();
    View view{std::move(*source), std::move(variants)};
    for (Variant& variant : view.variants) {
        auto still = take_still(*variant.store, jobs,
                                magnified(camera, variant.counted.pixel_error_px, magnification));
        if (!still) return still.error();
        variant.still = std::move(*still);
    }
    return view;
}

gl::Image compose(const View& view, const MetricPictureOptions& options, const std::string& name,
                  Figures& figures) {
    using Line = Sheet::Line;
    const Layout layout(options);
    const int magnification = options.magnification;
    const std::array<SkylineDeviation, 2> off = {SkylineDeviation(view.source, view.variants[0].still),
                                                 SkylineDeviation(view.source, view.variants[1].still)};
    const PixelBox part = telling_part(view.source, off[0], off[1], layout.inset);
    Sheet sheet(layout, magnification, view.source);
    for (int side = 0; side < 2; ++side) {
        const Variant& variant = view.variants[static_cast<std::size_t>(side)];
        const SkylineDeviation& deviation = off[static_cast<std::size_t>(side)];
        std::vector<double> errors_px = deviation.errors_px();
        for (double& error : errors_px) error /= magnification;
        const telemetry::Summary skyline_px = telemetry::summarise(errors_px);
        sheet.lay_half(side, variant.still, part, caption(variant, skyline_px));
        sheet.lay_inset(2 * side, variant.still, part, Line::source_skyline,
                        std::string(variant.name) + ", line: the source's skyline");
        sheet.lay_strip(side, deviation);
        const std::string row = name + "/" + variant.name;
        figures.set(row, "triangles", variant.counted.triangles);
        figures.set(row, "pixel_error_px", variant.counted.pixel_error_px);
        if (errors_px.empty()) continue;
        figures.set(row, "skyline_px.mean", skyline_px.mean);
        figures.set(row, "skyline_px.p99", skyline_px.p99);
    }
    sheet.lay_inset(1, view.source, part, Line::none, "source");
    return sheet.image();
}

}  // namespace

glm::ivec2 MetricPictures::size_px(const MetricPictureOptions& options) { return Layout(options).size(); }

Result<void> MetricPictures::draw(const platform::Pose& pose, const std::string& name, Figures& figures) {
    platform::Camera camera{pose, options_.lens};
    std::array<Variant, 2> variants = {Variant{.name = "geometric", .store = &geometric_},
                                       Variant{.name = "cone", .store = &cone_}};
    // Lifted eyes are drawn anew, all together: the camera is one.
    for (int lifts = 0;; ++lifts) {
        balance(camera, options_.pixel_error_px, variants);
        const auto view = take_stills(jobs_, camera, options_.magnification, variants);
        if (!view) return view.error();
        const double lift_m = view->most_lift_m();
        if (lift_m == 0.0 || lifts == kMostLifts)
            return gl::write_png(options_.folder / (name + ".png"), compose(*view, options_, name, figures));
        camera.pose.eye_m.z += lift_m;
    }
}

}  // namespace ridgeline::app
