// Looks at the ground for the one who measures: where rays meet the finest level of the store, and the
// heights between two such points.
//
// That takes reads, so it has a thread of its own, which starts with the first question and ends with the
// object. The newest question wins; its answer comes some frames later. ask() and take() are the render
// thread's and never wait. The store outlives the surveyor.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>

#include "ridgeline/app/walk/measure.h"
#include "ridgeline/io/store.h"
#include "ridgeline/jobs/mailbox.h"
#include "ridgeline/select/surface_query.h"

namespace ridgeline::app {

struct SurveyQuestion {
    std::uint64_t number = 0;
    int rays = 1;  // one, or two with what lies between
    std::array<GroundRay, 2> ray{};
};

struct SurveyAnswer {
    std::uint64_t number = 0;  // of the question
    std::array<std::optional<glm::dvec3>, 2> points_m{};
    HeightProfile profile;  // where both rays met the ground
    std::string failure;    // empty: none
};

class Surveyor {
  public:
    explicit Surveyor(const io::Store& store) : store_(store) {}
    ~Surveyor();
    Surveyor(const Surveyor&) = delete;
    Surveyor& operator=(const Surveyor&) = delete;

    void ask(const SurveyQuestion& question);
    // Null when no answer came since the last call; else it stays until the next one.
    const SurveyAnswer* take() { return answers_.take(); }

  private:
    void run();
    // False when a newer question or the end came first.
    bool answer(const SurveyQuestion& question, select::SurfaceQuery& surface, SurveyAnswer& answer);
    bool is_stale(std::uint64_t number) const { return newest_.load(std::memory_order_acquire) != number; }
    bool find_profile(std::uint64_t number, select::SurfaceQuery& surface, SurveyAnswer& answer);

    const io::Store& store_;
    jobs::Mailbox<SurveyQuestion> questions_;
    jobs::Mailbox<SurveyAnswer> answers_;
    // The number of the newest question, on which the thread sleeps; kEnd: no more will come.
    static constexpr std::uint64_t kEnd = ~std::uint64_t{0};
    std::atomic<std::uint64_t> newest_{0};
    std::thread thread_;
};

}  // namespace ridgeline::app
