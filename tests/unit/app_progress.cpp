// Progress says how far, how fast and how long still, and says nothing when it should not.
#include "ridgeline/app/progress.h"

#include <doctest/doctest.h>

#include <thread>
#include <vector>

using namespace ridgeline::app;
using namespace std::chrono_literals;

TEST_CASE("progress is a share, a rate and a time left") {
    CHECK(progress_text(0, 100, 0s, "rows") == "0 %");
    CHECK(progress_text(0, 100, 5s, "rows") == "0 %");
    CHECK(progress_text(50, 100, 5s, "rows") == "50 %, 10.0 rows/s, 0:05 left");
    CHECK(progress_text(100, 100, 5s, "rows") == "100 %, 20.0 rows/s");
    CHECK(progress_text(25'000'000, 100'000'000, 2s, "samples") == "25 %, 12.5 M samples/s, 0:06 left");
    CHECK(progress_text(1, 7201, 1s, "rows") == "0 %, 1.0 rows/s, 2:00:00 left");
}

TEST_CASE("reports from several threads at once are safe, also of nothing") {
    Progress progress("testing", "things", Progress::Style::silent);
    Progress lines("testing", "things", Progress::Style::lines);
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            for (int i = 0; i <= 1000; ++i) {
                progress.report(i, 1000);
                lines.report({i % 2 ? "odd" : "even", "things"}, i, i % 3 ? 1000 : 0);
            }
        });
    for (std::thread& thread : threads) thread.join();
    CHECK(Progress::style(true) == Progress::Style::silent);
}
