// Writing and reading the small pieces of a payload: varints, bits, byte planes of zigzag numbers.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ridgeline::io {

constexpr std::uint32_t zigzag(std::int32_t v) {
    return (static_cast<std::uint32_t>(v) << 1) ^ static_cast<std::uint32_t>(v >> 31);
}
constexpr std::int32_t unzigzag(std::uint32_t v) {
    return static_cast<std::int32_t>((v >> 1) ^ (~(v & 1) + 1));
}

inline void put_varint(std::uint32_t value, std::vector<std::uint8_t>& out) {
    for (; value >= 0x80; value >>= 7) out.push_back(static_cast<std::uint8_t>(value | 0x80));
    out.push_back(static_cast<std::uint8_t>(value));
}

// Takes the number off the front of `bytes`; nothing where it is cut off or too long.
inline std::optional<std::uint32_t> take_varint(std::span<const std::uint8_t>& bytes) {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
        if (bytes.empty()) return {};
        const std::uint8_t byte = bytes.front();
        bytes = bytes.subspan(1);
        value |= std::uint64_t{byte & 0x7fu} << shift;
        if (byte < 0x80)
            return value > UINT32_MAX ? std::nullopt : std::optional(static_cast<std::uint32_t>(value));
    }
    return {};
}

// The fewest byte planes (1 to 4) that hold every value.
inline int planes_for(std::span<const std::uint32_t> values) {
    std::uint32_t all = 0;
    for (const std::uint32_t v : values) all |= v;
    return all < (1u << 8) ? 1 : all < (1u << 16) ? 2 : all < (1u << 24) ? 3 : 4;
}

// Plane after plane, least significant first: the upper planes are nearly all zero and cost nothing once
// compressed.
inline void put_planes(std::span<const std::uint32_t> values, int planes, std::vector<std::uint8_t>& out) {
    std::size_t at = out.size();
    out.resize(at + values.size() * static_cast<std::size_t>(planes));
    for (int plane = 0; plane < planes; ++plane)
        for (const std::uint32_t v : values) out[at++] = static_cast<std::uint8_t>(v >> (8 * plane));
}

inline std::uint32_t from_planes(std::span<const std::uint8_t> bytes, std::size_t count, int planes,
                                 std::size_t i) {
    std::uint32_t value = 0;
    for (int plane = 0; plane < planes; ++plane)
        value |= std::uint32_t{bytes[static_cast<std::size_t>(plane) * count + i]} << (8 * plane);
    return value;
}

class BitWriter {
  public:
    void clear() { bytes_.clear(), count_ = 0; }
    void put(bool bit) {
        if (count_ % 8 == 0) bytes_.push_back(0);
        bytes_.back() = static_cast<std::uint8_t>(bytes_.back() | (std::uint32_t{bit} << (count_ % 8)));
        ++count_;
    }
    std::size_t count() const { return count_; }
    std::span<const std::uint8_t> bytes() const { return bytes_; }

  private:
    std::vector<std::uint8_t> bytes_;
    std::size_t count_ = 0;
};

// Past its end it gives zeros and remembers that it was asked.
class BitReader {
  public:
    BitReader() = default;
    BitReader(std::span<const std::uint8_t> bytes, std::size_t count) : bytes_(bytes), count_(count) {}
    bool take() {
        const std::size_t at = next_++;
        return at < count_ && ((bytes_[at / 8] >> (at % 8)) & 1) != 0;
    }
    // All bits were taken and no more.
    bool exhausted() const { return next_ == count_; }

  private:
    std::span<const std::uint8_t> bytes_;
    std::size_t count_ = 0;
    std::size_t next_ = 0;
};

}  // namespace ridgeline::io
