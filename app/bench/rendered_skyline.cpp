#include "ridgeline/app/bench/rendered_skyline.h"

#include <cmath>

#include "ridgeline/app/walk/stage.h"

namespace ridgeline::app {
namespace {

// Tells sky from ground, which has no such colour.
constexpr render::PlainBackground kSky{255, 0, 255};

bool is_sky(const gl::Image& image, int x, int y) {
    const std::byte* rgb = &image.rgb[static_cast<std::size_t>((y * image.size_px.x + x) * 3)];
    return rgb[0] == std::byte{kSky.red} && rgb[1] == std::byte{kSky.green} && rgb[2] == std::byte{kSky.blue};
}

std::vector<int> skyline_of(const gl::Image& image) {
    std::vector<int> rows;
    for (int x = 0; x < image.size_px.x; ++x) {
        int row = 0;
        while (row < image.size_px.y && is_sky(image, x, row)) ++row;
        rows.push_back(row);
    }
    return rows;
}

}  // namespace

Result<Still> take_still(const io::Store& store, jobs::JobSystem& jobs, const StillOptions& options) {
    StageOptions stage_options;
    stage_options.criterion_options = select::kErrorAlone;
    stage_options.frame.size_px = options.camera.lens.size_px;
    stage_options.pixel_error = options.pixel_error_px;
    stage_options.horizon = options.horizon;
    stage_options.wait = TileWait::settle;
    const auto stage = TerrainStage::create(store, jobs, stage_options);
    if (!stage) return stage.error();
    StageMoment moment;
    moment.camera = options.camera;
    Still still;
    still.lift_m = (*stage)->show(moment).eye_lift_m;
    still.image = gl::read_image((*stage)->target());
    moment.number = 1;
    moment.background = kSky;
    (*stage)->show(moment);
    still.skyline = skyline_of(gl::read_image((*stage)->target()));
    return still;
}

SkylineDeviation::SkylineDeviation(const Still& reference, const Still& still) {
    const int height = still.image.size_px.y;
    const auto is_seen = [height](int row) { return row > 0 && row < height; };
    for (std::size_t x = 0; x < still.skyline.size(); ++x) {
        const bool both = is_seen(reference.skyline[x]) && is_seen(still.skyline[x]);
        upwards_px_.push_back(both ? reference.skyline[x] - still.skyline[x] : 0);
        if (both) errors_px_.push_back(std::abs(upwards_px_.back()));
    }
}

}  // namespace ridgeline::app
