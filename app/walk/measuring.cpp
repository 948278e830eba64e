#include "ridgeline/app/walk/measuring.h"

#include "ridgeline/base/log.h"

namespace ridgeline::app {

void Measuring::add(const GroundRay& ray) {
    if (question_.rays == 2) clear();
    question_.ray[static_cast<std::size_t>(question_.rays++)] = ray;
    ++question_.number;
    surveyor_.ask(question_);
}

// Answers to what was asked before are for nobody.
void Measuring::clear() {
    if (empty()) return;
    question_.rays = 0;
    ++question_.number;
    answer_.reset();
}

const char* Measuring::listen() {
    const SurveyAnswer* found = surveyor_.take();
    if (!found || found->number != question_.number) return nullptr;
    const auto newest = static_cast<std::size_t>(question_.rays - 1);
    if (!found->failure.empty()) {
        log_line(LogLevel::warn, "measuring: " + found->failure);
        clear();
        return "the ground there cannot be read";
    }
    if (!found->points_m[newest]) {
        // What was measured before stays.
        --question_.rays;
        return "no ground there";
    }
    answer_ = *found;
    for (std::size_t i = 0; i < scene_.degrees.size(); ++i) {
        const auto& point = found->points_m[i];
        scene_.degrees[i] = point ? places_.degrees(glm::dvec2(*point)) : std::nullopt;
    }
    return nullptr;
}

const MeasureScene* Measuring::scene(const platform::Camera& camera, const VerticalScale& scale) {
    if (!answer_) return nullptr;
    scene_.camera = camera;
    scene_.scale = scale;
    scene_.points_m = answer_->points_m;
    scene_.profile = answer_->profile;
    return &scene_;
}

}  // namespace ridgeline::app
