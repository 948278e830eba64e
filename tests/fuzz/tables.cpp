// Tables of records (nodes.bin, imagery.bin): as they stand, and with a header that fits the records.
#include <algorithm>
#include <cstring>
#include <vector>

#include "fuzz/fuzz_body.h"
#include "fuzz/input.h"
#include "ridgeline/io/chunk.h"
#include "ridgeline/io/imagery_record.h"
#include "ridgeline/io/record_table.h"
#include "ridgeline/io/store.h"

namespace ridgeline::fuzz {
namespace {

// Aligned as a mapped file is.
std::vector<std::uint64_t> aligned(std::span<const std::uint8_t> bytes) {
    std::vector<std::uint64_t> words((bytes.size() + 7) / 8);
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<std::uint8_t*>(words.data()));
    return words;
}

void use(std::span<const io::NodeRecord> records) {
    for (const io::NodeRecord& record : records)
        if (record.vertex_count <= io::kMaxChunkVertices && record.index_count <= 16 * io::kMaxChunkVertices)
            RIDGELINE_CHECK(io::chunk_layout(record, {}).total > 0);
}
void use(std::span<const io::ImageryRecord> records) {
    for (const io::ImageryRecord& record : records) RIDGELINE_CHECK(record.payload().size == record.size);
}

template <class Record, class Header>
Verdict try_table(std::span<const std::byte> file, std::uint64_t count) {
    const auto table = io::checked_records<Record, Header>(file, count);
    if (!table) return Verdict::refused;
    RIDGELINE_CHECK(table->size() == count && table->size_bytes() + sizeof(Header) == file.size());
    use(*table);
    return Verdict::sound;
}

template <class Record, class Header>
Verdict try_both(std::span<const std::uint8_t> bytes, std::uint64_t count) {
    auto words = aligned(bytes);
    const auto file = std::as_writable_bytes(std::span(words)).first(bytes.size());
    const Verdict as_it_stands = try_table<Record, Header>(file, count);
    if (file.size() < sizeof(Header)) return as_it_stands;
    const auto records = file.subspan(sizeof(Header));
    const Header header = io::header_of<Header>(records, records.size() / sizeof(Record));
    std::memcpy(file.data(), &header, sizeof header);
    (void)try_table<Record, Header>(file, header.record_count);
    return as_it_stands;
}

}  // namespace

Verdict try_input(std::span<const std::uint8_t> bytes) {
    Input input(bytes);
    const bool imagery = (input.byte() & 1) != 0;
    const std::uint64_t count = input.word();
    const auto file = input.rest();
    return imagery ? try_both<io::ImageryRecord, io::ImageryHeader>(file, count)
                   : try_both<io::NodeRecord, io::NodesHeader>(file, count);
}

}  // namespace ridgeline::fuzz
