#include "ridgeline/pager/fault.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string>

namespace ridgeline::pager {
namespace {

// What a part of the text may say, and whether it has been said.
struct Part {
    const char* key;
    Result<void> (*set)(FaultSpec& spec, std::string_view value);
};

Error wrong(std::string_view part, const char* why) { return Error{std::string(part) + ": " + why}; }

template <class T>
bool parse_number(std::string_view text, T& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size();
}

Result<void> set_delay(FaultSpec& spec, std::string_view value) {
    constexpr const char* kWhy = "give a time up to an hour, as delay=50ms or delay=2s";
    double unit_us = 0.0;
    if (value.ends_with("us")) {
        unit_us = 1.0;
        value.remove_suffix(2);
    } else if (value.ends_with("ms")) {
        unit_us = 1e3;
        value.remove_suffix(2);
    } else if (value.ends_with("s")) {
        unit_us = 1e6;
        value.remove_suffix(1);
    }
    double number = 0.0;
    if (unit_us == 0.0 || !parse_number(value, number) || !(number >= 0.0) || number * unit_us > 3600e6)
        return Error{kWhy};
    spec.delay = std::chrono::microseconds(std::llround(number * unit_us));
    return {};
}

template <double FaultSpec::*field>
Result<void> set_probability(FaultSpec& spec, std::string_view value) {
    double number = 0.0;
    if (!parse_number(value, number) || !(number >= 0.0 && number <= 1.0))
        return Error{"give a probability from 0 to 1"};
    spec.*field = number;
    return {};
}

Result<void> set_seed(FaultSpec& spec, std::string_view value) {
    if (!parse_number(value, spec.seed)) return Error{"give a whole number"};
    return {};
}

Result<void> set_until(FaultSpec& spec, std::string_view value) {
    if (!parse_number(value, spec.until_frame)) return Error{"give the number of a frame"};
    return {};
}

constexpr Part kParts[] = {
    {"delay", set_delay},
    {"error", set_probability<&FaultSpec::error>},
    {"short-read", set_probability<&FaultSpec::short_read>},
    {"corrupt", set_probability<&FaultSpec::corrupt>},
    {"seed", set_seed},
    {"until", set_until},
};

Result<void> parse_part(std::string_view text, FaultSpec& spec, unsigned& seen) {
    const std::string_view key = text.substr(0, text.find('='));
    const std::string_view value =
        key.size() < text.size() ? text.substr(key.size() + 1) : std::string_view();
    for (std::size_t i = 0; i < std::size(kParts); ++i) {
        if (key != kParts[i].key) continue;
        if (seen & (1u << i)) return wrong(text, "given twice");
        seen |= 1u << i;
        const auto set = kParts[i].set(spec, value);
        return set ? Result<void>() : wrong(text, set.error().message.c_str());
    }
    return wrong(text, "unknown: delay, error, short-read, corrupt, seed and until are known");
}

// Steele, Lea, Flood: "Fast splittable pseudorandom number generators" (2014); any of its outputs by its
// place.
std::uint64_t splitmix64(std::uint64_t state) {
    state += 0x9e3779b97f4a7c15ULL;
    state = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9ULL;
    state = (state ^ (state >> 27)) * 0x94d049bb133111ebULL;
    return state ^ (state >> 31);
}

// The dice of one read.
class Dice {
  public:
    Dice(std::uint64_t seed, std::uint64_t read) : state_(splitmix64(seed) ^ splitmix64(~read)) {}
    std::uint64_t number() { return state_ = splitmix64(state_); }
    bool happens(double probability) { return static_cast<double>(number() >> 11) * 0x1p-53 < probability; }

  private:
    std::uint64_t state_;
};

}  // namespace

Result<FaultSpec> parse_fault(std::string_view text) {
    FaultSpec spec;
    unsigned seen = 0;
    while (!text.empty()) {
        const std::string_view part = text.substr(0, text.find(','));
        if (auto parsed = parse_part(part, spec, seen); !parsed) return parsed.error();
        text.remove_prefix(std::min(text.size(), part.size() + 1));
    }
    return spec;
}

bool Interrupt::sleep_for(std::chrono::microseconds duration) {
    const auto end = std::chrono::steady_clock::now() + duration;
    MutexLock lock(mutex_);
    while (!interrupted_ && std::chrono::steady_clock::now() < end) wake_.wait_until(mutex_, end);
    return !interrupted_;
}

void Interrupt::interrupt() {
    {
        MutexLock lock(mutex_);
        interrupted_ = true;
    }
    wake_.notify_all();
}

Result<void> FaultySource::read(std::uint64_t offset, std::span<std::uint8_t> bytes) {
    Dice dice(spec_.seed, reads_.fetch_add(1, std::memory_order_relaxed));
    const bool fails = dice.happens(spec_.error);
    const bool stops_short = dice.happens(spec_.short_read);
    const bool corrupts = dice.happens(spec_.corrupt);
    const bool sound = frame_.load(std::memory_order_relaxed) >= spec_.until_frame;
    if (!interrupt_.sleep_for(sound ? std::chrono::microseconds(0) : spec_.delay))
        return Error{"read interrupted"};
    if (sound) return source_.read(offset, bytes);
    if (fails) return Error{"injected read error"};
    if (stops_short) {
        RIDGELINE_TRY(source_.read(offset, bytes.first(dice.number() % (bytes.size() + 1))));
        return Error{"injected short read"};
    }
    RIDGELINE_TRY(source_.read(offset, bytes));
    if (corrupts && !bytes.empty())
        bytes[dice.number() % bytes.size()] ^= static_cast<std::uint8_t>(1 + dice.number() % 255);
    return {};
}

}  // namespace ridgeline::pager
