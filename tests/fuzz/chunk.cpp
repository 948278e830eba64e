// Mesh payloads: as they stand; their content, packed; or what the encoder makes of a vertex set that the input
// answers for, which must decode. Records are fitted to the mesh, as damage does that somebody sealed.
#include <vector>

#include "fuzz/fuzz_body.h"
#include "fuzz/tile_setting.h"
#include "ridgeline/io/chunk_state.h"
#include "ridgeline/io/relief_codec.h"
#include "ridgeline/io/zstd_stream.h"

namespace ridgeline::fuzz {
namespace {

constexpr io::ReliefShape kRelief{2, 2, 2};

const io::Grid& grid() {
    static const io::Grid kGrid(129, 100, 32);
    return kGrid;
}

// Questions in their order, answers as the input has them.
class AnsweringSource final : public io::ChunkSource {
  public:
    AnsweringSource(Input& input, std::int32_t scale) : input_(input), scale_(scale) {}
    std::int32_t quanta(std::int64_t x, std::int64_t y) const override {
        const std::int64_t height = (x * 7 + y * 13) % 257 * scale_;
        return static_cast<std::int32_t>(height % (1 << 28));
    }
    bool in_level(std::int64_t, std::int64_t, int) const override { return input_.bit(); }

  private:
    Input& input_;
    std::int32_t scale_;
};

void append_relief(const io::NodeRecord& record, const io::HeightsTile& heights,
                   std::vector<std::uint8_t>& payload) {
    std::vector<std::uint64_t> block(kRelief.bytes() / 8 + 1);
    const io::ReliefView relief(std::as_writable_bytes(std::span(block)).first(kRelief.bytes()), kRelief);
    // An empty chain stands in its own band.
    for (const io::ReliefAxis axis : {io::ReliefAxis::east, io::ReliefAxis::south})
        for (int band = 0; band < kRelief.bands; ++band)
            for (std::uint8_t& across : relief.across(axis, band))
                across = static_cast<std::uint8_t>(band * heights.quads / kRelief.bands);
    io::encode_relief(relief, record, heights, payload);
}

std::vector<std::uint8_t> packed_content(Input& input) {
    std::vector<std::uint8_t> payload = {input.byte()};
    for (int number = 0; number < 4; ++number) io::put_varint(input.word() % 5000, payload);
    const std::size_t size = input.word() % (64u << 10);
    io::compress(input.content(size), payload, 1);
    return payload;
}

std::vector<std::uint8_t> payload_of(Input& input, Form form, io::NodeId node, const io::HeightsTile& heights,
                                     const io::NodeRecord& record) {
    if (form == Form::payload) {
        const auto rest = input.rest();
        return {rest.begin(), rest.end()};
    }
    std::vector<std::uint8_t> payload;
    if (form == Form::content) {
        payload = packed_content(input);
    } else {
        io::ChunkScratch scratch;
        const AnsweringSource source(input, input.signed_word());
        if (!io::encode_chunk(grid(), node, source, scratch, payload)) return {};
    }
    append_relief(record, heights, payload);
    return payload;
}

// What the scratch of a first try says of the mesh in the payload; nothing of it is larger than its limits.
void fit(const io::ChunkScratch::State& state, io::NodeId node, io::NodeRecord& record) {
    std::size_t triangles = state.bisection.leaf_count();
    if (io::has_fans(grid(), node))
        for (int line = 0; line < io::ChunkSides::kLines; ++line) {
            const std::size_t segments = state.sides.points(line).size() - 1;
            const std::size_t fans = state.sides.fan_start(line, segments) - state.sides.fan_start(line, 0);
            triangles += (segments + fans) * (line < io::kSides ? 1 : 2);
        }
    record.vertex_count = static_cast<std::uint32_t>(state.quanta.size() + state.sides.fans().size());
    record.index_count = static_cast<std::uint32_t>(3 * triangles);
}

bool plausible(const io::NodeRecord& record) {
    return record.vertex_count > 0 && record.vertex_count <= io::kMaxChunkVertices &&
           record.index_count <= 16 * io::kMaxChunkVertices;
}

class Decoding {
  public:
    Decoding(io::NodeId node, const io::HeightsTile& heights) : node_(node), heights_(heights) {}

    bool run(std::span<const std::uint8_t> payload, const io::NodeRecord& record) {
        const io::ChunkShape shape{grid().quads(), kRelief};
        block_.assign(io::chunk_layout(record, shape).total / sizeof(io::ChunkVertex) + 1, {});
        chunk_ = io::ChunkView(std::as_writable_bytes(std::span(block_)), record, shape);
        return io::decode_chunk(grid(), node_, record, {}, payload, heights_, scratch_, chunk_).ok();
    }
    const io::ChunkView& chunk() const { return chunk_; }
    io::ChunkScratch::State& state() { return scratch_.state(); }

  private:
    io::NodeId node_;
    const io::HeightsTile& heights_;
    io::ChunkScratch scratch_;
    std::vector<io::ChunkVertex> block_;
    io::ChunkView chunk_;
};

void use(const io::ChunkView& chunk, io::NodeId node) {
    for (const std::uint16_t index : chunk.indices()) RIDGELINE_CHECK(index < chunk.vertices().size());
    const auto extent = static_cast<std::uint32_t>(grid().extent(node.level));
    for (const io::ChunkVertex& vertex : chunk.vertices())
        RIDGELINE_CHECK(vertex.x() <= extent && vertex.y <= extent);
}

}  // namespace

Verdict try_input(std::span<const std::uint8_t> bytes) {
    Input input(bytes);
    const std::uint8_t mode = input.byte();
    const io::NodeId node{mode / 3 % grid().levels(), 0, 0};
    io::NodeRecord record;
    set_bounds(input, record);
    if ((mode & 0x80) != 0) record.flags |= io::NodeRecord::kHasMask;
    const io::HeightsTile heights = heights_of(input, grid().quads());
    record.vertex_count = 1;
    const auto payload = payload_of(input, form_of(mode), node, heights, record);
    Decoding decoding(node, heights);
    if (decoding.run(payload, record)) return Verdict::refused;  // one vertex is no mesh
    if (decoding.state().bisection.vertices().empty() || decoding.state().quanta.empty())
        return Verdict::refused;
    fit(decoding.state(), node, record);
    if (!plausible(record) || !decoding.run(payload, record)) return Verdict::refused;
    use(decoding.chunk(), node);
    return Verdict::sound;
}

}  // namespace ridgeline::fuzz
