// Heights are predicted by the plane through their western, northern and north-western neighbours (the
// gradient predictor of PNG's and LOCO-I's family, without their clamping); residuals go into byte planes and
// through zstd.
#include "ridgeline/io/heights_tile.h"

#include <algorithm>

#include "ridgeline/io/payload_bytes.h"
#include "ridgeline/io/zstd_stream.h"

namespace ridgeline::io {
namespace {

constexpr std::uint8_t kAllValid = 1;
// flags, four bytes of base
constexpr std::size_t kHeaderBytes = 5;

const Error kDamaged{"damaged heights tile"};

std::size_t sample_count(int quads) {
    const auto stride = static_cast<std::size_t>(quads + 1 + 2 * HeightsTile::kApron);
    return stride * stride;
}
std::size_t cell_count(int quads) {
    return static_cast<std::size_t>(quads) * static_cast<std::size_t>(quads);
}

// Unsigned arithmetic wraps, so that any heights survive.
void predict(const HeightsTile& tile, std::uint32_t base, std::vector<std::uint32_t>& residuals) {
    const auto stride = static_cast<std::size_t>(tile.stride());
    const auto height = [&](std::size_t i) { return static_cast<std::uint32_t>(tile.quanta[i]) - base; };
    residuals.resize(stride * stride);
    for (std::size_t row = 0, i = 0; row < stride; ++row)
        for (std::size_t column = 0; column < stride; ++column, ++i) {
            const std::uint32_t west = column > 0 ? height(i - 1) : 0;
            const std::uint32_t north = row > 0 ? height(i - stride) : 0;
            const std::uint32_t both = column > 0 && row > 0 ? height(i - stride - 1) : 0;
            residuals[i] = zigzag(static_cast<std::int32_t>(height(i) - (west + north - both)));
        }
}

void restore(std::span<const std::uint8_t> planes, int plane_count, std::uint32_t base, HeightsTile& tile) {
    const auto stride = static_cast<std::size_t>(tile.stride());
    const std::size_t count = stride * stride;
    for (std::size_t row = 0, i = 0; row < stride; ++row) {
        // The running difference to the row above; in the first row, to the base.
        std::uint32_t rise = 0;
        for (std::size_t column = 0; column < stride; ++column, ++i) {
            rise += static_cast<std::uint32_t>(unzigzag(from_planes(planes, count, plane_count, i)));
            const std::uint32_t above = row > 0 ? static_cast<std::uint32_t>(tile.quanta[i - stride]) : base;
            tile.quanta[i] = static_cast<std::int32_t>(above + rise);
        }
    }
}

}  // namespace

void encode_heights(const HeightsTile& tile, std::vector<std::uint8_t>& payload) {
    RIDGELINE_CHECK(tile.quanta.size() == sample_count(tile.quads));
    thread_local std::vector<std::uint32_t> residuals;
    thread_local std::vector<std::uint8_t> bytes;
    const auto base = static_cast<std::uint32_t>(tile.quanta.front());
    predict(tile, base, residuals);
    const int planes = planes_for(residuals);
    payload.push_back(static_cast<std::uint8_t>((tile.all_valid ? kAllValid : 0) | (planes << 1)));
    for (int byte = 0; byte < 4; ++byte) payload.push_back(static_cast<std::uint8_t>(base >> (8 * byte)));
    bytes.clear();
    put_planes(residuals, planes, bytes);
    if (!tile.all_valid) {
        RIDGELINE_CHECK(tile.sample_valid.size() == tile.quanta.size());
        RIDGELINE_CHECK(tile.cell_valid.size() == cell_count(tile.quads));
        bytes.insert(bytes.end(), tile.sample_valid.begin(), tile.sample_valid.end());
        bytes.insert(bytes.end(), tile.cell_valid.begin(), tile.cell_valid.end());
    }
    compress(bytes, payload);
}

Result<void> decode_heights(std::span<const std::uint8_t> payload, int quads, HeightsTile& tile) {
    if (payload.size() < kHeaderBytes) return kDamaged;
    const int planes = payload[0] >> 1;
    if (planes < 1 || planes > 4) return kDamaged;
    std::uint32_t base = 0;
    for (std::size_t byte = 0; byte < 4; ++byte) base |= std::uint32_t{payload[1 + byte]} << (8 * byte);

    tile.quads = quads;
    tile.all_valid = (payload[0] & kAllValid) != 0;
    const std::size_t samples = sample_count(quads), cells = tile.all_valid ? 0 : cell_count(quads);
    const std::size_t flags = tile.all_valid ? 0 : samples;
    const std::size_t plane_bytes = samples * static_cast<std::size_t>(planes);
    thread_local std::vector<std::uint8_t> bytes;
    bytes.resize(plane_bytes + flags + cells);
    RIDGELINE_TRY(decompress(payload.subspan(kHeaderBytes), bytes));

    tile.quanta.resize(samples);
    restore(bytes, planes, base, tile);
    const auto valid_begin = bytes.begin() + static_cast<std::ptrdiff_t>(plane_bytes);
    const auto cells_begin = valid_begin + static_cast<std::ptrdiff_t>(flags);
    if (std::any_of(valid_begin, bytes.end(), [](std::uint8_t flag) { return flag > 1; })) return kDamaged;
    tile.sample_valid.assign(valid_begin, cells_begin);
    tile.cell_valid.assign(cells_begin, bytes.end());
    return {};
}

}  // namespace ridgeline::io
