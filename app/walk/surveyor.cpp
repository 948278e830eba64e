#include "ridgeline/app/walk/surveyor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ridgeline/base/contract.h"
#include "ridgeline/base/thread_role.h"

namespace ridgeline::app {
namespace {

// Farther than any terrain is from any eye.
constexpr double kReach_m = 1e9;

}  // namespace

Surveyor::~Surveyor() {
    if (!thread_.joinable()) return;
    newest_.store(kEnd, std::memory_order_release);
    newest_.notify_one();
    thread_.join();
}

void Surveyor::ask(const SurveyQuestion& question) {
    RIDGELINE_CHECK(question.number > 0 && question.number < kEnd);
    questions_.draft() = question;
    questions_.publish();
    newest_.store(question.number, std::memory_order_release);
    newest_.notify_one();
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
}

void Surveyor::run() {
    set_thread_role(ThreadRole::unnamed, "surveyor");
    select::SurfaceQuery surface(store_);
    std::uint64_t heard = 0;
    while (true) {
        newest_.wait(heard, std::memory_order_acquire);
        heard = newest_.load(std::memory_order_acquire);
        if (heard == kEnd) return;
        const SurveyQuestion* question = questions_.take();
        if (question && answer(*question, surface, answers_.draft())) answers_.publish();
    }
}

bool Surveyor::answer(const SurveyQuestion& question, select::SurfaceQuery& surface, SurveyAnswer& answer) {
    answer.number = question.number;
    answer.points_m = {};
    answer.profile.clear();
    answer.failure.clear();
    for (int i = 0; i < question.rays; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const auto hit = surface.ray_cast(question.ray[at].origin_m, question.ray[at].direction, kReach_m);
        if (!hit) {
            answer.failure = hit.error().message;
            return true;
        }
        if (hit->hit) answer.points_m[at] = hit->point_m;
    }
    const bool both = answer.points_m[0] && answer.points_m[1];
    return both ? find_profile(question.number, surface, answer) : !is_stale(question.number);
}

bool Surveyor::find_profile(std::uint64_t number, select::SurfaceQuery& surface, SurveyAnswer& answer) {
    const glm::dvec3 from = *answer.points_m[0], to = *answer.points_m[1];
    const io::TerrainInfo& info = store_.info();
    const std::size_t samples = profile_samples(from, to, std::min(info.spacing_x_m, info.spacing_y_m));
    for (std::size_t i = 0; i < samples; ++i) {
        if (is_stale(number)) return false;
        const double share = static_cast<double>(i) / static_cast<double>(samples - 1);
        const glm::dvec2 place = glm::mix(glm::dvec2(from), glm::dvec2(to), share);
        const auto height = surface.height(place.x, place.y);
        if (!height) {
            answer.failure = height.error().message;
            return true;
        }
        const bool ground = height->kind == select::SurfaceHeight::Kind::ground;
        answer.profile.push_back(ground ? static_cast<float>(height->height_m)
                                        : std::numeric_limits<float>::quiet_NaN());
    }
    return true;
}

}  // namespace ridgeline::app
