#include "ridgeline/stage/horizon_survey.h"

#include <algorithm>
#include <cmath>

#include "ridgeline/select/horizon_profile.h"

namespace ridgeline::stage {
namespace {

// The strip is wider than the picture, so that one sees what comes into it.
constexpr double kWiderThanPicture = 1.3;
constexpr Angle kLeastReach = Angle::from_degrees(30.0);
constexpr Angle kMostReach = Angle::from_degrees(180.0);

class Surveyor {
  public:
    Surveyor(const SurveySources& sources, const SurveyView& view)
        : sources_(sources),
          info_(sources.store.info()),
          grid_(sources.selection.grid()),
          eye_m_(view.camera.pose.eye_m),
          quantum_m_(info_.quantum_m * view.exaggeration) {}

    SceneNode node(const select::NodeReport& report) const {
        SceneNode node;
        node.report = report;
        node.side_m = side_m(report.node.level);
        node.corner_m = {info_.west_m + report.node.x * side(report.node.level).x - eye_m_.x,
                         info_.north_m - report.node.y * side(report.node.level).y - eye_m_.y};
        node.ground = ground(report.node);
        return node;
    }

    float over_eye_m(double quanta) const {
        return static_cast<float>(info_.height_offset_m + quanta * quantum_m_ - eye_m_.z);
    }
    glm::vec2 side_m(int level) const { return side(level); }

  private:
    glm::dvec2 side(int level) const {
        return static_cast<double>(grid_.extent(level)) * glm::dvec2(info_.spacing_x_m, info_.spacing_y_m);
    }
    const io::NodeRecord& record(io::NodeId node) const {
        return sources_.store.records()[static_cast<std::size_t>(grid_.linear(node))];
    }

    // Its own maxima, or its part of those of the nearest ancestor that is in memory.
    SceneGround ground(io::NodeId node) const {
        for (io::NodeId known = node;; known = known.parent()) {
            const io::ChunkView chunk =
                sources_.ground.chunk(static_cast<std::uint32_t>(grid_.linear(known)));
            if (chunk) return part(chunk.relief(), known, node);
            if (known.level == 0) return {};
        }
    }
    SceneGround part(const io::ReliefView& relief, io::NodeId known, io::NodeId node) const {
        const int depth = node.level - known.level, cells = relief.shape().cells;
        const glm::ivec2 at(node.x - (known.x << depth), node.y - (known.y << depth));
        const io::NodeRecord& heights = record(known);
        const double range_m =
            (static_cast<double>(heights.max_quanta) - static_cast<double>(heights.min_quanta)) * quantum_m_;
        return {.codes = relief.maxima(),
                .stride = cells,
                .from = glm::min(at * cells >> depth, glm::ivec2(cells - 1)),
                .cells = std::max(cells >> depth, 1),
                .base_m = over_eye_m(heights.min_quanta),
                .step_m = static_cast<float>(range_m / io::kMostMaximum)};
    }

    const SurveySources& sources_;
    const io::TerrainInfo& info_;
    const io::Grid& grid_;
    glm::dvec3 eye_m_;
    double quantum_m_;
};

void describe_view(const select::Selection& selection, const SurveyView& view, HorizonScene& scene) {
    const glm::dvec2& heading = selection.heading();
    scene.mode = view.mode;
    scene.in_use = selection.uses_horizon();
    scene.heading = Angle::from_radians(std::atan2(heading.x, heading.y));
    scene.pitch = view.camera.pose.pitch;
    scene.half_tangents = platform::half_tangents(view.camera.lens);
    scene.profile_reach =
        std::clamp(view.camera.lens.horizontal_fov * (0.5 * kWiderThanPicture), kLeastReach, kMostReach);
    select::horizon_profile(selection, scene.profile_reach * -1.0, scene.profile_reach, scene.profile);
}

void describe_terrain(const SurveySources& sources, const SurveyView& view, HorizonScene& scene) {
    const io::TerrainInfo& info = sources.store.info();
    const Box box = select::drawn_bounds(info, sources.store.records(), view.exaggeration);
    const glm::dvec3& eye_m = view.camera.pose.eye_m;
    scene.least_m = glm::dvec2(box.min) - glm::dvec2(eye_m);
    scene.most_m = glm::dvec2(box.max) - glm::dvec2(eye_m);
    scene.lowest_m = static_cast<float>(box.min.z - eye_m.z);
    scene.highest_m = static_cast<float>(box.max.z - eye_m.z);
}

}  // namespace

void HorizonSurvey::fill(const SurveySources& sources, const SurveyView& view, HorizonScene& scene) {
    describe_view(sources.selection, view, scene);
    describe_terrain(sources, view, scene);
    const Surveyor surveyor(sources, view);
    scene.finest_side_m = surveyor.side_m(sources.selection.grid().finest()).x;
    scene.nodes.clear();
    scene.counts.fill(0);
    scene.ahead = 0;
    sources.selection.report(reports_);
    for (const select::NodeReport& report : reports_) {
        scene.nodes.push_back(surveyor.node(report));
        const bool ahead = report.fate == select::NodeFate::out_of_view && report.ahead;
        ++(ahead ? scene.ahead : scene.counts[static_cast<std::size_t>(report.fate)]);
    }
}

}  // namespace ridgeline::stage
