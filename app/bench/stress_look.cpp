#include "ridgeline/app/bench/stress_look.h"

#include <algorithm>
#include <cstddef>

#include "ridgeline/app/bench/background_pixels.h"
#include "ridgeline/base/contract.h"

namespace ridgeline::app {

std::int64_t wrong_background(const gl::Image& image, const StageMoment& moment, const StageReport& report) {
    platform::Camera camera = moment.camera;
    camera.pose.eye_m.z += report.eye_lift_m;
    constexpr render::PlainBackground kColour = kStressBackground;
    return BackgroundPixels(image, {kColour.red, kColour.green, kColour.blue}).count_wrong(camera);
}

std::int64_t differing_pixels(const gl::Image& a, const gl::Image& b) {
    RIDGELINE_CHECK(a.size_px == b.size_px);
    std::int64_t different = 0;
    for (std::size_t i = 0; i + 2 < a.rgb.size(); i += 3)
        different += a.rgb[i] != b.rgb[i] || a.rgb[i + 1] != b.rgb[i + 1] || a.rgb[i + 2] != b.rgb[i + 2];
    return different;
}

std::int64_t missing_tiles(TerrainStage& stage, const StageReport& report) {
    const auto chunks = std::ranges::count_if(stage.selection().wanted, [&](const select::WantedTile& tile) {
        return stage.pager().state(tile.index) != pager::TileState::resident;
    });
    return chunks + static_cast<std::int64_t>(report.imagery_missing + report.heights_missing);
}

std::int64_t bytes_over_budget(const TerrainStage& stage, const CacheSizes& asked) {
    const auto over = [](std::uint64_t used, std::uint64_t budget) {
        return static_cast<std::int64_t>(used > budget ? used - budget : 0);
    };
    return over(stage.pager().ram_bytes_used(), asked.ram_bytes) +
           over(stage.gpu_cache_bytes(), asked.gpu_bytes);
}

bool at_rest(const TerrainStage& stage) {
    return stage.pager().settled() && !stage.pager().fading() && !stage.selection().unsettled;
}

}  // namespace ridgeline::app
