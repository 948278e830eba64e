// Heights payloads: as they stand, or their content, packed. What decodes must come back from the encoder, and
// go into a texture.
#include <vector>

#include "fuzz/fuzz_body.h"
#include "fuzz/input.h"
#include "ridgeline/io/heights_tile.h"
#include "ridgeline/io/zstd_stream.h"
#include "ridgeline/pager/heights_texels.h"

namespace ridgeline::fuzz {
namespace {

std::size_t content_bytes(std::uint8_t flags, int quads) {
    const auto stride = static_cast<std::size_t>(quads + 1 + 2 * io::HeightsTile::kApron);
    const auto side = static_cast<std::size_t>(quads);
    const std::size_t planes = flags >> 1 & 7u;
    return planes * stride * stride + ((flags & 1u) != 0 ? 0 : stride * stride + side * side);
}

std::vector<std::uint8_t> payload_of(Input& input, Form form, int quads) {
    if (form == Form::payload) {
        const auto rest = input.rest();
        return {rest.begin(), rest.end()};
    }
    std::vector<std::uint8_t> payload = {input.byte()};
    for (int i = 0; i < 4; ++i) payload.push_back(input.byte());
    io::compress(input.content(content_bytes(payload.front(), quads)), payload, 1);
    return payload;
}

bool same(const io::HeightsTile& a, const io::HeightsTile& b) {
    return a.quads == b.quads && a.all_valid == b.all_valid && a.quanta == b.quanta &&
           a.sample_valid == b.sample_valid && a.cell_valid == b.cell_valid;
}

void use(const io::HeightsTile& tile) {
    std::vector<std::uint8_t> again;
    io::encode_heights(tile, again);
    io::HeightsTile decoded;
    RIDGELINE_CHECK(io::decode_heights(again, tile.quads, decoded).ok() && same(tile, decoded));
    std::vector<std::byte> texels(pager::heights_texels_bytes(tile.quads));
    for (const auto filter : {pager::HeightsFilter::none, pager::HeightsFilter::twice_spacing})
        pager::pack_heights(tile, filter, texels);
}

}  // namespace

Verdict try_input(std::span<const std::uint8_t> bytes) {
    Input input(bytes);
    const std::uint8_t mode = input.byte();
    const int quads = 32 << (mode / 3 % 3);
    const auto payload = payload_of(input, form_of(mode), quads);
    io::HeightsTile tile;
    if (!io::decode_heights(payload, quads, tile)) return Verdict::refused;
    use(tile);
    return Verdict::sound;
}

}  // namespace ridgeline::fuzz
