#include "ridgeline/jobs/queue.h"

#include <doctest/doctest.h>

#include <chrono>
#include <memory>
#include <thread>
#include <vector>

namespace ridgeline::jobs {
namespace {

using std::chrono::hours;
using std::chrono::microseconds;

struct Parcel {
    int sender = 0;
    int number = 0;
};

TEST_CASE("messages of each sender arrive once and in its order, received with and without sleep") {
    constexpr int kSenders = 3;
    constexpr int kMessages = 5000;
    Queue<std::unique_ptr<Parcel>> queue(256);
    std::vector<std::thread> senders;
    for (int sender = 0; sender < kSenders; ++sender) {
        senders.emplace_back([out = queue.sender(), sender]() mutable {
            for (int number = 0; number < kMessages; ++number)
                out.send(std::make_unique<Parcel>(Parcel{sender, number}));
        });
    }
    auto in = queue.receiver();
    std::vector<int> next(kSenders);
    bool in_order = true;
    std::unique_ptr<Parcel> parcel;
    for (int received = 0; received < kSenders * kMessages;) {
        if (!(received % 3 == 0 ? in.receive_for(parcel, hours(1)) : in.receive(parcel))) continue;
        in_order = in_order && parcel->number == next[static_cast<std::size_t>(parcel->sender)]++;
        ++received;
    }
    for (auto& sender : senders) sender.join();
    CHECK(in_order);
    CHECK(!in.receive(parcel));
    CHECK(queue.size_approx() == 0);
}

TEST_CASE("a sleeping receiver is ended by a message, each time") {
    Queue<int> there;
    Queue<int> back;
    constexpr int kRounds = 3000;
    std::thread echo([in = there.receiver(), out = back.sender()]() mutable {
        for (int message = 0; message != kRounds;) {
            if (in.receive_for(message, hours(1))) out.send(message);
        }
    });
    int echoed = 0;
    bool right = true;
    for (int round = 1; round <= kRounds; ++round) {
        there.sender().send(round);
        while (!back.receiver().receive_for(echoed, hours(1))) {
        }
        right = right && echoed == round;
    }
    echo.join();
    CHECK(right);
}

TEST_CASE("wake() ends the current or the next sleep, once, without a message") {
    Queue<int> queue;
    auto in = queue.receiver();
    int message = 0;
    queue.sender().wake();
    queue.sender().wake();
    // An hour's sleep, were it not for the wake.
    CHECK(!in.receive_for(message, hours(1)));
    // Nothing is left of it: only the time-out ends this one.
    CHECK(!in.receive_for(message, microseconds(1)));

    std::thread waker([out = queue.sender()]() mutable { out.wake(); });
    CHECK(!in.receive_for(message, hours(1)));
    waker.join();
}

TEST_CASE("a message is received although a wake came first") {
    Queue<int> queue;
    int message = 0;
    queue.sender().wake();
    queue.sender().send(4);
    CHECK(queue.receiver().receive_for(message, hours(1)));
    CHECK(message == 4);
}

TEST_CASE("wakes, messages and time-outs at once lose neither message nor wake") {
    constexpr int kMessages = 4000;
    Queue<int> queue;
    std::thread sender([out = queue.sender()]() mutable {
        for (int number = 0; number < kMessages; ++number) {
            out.send(number);
            if (number % 3 == 0) out.wake();
        }
        out.wake();
    });
    auto in = queue.receiver();
    int message = 0;
    int expected = 0;
    for (int round = 0; expected < kMessages; ++round) {
        if (in.receive_for(message, round % 2 == 0 ? microseconds(1) : microseconds(hours(1)))) {
            REQUIRE(message == expected);
            ++expected;
        }
    }
    sender.join();
}

}  // namespace
}  // namespace ridgeline::jobs
