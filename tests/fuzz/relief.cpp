// Reliefs (silhouettes and maxima): as they stand, or their content, packed; decoded with any heights and
// bounds.
#include <array>
#include <vector>

#include "fuzz/fuzz_body.h"
#include "fuzz/tile_setting.h"
#include "ridgeline/base/contract.h"
#include "ridgeline/io/relief_codec.h"
#include "ridgeline/io/zstd_stream.h"

namespace ridgeline::fuzz {
namespace {

// Those that --relief offers, and the least.
constexpr std::array<io::ReliefShape, 4> kShapes = {{{}, {6, 16, 16}, {2, 16, 16}, {2, 2, 2}}};

std::vector<std::uint8_t> payload_of(Input& input, Form form, const io::ReliefShape& shape) {
    if (form == Form::payload) {
        const auto rest = input.rest();
        return {rest.begin(), rest.end()};
    }
    const std::uint8_t planes = input.byte();
    std::vector<std::uint8_t> payload = {planes};
    const auto vertices = static_cast<std::size_t>(shape.chain_vertices());
    const std::size_t size =
        vertices * (planes % 3u + 1u) + static_cast<std::size_t>(shape.cells * shape.cells);
    io::compress(input.content(size), payload, 1);
    return payload;
}

// Whoever uses a chain goes by its places into the node's lattice.
void use(io::ReliefView relief, const io::NodeRecord& record, int quads) {
    for (const io::ReliefAxis axis : {io::ReliefAxis::east, io::ReliefAxis::south})
        for (int band = 0; band < relief.shape().bands; ++band) {
            for (const std::uint8_t across : relief.across(axis, band)) RIDGELINE_CHECK(across <= quads);
            for (const std::uint16_t code : relief.heights(axis, band))
                (void)io::chain_height::quanta(code, record);
        }
    for (const std::uint8_t code : relief.maxima()) (void)io::maximum_quanta(code, record);
}

}  // namespace

Verdict try_input(std::span<const std::uint8_t> bytes) {
    Input input(bytes);
    const std::uint8_t mode = input.byte();
    const io::ReliefShape shape = kShapes[mode / 3 % 4];
    const int quads = 32 << (mode / 12 % 3);
    io::NodeRecord record;
    set_bounds(input, record);
    const io::HeightsTile heights = heights_of(input, quads);
    const auto payload = payload_of(input, form_of(mode), shape);
    // Words for their alignment.
    std::vector<std::uint64_t> block(shape.bytes() / 8 + 1);
    const io::ReliefView relief(std::as_writable_bytes(std::span(block)).first(shape.bytes()), shape);
    if (!io::decode_relief(payload, record, heights, relief)) return Verdict::refused;
    use(relief, record, quads);
    return Verdict::sound;
}

}  // namespace ridgeline::fuzz
