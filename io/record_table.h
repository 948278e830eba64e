// A file of fixed-size records behind a header of 32 bytes (nodes.bin, imagery.bin), checked as a whole.
#pragma once

#include <xxhash.h>

#include <cstdint>
#include <cstring>
#include <span>

#include "ridgeline/base/result.h"

namespace ridgeline::io {

// The records of a mapped file, of which there must be `count`. The header's default value says what it must
// be; records are as aligned as the map, which begins on a page.
template <class Record, class Header>
Result<std::span<const Record>> checked_records(std::span<const std::byte> file, std::uint64_t count) {
    static_assert(sizeof(Header) % alignof(Record) == 0);
    Header header;
    const Header expected;
    if (file.size() < sizeof header) return Error{"cut off"};
    std::memcpy(&header, file.data(), sizeof header);
    if (std::memcmp(header.magic, expected.magic, sizeof header.magic) != 0) return Error{"not a node table"};
    if (header.reserved != 0) return Error{"its header is damaged"};
    if (header.record_bytes != sizeof(Record) || header.record_count != count)
        return Error{"does not fit terrain.json"};
    const auto records = file.subspan(sizeof header);
    if (records.size() != count * sizeof(Record)) return Error{"cut off or too long"};
    if (XXH3_64bits(records.data(), records.size()) != header.checksum)
        return Error{"checksum does not match"};
    return std::span(reinterpret_cast<const Record*>(records.data()), count);
}

template <class Header>
Header header_of(std::span<const std::byte> records, std::uint64_t count) {
    Header header;
    header.record_count = count;
    header.checksum = XXH3_64bits(records.data(), records.size());
    return header;
}

}  // namespace ridgeline::io
