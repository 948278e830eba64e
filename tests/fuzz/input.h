// Fuzz inputs as bodies read them: a few small numbers, then bytes. Past the end everything is zero, so that
// every input means something.
//
// Payloads are zstd frames, which a fuzzer hardly ever changes into others; so an input may also hold what
// such a frame unpacks to, and the body packs it: content() has the length that the decoder asks for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ridgeline::fuzz {

class Input {
  public:
    explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    std::uint8_t byte() {
        if (bytes_.empty()) return 0;
        const std::uint8_t first = bytes_.front();
        bytes_ = bytes_.subspan(1);
        return first;
    }
    std::uint32_t word() {
        std::uint32_t value = 0;
        for (int shift = 0; shift < 32; shift += 8) value |= std::uint32_t{byte()} << shift;
        return value;
    }
    std::int32_t signed_word() { return static_cast<std::int32_t>(word()); }
    bool bit() {
        if (bits_left_ == 0) {
            bits_ = byte();
            bits_left_ = 8;
        }
        return (bits_ >> --bits_left_ & 1u) != 0;
    }
    bool empty() const { return bytes_.empty(); }
    // Up to `size` bytes off the front.
    std::span<const std::uint8_t> take(std::size_t size) {
        const auto taken = bytes_.first(size < bytes_.size() ? size : bytes_.size());
        bytes_ = bytes_.subspan(taken.size());
        return taken;
    }
    std::span<const std::uint8_t> rest() { return take(bytes_.size()); }
    // All that is left, cut or filled with zeros to `size`.
    std::vector<std::uint8_t> content(std::size_t size) {
        const auto taken = take(size);
        std::vector<std::uint8_t> filled(taken.begin(), taken.end());
        filled.resize(size);
        return filled;
    }

  private:
    std::span<const std::uint8_t> bytes_;
    std::uint32_t bits_ = 0;
    int bits_left_ = 0;
};

// How an input gives a payload.
enum class Form : std::uint8_t { payload, content, third };
inline Form form_of(std::uint8_t byte) { return static_cast<Form>(byte % 3); }

}  // namespace ridgeline::fuzz
