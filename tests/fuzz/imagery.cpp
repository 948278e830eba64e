// Imagery payloads: as they stand, or their planes, packed. What decodes must come back from the encoder.
#include <algorithm>
#include <vector>

#include "fuzz/fuzz_body.h"
#include "fuzz/input.h"
#include "ridgeline/io/imagery_tile.h"
#include "ridgeline/io/zstd_stream.h"

namespace ridgeline::fuzz {
namespace {

constexpr std::size_t kEndpointPlanes = 4;
constexpr std::size_t kIndexPlanes = 4;

// A plane repeats what the input has for it.
std::vector<std::uint8_t> plane_of(std::span<const std::uint8_t> pattern, std::size_t size) {
    std::vector<std::uint8_t> plane(size);
    for (std::size_t i = 0; i < size && !pattern.empty(); ++i) plane[i] = pattern[i % pattern.size()];
    return plane;
}

std::vector<std::uint8_t> payload_of(Input& input, Form form) {
    if (form == Form::payload) {
        const auto rest = input.rest();
        return {rest.begin(), rest.end()};
    }
    std::vector<std::uint8_t> payload = {input.byte()};
    for (std::size_t p = 0; p < kEndpointPlanes; ++p)
        io::compress(plane_of(input.take(input.byte()), io::kImageryBlockCount), payload, 1);
    io::compress(plane_of(input.rest(), kIndexPlanes * io::kImageryBlockCount), payload, 1);
    return payload;
}

void use(std::span<const io::Bc1Block> blocks, io::ImageryScratch& scratch) {
    (void)std::any_of(blocks.begin(), blocks.end(), io::has_holes);
    std::vector<std::uint8_t> again;
    io::encode_imagery(blocks, scratch, again);
    std::vector<io::Bc1Block> decoded(blocks.size());
    RIDGELINE_CHECK(io::decode_imagery(again, scratch, std::as_writable_bytes(std::span(decoded))).ok());
    RIDGELINE_CHECK(std::equal(blocks.begin(), blocks.end(), decoded.begin()));
}

}  // namespace

Verdict try_input(std::span<const std::uint8_t> bytes) {
    Input input(bytes);
    const auto payload = payload_of(input, form_of(input.byte()));
    std::vector<io::Bc1Block> blocks(io::kImageryBlockCount);
    io::ImageryScratch scratch;
    if (!io::decode_imagery(payload, scratch, std::as_writable_bytes(std::span(blocks))))
        return Verdict::refused;
    use(blocks, scratch);
    return Verdict::sound;
}

}  // namespace ridgeline::fuzz
