#include "ridgeline/io/layer_order.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace ridgeline::io {
namespace {

// Neighbours in the scratch file are mostly neighbours in the final one, so copies go through a buffer.
constexpr std::size_t kCopyBytes = 4u << 20;

}  // namespace

std::vector<NodeId> hilbert_order(const Grid& grid, int level) {
    const auto longer = static_cast<unsigned>(std::max(grid.nodes_x(level), grid.nodes_y(level)));
    const int order = std::bit_width(longer - 1);
    std::vector<std::pair<std::uint64_t, NodeId>> keyed;
    for (std::int32_t y = 0; y < grid.nodes_y(level); ++y)
        for (std::int32_t x = 0; x < grid.nodes_x(level); ++x)
            keyed.push_back({hilbert_index(x, y, order), {level, x, y}});
    std::sort(keyed.begin(), keyed.end());
    std::vector<NodeId> nodes;
    for (const auto& [key, node] : keyed) nodes.push_back(node);
    return nodes;
}

Result<std::uint64_t> copy_in_order(const LayerCopy& copy, const std::filesystem::path& path) {
    auto file = OutputFile::create(path);
    if (!file) return file.error();
    std::vector<std::byte> buffer;
    std::uint64_t end = 0;
    std::int64_t copied = 0;
    const auto flush = [&]() -> Result<void> {
        const auto written = file->append(buffer);
        buffer.clear();
        if (!written) return written.error();
        file->start_sync();
        if (copy.progress && !copy.progress(std::exchange(copied, 0))) return Error{"stopped"};
        return {};
    };
    for (int level = 0; level < copy.grid.levels(); ++level)
        for (const NodeId node : hilbert_order(copy.grid, level)) {
            const WaitingPayload payload = copy.payload(node);
            if (payload.size == 0) continue;
            const std::size_t before = buffer.size();
            buffer.resize(before + payload.size);
            RIDGELINE_TRY(copy.waiting.read_at(*payload.offset, std::span(buffer).subspan(before)));
            *payload.offset = end;
            end += payload.size;
            ++copied;
            if (buffer.size() >= kCopyBytes) RIDGELINE_TRY(flush());
        }
    RIDGELINE_TRY(flush());
    RIDGELINE_TRY(file->sync());
    return end;
}

Result<void> write_file(const std::filesystem::path& path, std::span<const std::byte> head,
                        std::span<const std::byte> body) {
    auto file = OutputFile::create(path);
    if (!file) return file.error();
    for (const auto& part : {head, body})
        if (const auto written = file->append(part); !written) return written.error();
    return file->sync();
}

}  // namespace ridgeline::io
