#include "ridgeline/jobs/mailbox.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace ridgeline::jobs {
namespace {

TEST_CASE("an empty mailbox yields nothing, and a message is taken once") {
    Mailbox<int> mailbox;
    CHECK(mailbox.take() == nullptr);
    mailbox.draft() = 3;
    CHECK(mailbox.take() == nullptr);
    mailbox.publish();
    int* const taken = mailbox.take();
    REQUIRE(taken != nullptr);
    CHECK(*taken == 3);
    CHECK(mailbox.take() == nullptr);
    CHECK(*taken == 3);
}

TEST_CASE("the newest message wins, and what was taken stays as it was while more are published") {
    Mailbox<int> mailbox;
    const auto publish = [&mailbox](int message) {
        mailbox.draft() = message;
        mailbox.publish();
    };
    publish(1);
    publish(2);
    const int* const taken = mailbox.take();
    REQUIRE(taken != nullptr);
    CHECK(*taken == 2);
    for (int message = 3; message < 10; ++message) publish(message);
    CHECK(*taken == 2);
    CHECK(*mailbox.take() == 9);
}

TEST_CASE("values are reused: a vector keeps its capacity") {
    Mailbox<std::vector<int>> mailbox;
    for (int round = 0; round < 3; ++round) {
        mailbox.draft().assign(100, round);
        mailbox.publish();
        mailbox.take();
    }
    CHECK(mailbox.draft().capacity() >= 100);
}

TEST_CASE("across threads messages arrive whole, in order, and the last one always") {
    struct Message {
        std::int64_t number = 0;
        std::int64_t copies[30] = {};
    };
    constexpr std::int64_t kMessages = 50'000;
    Mailbox<Message> mailbox;
    std::thread producer([&mailbox] {
        for (std::int64_t number = 1; number <= kMessages; ++number) {
            Message& draft = mailbox.draft();
            draft.number = number;
            for (auto& copy : draft.copies) copy = number;
            mailbox.publish();
        }
    });
    std::int64_t last = 0;
    bool whole = true;
    bool in_order = true;
    while (last < kMessages) {
        const Message* const taken = mailbox.take();
        if (!taken) continue;
        in_order = in_order && taken->number > last;
        last = taken->number;
        for (const auto copy : taken->copies) whole = whole && copy == last;
    }
    producer.join();
    CHECK(whole);
    CHECK(in_order);
}

}  // namespace
}  // namespace ridgeline::jobs
