#include <doctest/doctest.h>

#include <array>
#include <memory>

#include "jobs_fixture.h"
#include "ridgeline/jobs/job.h"

namespace ridgeline::jobs {
namespace {

using test::Tracked;

TEST_CASE("a job keeps its captures through moves and destroys them once, when run") {
    int sum = 0;
    {
        Job job([&sum, tracked = Tracked(), number = std::make_unique<int>(7)] { sum += *number; });
        Job second(std::move(job));
        Job third;
        third = std::move(second);
        CHECK(!job);  // NOLINT(bugprone-use-after-move): moved-from jobs are empty
        CHECK(third);
        CHECK(Tracked::live() == 1);
        third.run();
        CHECK(Tracked::live() == 0);
        CHECK(!third);
    }
    CHECK(sum == 7);
}

TEST_CASE("a job that is never run destroys its captures, also when another is put in its place") {
    {
        Job job([tracked = Tracked()] {});
        job = Job([tracked = Tracked()] {});
        CHECK(Tracked::live() == 1);
    }
    CHECK(Tracked::live() == 0);
}

TEST_CASE("a job holds captures up to its capacity") {
    std::array<char, Job::kCapacityBytes - sizeof(void*)> bytes{};
    bytes.back() = 5;
    char seen = 0;
    Job job([bytes, &seen] { seen = bytes.back(); });
    Job(std::move(job)).run();
    CHECK(seen == 5);
}

}  // namespace
}  // namespace ridgeline::jobs
