#include "ridgeline/io/imagery_writer.h"

#include <utility>

#include "ridgeline/io/layer_order.h"
#include "ridgeline/io/record_table.h"
#include "ridgeline/io/store.h"

namespace ridgeline::io {

ImageryWriter::ImageryWriter(std::filesystem::path directory, OutputFile waiting, const Grid& grid)
    : directory_(std::move(directory)),
      waiting_(std::move(waiting)),
      grid_(grid),
      records_(static_cast<std::size_t>(grid.node_count())) {}

Result<ImageryWriter> ImageryWriter::create(const std::filesystem::path& directory,
                                            const std::filesystem::path& scratch, const Grid& grid) {
    auto waiting = OutputFile::create(scratch / layer_file(Layer::imagery));
    if (!waiting) return waiting.error();
    return ImageryWriter(directory, std::move(*waiting), grid);
}

Result<void> ImageryWriter::put(NodeId node, std::span<const std::uint8_t> payload, Holes holes) {
    ImageryRecord& own = record(node);
    RIDGELINE_CHECK(own.size == 0 && !payload.empty());
    const auto offset = waiting_.append(std::as_bytes(payload));
    if (!offset) return offset.error();
    own.offset = *offset;
    own.checksum = payload_checksum(payload);
    own.size = static_cast<std::uint32_t>(payload.size());
    own.flags = ImageryRecord::kHasData | (holes == Holes::some ? ImageryRecord::kHasHoles : 0u);
    ++tiles_;
    return {};
}

Result<void> ImageryWriter::finish(ImageryInfo& info, const Progress& progress) {
    std::int64_t done = 0;
    LayerCopy copy{grid_, waiting_,
                   [this](NodeId node) {
                       ImageryRecord& own = record(node);
                       return WaitingPayload{&own.offset, own.size};
                   },
                   [&](std::int64_t copied) { return !progress || progress(done += copied, tiles_); }};
    const auto bytes = copy_in_order(copy, directory_ / layer_file(Layer::imagery));
    if (!bytes) return bytes.error();
    info.tiles = tiles_;
    info.bytes = static_cast<std::int64_t>(*bytes);
    const auto records = std::as_bytes(std::span(records_));
    const auto header = header_of<ImageryHeader>(records, records_.size());
    return write_file(directory_ / kImageryTable, std::as_bytes(std::span(&header, 1)), records);
}

}  // namespace ridgeline::io
