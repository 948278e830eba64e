// Payload: one byte, the planes of the heights' differences; then one zstd frame of those planes, the
// acrosses' differences and the maxima's, a byte each.
#include "ridgeline/io/relief_codec.h"

#include "ridgeline/io/payload_bytes.h"
#include "ridgeline/io/relief_lattice.h"
#include "ridgeline/io/zstd_stream.h"

namespace ridgeline::io {
namespace {

const Error kDamaged{"damaged mesh tile: its relief does not unpack"};

struct Scratch {
    std::vector<std::uint32_t> symbols;
    std::vector<std::uint8_t> bytes;
    std::vector<std::int32_t> row, maxima;
};
thread_local Scratch scratch;

// The height step at which a chain's vertex is expected: that of the sample there.
int expected_step(ReliefAxis axis, int along, int across, const HeightSteps& steps,
                  const HeightsTile& heights) {
    const std::size_t at = axis == ReliefAxis::east ? heights.at(along, across) : heights.at(across, along);
    return steps.below(heights.quanta[at]);
}

// 0: hides nothing.
std::uint32_t height_symbol(std::uint16_t code, int expected) {
    return code == chain_height::kHidesNothing ? 0 : 1 + zigzag(expected - chain_step::of(code));
}

template <class Visit>
void for_each_chain(const ReliefShape& shape, Visit&& visit) {
    for (const ReliefAxis axis : {ReliefAxis::east, ReliefAxis::south})
        for (int band = 0; band < shape.bands; ++band) visit(axis, band);
}

// The codes at which the cells' maxima are expected: those of their greatest samples.
void expect_maxima(const ReliefShape& shape, const NodeRecord& record, const HeightsTile& heights) {
    greatest_by_cell(shape, heights.quads, &heights.quanta[heights.at(0, 0)], heights.stride(), scratch.row,
                     scratch.maxima);
    const HeightSteps steps(record, kMostMaximum);
    for (std::int32_t& quanta : scratch.maxima) quanta = steps.below(quanta);
}

struct Streams {
    int planes = 0;
    std::span<const std::uint8_t> heights, acrosses, maxima;
};

Result<Streams> unpack(std::span<const std::uint8_t> payload, const ReliefShape& shape) {
    if (payload.empty()) return kDamaged;
    Streams streams;
    streams.planes = payload.front();
    if (streams.planes < 1 || streams.planes > 2) return kDamaged;
    const auto vertices = static_cast<std::size_t>(shape.chain_vertices());
    const std::size_t height_bytes = vertices * static_cast<std::size_t>(streams.planes);
    scratch.bytes.resize(height_bytes + vertices + static_cast<std::size_t>(shape.cells * shape.cells));
    RIDGELINE_TRY(decompress(payload.subspan(1), scratch.bytes));
    const std::span<const std::uint8_t> bytes = scratch.bytes;
    streams.heights = bytes.first(height_bytes);
    streams.acrosses = bytes.subspan(height_bytes, vertices);
    streams.maxima = bytes.subspan(height_bytes + vertices);
    return streams;
}

bool decode_chain(const Streams& streams, ReliefAxis axis, int band, const HeightSteps& steps,
                  const HeightsTile& heights, ReliefView relief) {
    const ReliefShape& shape = relief.shape();
    const auto codes = relief.heights(axis, band);
    const auto acrosses = relief.across(axis, band);
    const LatticeRange places = band_range(shape, heights.quads, band);
    const auto vertices = static_cast<std::size_t>(shape.chain_vertices());
    std::size_t at = static_cast<std::size_t>(static_cast<int>(axis) * shape.bands + band) * codes.size();
    int across = places.first;
    for (int i = 0; i <= shape.steps; ++i, ++at) {
        across += unzigzag(streams.acrosses[at]);
        if (across < places.first || across > places.last) return false;
        acrosses[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(across);
        const std::uint32_t symbol = from_planes(streams.heights, vertices, streams.planes, at);
        std::uint16_t& code = codes[static_cast<std::size_t>(i)];
        code = chain_height::kHidesNothing;
        if (symbol == 0) continue;
        const int along = i * (heights.quads / shape.steps);
        const int step = expected_step(axis, along, across, steps, heights) - unzigzag(symbol - 1);
        if (step < 0 || step > chain_step::kMost) return false;
        code = chain_step::code(step);
    }
    return true;
}

}  // namespace

void encode_relief(ReliefView relief, const NodeRecord& record, const HeightsTile& heights,
                   std::vector<std::uint8_t>& payload) {
    const ReliefShape& shape = relief.shape();
    const HeightSteps steps(record, chain_step::kSteps);
    scratch.symbols.clear();
    for_each_chain(shape, [&](ReliefAxis axis, int band) {
        for (int i = 0; i <= shape.steps; ++i) {
            const auto at = static_cast<std::size_t>(i);
            const int along = i * (heights.quads / shape.steps);
            const int expected = expected_step(axis, along, relief.across(axis, band)[at], steps, heights);
            scratch.symbols.push_back(height_symbol(relief.heights(axis, band)[at], expected));
        }
    });
    const int planes = planes_for(scratch.symbols);
    scratch.bytes.clear();
    put_planes(scratch.symbols, planes, scratch.bytes);
    for_each_chain(shape, [&](ReliefAxis axis, int band) {
        int last = band_range(shape, heights.quads, band).first;
        for (const std::uint8_t across : relief.across(axis, band)) {
            scratch.bytes.push_back(static_cast<std::uint8_t>(zigzag(across - last)));
            last = across;
        }
    });
    expect_maxima(shape, record, heights);
    for (std::size_t cell = 0; cell < scratch.maxima.size(); ++cell) {
        const auto difference = static_cast<std::int8_t>(relief.maxima()[cell] - scratch.maxima[cell]);
        scratch.bytes.push_back(static_cast<std::uint8_t>(zigzag(difference)));
    }
    payload.push_back(static_cast<std::uint8_t>(planes));
    compress(scratch.bytes, payload);
}

Result<void> decode_relief(std::span<const std::uint8_t> payload, const NodeRecord& record,
                           const HeightsTile& heights, ReliefView relief) {
    const ReliefShape& shape = relief.shape();
    const auto streams = unpack(payload, shape);
    if (!streams) return streams.error();
    const HeightSteps steps(record, chain_step::kSteps);
    bool sound = true;
    for_each_chain(shape, [&](ReliefAxis axis, int band) {
        sound = sound && decode_chain(*streams, axis, band, steps, heights, relief);
    });
    if (!sound) return kDamaged;
    expect_maxima(shape, record, heights);
    for (std::size_t cell = 0; cell < scratch.maxima.size(); ++cell) {
        const std::int32_t difference = unzigzag(streams->maxima[cell]);
        relief.maxima()[cell] = static_cast<std::uint8_t>(scratch.maxima[cell] + difference);
    }
    return {};
}

}  // namespace ridgeline::io
