// Literature: "Terrain rendering using constrained normal cones and incremental horizons" (the horizon
// paper, 3.1) for the chunks; Pajarola 1998 and Duchaineau et al. 1997 for the bisection (bisection.h). The
// papers store vertex and index lists; we store the answers to "does this diamond split", which is the whole
// topology, and take heights as residuals to the hypotenuse's middle. 0.5 bytes a triangle on whole-metre
// data, against 2.6 for index lists.
//
// Payload: flags (residual planes), varints (own vertices, fan vertices, split bits, fan bits), then one zstd
// frame of split bits, parent bits, fan bits (each padded to bytes) and residual planes. The relief follows
// (relief_codec.h).
#include "ridgeline/io/chunk_codec.h"

#include <algorithm>
#include <cmath>

#include "ridgeline/io/chunk_state.h"
#include "ridgeline/io/relief_codec.h"
#include "ridgeline/io/zstd_stream.h"

namespace ridgeline::io {

ChunkScratch::ChunkScratch() : state_(std::make_unique<State>()) {}
ChunkScratch::~ChunkScratch() = default;
ChunkScratch::ChunkScratch(ChunkScratch&&) noexcept = default;
ChunkScratch& ChunkScratch::operator=(ChunkScratch&&) noexcept = default;

namespace {

using Vertices = std::vector<Bisection::Vertex>;

const Error kDamaged{"damaged mesh tile"};

std::uint32_t node_extent(const Grid& grid, NodeId node) {
    return static_cast<std::uint32_t>(grid.extent(node.level));
}

// The middle of the hypotenuse, rounded down: what a residual is relative to. Corners have none.
std::uint32_t prediction(const Bisection::Vertex& vertex, std::size_t number,
                         std::span<const std::int32_t> quanta) {
    if (number == 0) return 0;
    if (number < Bisection::kFirstMidpoint) return static_cast<std::uint32_t>(quanta[0]);
    const std::int64_t sum = std::int64_t{quanta[vertex.ends[0]]} + quanta[vertex.ends[1]];
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(sum >> 1));
}

// The parent's mesh holds all corners of its children; of the others it has to be said.
bool needs_parent_bit(NodeId node, std::size_t vertex) {
    return node.level > 0 && vertex >= Bisection::kFirstMidpoint;
}

// The parent's surface at every vertex: linear wherever the parent does not split, so the mean of the
// hypotenuse's ends, exactly (heights below 2^29 quanta and at most 24 halvings fit a double's 53 bits).
void find_parent_surface(const Vertices& vertices, ChunkScratch::State& state) {
    state.parent_surface.resize(vertices.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        const double a = state.parent_surface[vertices[v].ends[0]],
                     b = state.parent_surface[vertices[v].ends[1]];
        state.parent_surface[v] =
            state.in_parent[v] != 0 ? static_cast<double>(state.quanta[v]) : 0.5 * (a + b);
    }
}

// The own edge's height at a fan vertex, for every fan vertex in order: put(line, along, quanta).
template <class Put>
void for_each_fan(const ChunkSides& sides, std::span<const std::int32_t> quanta, Put&& put) {
    for (int line = 0; line < ChunkSides::kLines; ++line) {
        const auto points = sides.points(line);
        for (std::size_t segment = 0; segment + 1 < points.size(); ++segment) {
            const auto& from = points[segment];
            const auto& to = points[segment + 1];
            const double rise =
                static_cast<double>(quanta[to.vertex]) - static_cast<double>(quanta[from.vertex]);
            const double slope = rise / static_cast<double>(to.along - from.along);
            for (std::uint32_t i = sides.fan_start(line, segment); i < sides.fan_start(line, segment + 1);
                 ++i) {
                const std::uint32_t along = sides.fans()[i];
                put(line, along,
                    round_to_quantum(quanta[from.vertex] + slope * static_cast<double>(along - from.along)));
            }
        }
    }
}

// --- which index range a triangle belongs to
// ------------------------------------------------------------------

// The quarter sides on the node's border, clockwise from the north-west.
struct QuarterSide {
    int quarter;
    Side side;
};
constexpr QuarterSide kOuterSides[] = {{0, Side::north}, {1, Side::north}, {1, Side::east}, {3, Side::east},
                                       {3, Side::south}, {2, Side::south}, {2, Side::west}, {0, Side::west}};

struct RangeCounts {
    std::uint32_t inside[kQuarters] = {};
    std::uint32_t plain[kQuarters][kSides] = {};
    std::uint32_t fan[kQuarters][kSides] = {};
};

// Gives every range its place, in the order that chunk.h promises, with count 0; returns all indices' number.
std::uint32_t place_ranges(const RangeCounts& counts, ChunkRanges& ranges) {
    std::uint32_t next = 0;
    const auto place = [&](IndexRange& range, std::uint32_t triangles) {
        range = {next, 0};
        next += 3 * triangles;
    };
    for (int q = 0; q < kQuarters; ++q) place(ranges.inside[q], counts.inside[q]);
    for (int q = 0; q < kQuarters; ++q)
        for (int s = 0; s < kSides; ++s)
            if (inner_line(q, static_cast<Side>(s)) >= 0) place(ranges.plain[q][s], counts.plain[q][s]);
    for (const auto& [q, side] : kOuterSides)
        place(ranges.plain[q][index(side)], counts.plain[q][index(side)]);
    for (int q = 0; q < kQuarters; ++q)
        for (int s = 0; s < kSides; ++s) place(ranges.fan[q][s], counts.fan[q][s]);
    return next;
}

// The side edge of a triangle: its ends in the triangle's turn, and the vertex opposite.
struct SideEdge {
    std::uint16_t from, to, opposite;
};
SideEdge side_edge(const Bisection::Triangle& t) {
    switch (t.side_edge) {
        case Bisection::Edge::hypotenuse:
            return {t.vertex[1], t.vertex[2], t.vertex[0]};
        case Bisection::Edge::first_leg:
            return {t.vertex[0], t.vertex[1], t.vertex[2]};
        default:
            return {t.vertex[2], t.vertex[0], t.vertex[1]};
    }
}

// The fan vertices between the ends of a triangle's side edge: places in ChunkSides::fans().
struct FanRun {
    std::uint32_t first, last;  // last is one past the end
    bool descending;            // the triangle's turn runs against the line
};
FanRun fan_run(const Bisection::Triangle& t, const SideEdge& edge, const Vertices& vertices,
               const ChunkSides& sides) {
    const int line = ChunkSides::line_of(t.quarter, t.side);
    const auto along = [&](std::uint16_t v) {
        return ChunkSides::runs_south(line) ? vertices[v].y : vertices[v].x;
    };
    const std::uint32_t from = along(edge.from), to = along(edge.to);
    const std::size_t segment = sides.segment_at(line, std::min(from, to));
    return {sides.fan_start(line, segment), sides.fan_start(line, segment + 1), from > to};
}

RangeCounts count_triangles(const ChunkScratch::State& state, bool fans) {
    RangeCounts counts;
    state.bisection.for_each_leaf([&](const Bisection::Triangle& t) {
        if (t.side_edge == Bisection::Edge::none) {
            ++counts.inside[t.quarter];
            return;
        }
        ++counts.plain[t.quarter][index(t.side)];
        if (!fans) return;
        const FanRun run = fan_run(t, side_edge(t), state.bisection.vertices(), state.sides);
        counts.fan[t.quarter][index(t.side)] += 1 + run.last - run.first;
    });
    return counts;
}

// --- encoding
// -------------------------------------------------------------------------------------------------

template <class Source>
void encode_heights_and_parents(NodeId node, const Source& source, ChunkScratch::State& state) {
    const Vertices& vertices = state.bisection.vertices();
    state.quanta.clear();
    state.in_parent.clear();
    state.residuals.clear();
    state.parent_bits.clear();
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        const std::int32_t quanta = source.quanta(vertices[v].x, vertices[v].y);
        const std::uint32_t residual =
            static_cast<std::uint32_t>(quanta) - prediction(vertices[v], v, state.quanta);
        state.residuals.push_back(zigzag(static_cast<std::int32_t>(residual)));
        state.quanta.push_back(quanta);
        const bool asked = needs_parent_bit(node, v);
        const bool in_parent = !asked || source.in_level(vertices[v].x, vertices[v].y, 1);
        if (asked) state.parent_bits.put(in_parent);
        state.in_parent.push_back(in_parent ? 1 : 0);
    }
}

void pack(ChunkScratch::State& state, std::vector<std::uint8_t>& payload) {
    const int planes = planes_for(state.residuals);
    payload.push_back(static_cast<std::uint8_t>(planes));
    put_varint(static_cast<std::uint32_t>(state.residuals.size()), payload);
    put_varint(static_cast<std::uint32_t>(state.sides.fans().size()), payload);
    put_varint(static_cast<std::uint32_t>(state.split_bits.count()), payload);
    put_varint(static_cast<std::uint32_t>(state.fan_bits.count()), payload);
    state.bytes.clear();
    for (const BitWriter* bits : {&state.split_bits, &state.parent_bits, &state.fan_bits})
        state.bytes.insert(state.bytes.end(), bits->bytes().begin(), bits->bytes().end());
    put_planes(state.residuals, planes, state.bytes);
    compress(state.bytes, payload);
}

void widen(EncodedChunk& chunk, std::int32_t quanta) {
    chunk.min_quanta = std::min(chunk.min_quanta, quanta);
    chunk.max_quanta = std::max(chunk.max_quanta, quanta);
}

// Triangles of the fan ranges: each segment of a line has one on either side of it that the mesh has, split
// by the segment's fan vertices.
std::size_t fan_triangles(const ChunkSides& sides) {
    std::size_t triangles = 0;
    for (int line = 0; line < ChunkSides::kLines; ++line) {
        const std::size_t segments = sides.points(line).size() - 1;
        const std::size_t fans = sides.fan_start(line, segments) - sides.fan_start(line, 0);
        triangles += (segments + fans) * (line < kSides ? 1 : 2);
    }
    return triangles;
}

EncodedChunk describe(bool fans, ChunkScratch::State& state) {
    EncodedChunk chunk;
    const std::size_t plain = state.bisection.leaf_count();
    chunk.triangle_count = static_cast<std::uint32_t>(plain);
    chunk.index_count = static_cast<std::uint32_t>(3 * (plain + (fans ? fan_triangles(state.sides) : 0)));
    chunk.vertex_count = static_cast<std::uint32_t>(state.quanta.size() + state.sides.fans().size());
    find_parent_surface(state.bisection.vertices(), state);
    chunk.min_quanta = chunk.max_quanta = state.quanta.front();
    for (const std::int32_t quanta : state.quanta) widen(chunk, quanta);
    for (const double quanta : state.parent_surface) widen(chunk, round_to_quantum(quanta));
    return chunk;
}

// --- decoding
// -------------------------------------------------------------------------------------------------

struct Streams {
    std::uint32_t vertices = 0, fans = 0;
    int planes = 0;
    BitReader split, parent, fan;
    std::span<const std::uint8_t> residuals;
};

// Unpacks the payload into state.bytes, points the streams into it and takes it off the front of `payload`.
Result<Streams> unpack(NodeId node, std::span<const std::uint8_t>& payload, ChunkScratch::State& state) {
    if (payload.empty()) return kDamaged;
    Streams streams;
    streams.planes = payload.front();
    payload = payload.subspan(1);
    const auto vertices = take_varint(payload), fans = take_varint(payload);
    const auto split_bits = take_varint(payload), fan_bits = take_varint(payload);
    if (!fan_bits || streams.planes < 1 || streams.planes > 4) return kDamaged;
    // A diamond is asked about at most once and there are fewer than four for every vertex; a fan's segment
    // likewise.
    if (*vertices < Bisection::kFirstVertices || *vertices > kMaxChunkVertices || *fans > kMaxChunkVertices ||
        *split_bits > 4 * kMaxChunkVertices || *fan_bits > 4 * kMaxChunkVertices)
        return kDamaged;
    streams.vertices = *vertices;
    streams.fans = *fans;
    const std::size_t parent_bits = node.level > 0 ? *vertices - Bisection::kFirstMidpoint : 0;
    const auto bytes_of = [](std::size_t bits) { return (bits + 7) / 8; };
    const std::size_t residual_bytes = std::size_t{*vertices} * static_cast<std::size_t>(streams.planes);
    state.bytes.resize(bytes_of(*split_bits) + bytes_of(parent_bits) + bytes_of(*fan_bits) + residual_bytes);
    RIDGELINE_TRY(decompress_front(payload, state.bytes));
    std::span<const std::uint8_t> rest = state.bytes;
    const auto take_bits = [&](std::size_t bits) {
        const BitReader reader(rest.first(bytes_of(bits)), bits);
        rest = rest.subspan(bytes_of(bits));
        return reader;
    };
    streams.split = take_bits(*split_bits);
    streams.parent = take_bits(parent_bits);
    streams.fan = take_bits(*fan_bits);
    streams.residuals = rest;
    return streams;
}

void decode_heights_and_parents(NodeId node, Streams& streams, ChunkScratch::State& state) {
    const Vertices& vertices = state.bisection.vertices();
    state.quanta.resize(vertices.size());
    state.in_parent.resize(vertices.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        const std::uint32_t residual = from_planes(streams.residuals, vertices.size(), streams.planes, v);
        const std::uint32_t predicted = prediction(vertices[v], v, state.quanta);
        state.quanta[v] =
            static_cast<std::int32_t>(predicted + static_cast<std::uint32_t>(unzigzag(residual)));
        state.in_parent[v] = !needs_parent_bit(node, v) || streams.parent.take() ? 1 : 0;
    }
}

// Takes the mesh off the front of `payload`.
Result<void> decode_mesh(const Grid& grid, NodeId node, std::span<const std::uint8_t>& payload,
                         ChunkScratch::State& state) {
    auto streams = unpack(node, payload, state);
    if (!streams) return streams.error();
    state.bisection.begin(node, node_extent(grid, node));
    if (!state.bisection.refine([&](std::uint32_t, std::uint32_t) { return streams->split.take(); }))
        return kDamaged;
    if (state.bisection.vertices().size() != streams->vertices) return kDamaged;
    state.sides.begin(state.bisection.vertices(), node_extent(grid, node));
    state.sides.find_fans(
        [&](std::uint32_t, std::uint32_t) { return has_fans(grid, node) && streams->fan.take(); });
    if (state.sides.fans().size() != streams->fans) return kDamaged;
    decode_heights_and_parents(node, *streams, state);
    const bool exhausted =
        streams->split.exhausted() && streams->parent.exhausted() && streams->fan.exhausted();
    return exhausted ? Result<void>() : Result<void>(kDamaged);
}

int class_on_line(std::uint32_t along, std::uint32_t half, int halves_first, int middle) {
    return along == half ? middle : halves_first + (along < half ? 0 : 1);
}

int morph_class(std::uint32_t x, std::uint32_t y, std::uint32_t extent) {
    const std::uint32_t half = extent / 2;
    const bool on_x = x == 0 || x == extent, on_y = y == 0 || y == extent;
    if (on_x && on_y) return vertex_class::kInterior;
    if (on_x) {
        const Side side = x == 0 ? Side::west : Side::east;
        return class_on_line(y, half, vertex_class::outer(side, 0), vertex_class::midpoint(side));
    }
    if (on_y) {
        const Side side = y == 0 ? Side::north : Side::south;
        return class_on_line(x, half, vertex_class::outer(side, 0), vertex_class::midpoint(side));
    }
    if (x == half) return class_on_line(y, half, vertex_class::inner(0), vertex_class::kCentre);
    if (y == half) return class_on_line(x, half, vertex_class::inner(2), vertex_class::kCentre);
    return vertex_class::kInterior;
}

ChunkVertex chunk_vertex(std::uint32_t x, std::uint32_t y, std::uint32_t extent, std::int32_t quanta,
                         std::int32_t delta) {
    return {static_cast<std::uint32_t>(morph_class(x, y, extent)) << 24 | x, y, quanta, delta};
}

void write_vertices(std::uint32_t extent, const ChunkScratch::State& state, std::span<ChunkVertex> out) {
    const Vertices& vertices = state.bisection.vertices();
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        // Unsigned, because damaged heights may be any.
        const std::uint32_t delta = static_cast<std::uint32_t>(round_to_quantum(state.parent_surface[v])) -
                                    static_cast<std::uint32_t>(state.quanta[v]);
        out[v] = chunk_vertex(vertices[v].x, vertices[v].y, extent, state.quanta[v],
                              static_cast<std::int32_t>(delta));
    }
    std::size_t next = vertices.size();
    for_each_fan(state.sides, state.quanta, [&](int line, std::uint32_t along, std::int32_t quanta) {
        const auto [x, y] = state.sides.position(line, along);
        out[next++] = chunk_vertex(x, y, extent, quanta, 0);
    });
}

// Triangles (opposite, from, fan..., to) around the vertex opposite the side.
template <class Emit>
void emit_fan(const SideEdge& edge, const FanRun& run, std::size_t own_vertices, Emit&& emit) {
    std::uint16_t last = edge.from;
    for (std::uint32_t i = 0; i < run.last - run.first; ++i) {
        const std::uint32_t fan = run.descending ? run.last - 1 - i : run.first + i;
        const auto vertex = static_cast<std::uint16_t>(own_vertices + fan);
        emit(edge.opposite, last, vertex);
        last = vertex;
    }
    emit(edge.opposite, last, edge.to);
}

void write_indices(bool fans, const ChunkScratch::State& state, ChunkRanges& ranges,
                   std::span<std::uint16_t> out) {
    const auto emit_to = [&out](IndexRange& range) {
        return [&out, &range](std::uint16_t a, std::uint16_t b, std::uint16_t c) {
            for (const std::uint16_t vertex : {a, b, c}) out[range.first + range.count++] = vertex;
        };
    };
    const std::size_t own = state.bisection.vertices().size();
    state.bisection.for_each_leaf([&](const Bisection::Triangle& t) {
        const bool inside = t.side_edge == Bisection::Edge::none;
        IndexRange& range = inside ? ranges.inside[t.quarter] : ranges.plain[t.quarter][index(t.side)];
        emit_to(range)(t.vertex[0], t.vertex[1], t.vertex[2]);
        if (inside || !fans) return;
        const SideEdge edge = side_edge(t);
        emit_fan(edge, fan_run(t, edge, state.bisection.vertices(), state.sides), own,
                 emit_to(ranges.fan[t.quarter][index(t.side)]));
    });
}

void write_mask(const HeightsTile& heights, std::span<std::uint32_t> mask) {
    std::fill(mask.begin(), mask.end(), 0u);
    for (std::size_t cell = 0; cell < heights.cell_valid.size(); ++cell)
        mask[cell / 32] |= std::uint32_t{heights.cell_valid[cell]} << (cell % 32);
}

// Central differences at the node's own spacing; the apron makes them seamless.
void write_normals(const HeightsTile& heights, const ChunkSpacing& spacing, std::int64_t step,
                   std::span<NormalTexel> out) {
    const auto per_step = static_cast<float>(static_cast<double>(step) * 2.0 / spacing.quantum_m);
    const float run_east = per_step * static_cast<float>(spacing.x_m);
    const float run_north = per_step * static_cast<float>(spacing.y_m);
    const auto height = [&](int column, int row) {
        return static_cast<float>(heights.quanta[heights.at(column, row)]);
    };
    std::size_t next = 0;
    for (int row = 0; row <= heights.quads; ++row)
        for (int column = 0; column <= heights.quads; ++column) {
            const float east = (height(column - 1, row) - height(column + 1, row)) / run_east;
            const float north = (height(column, row + 1) - height(column, row - 1)) / run_north;
            const float scale = 32767.0f / std::sqrt(east * east + north * north + 1.0f);
            out[next++] = {static_cast<std::int16_t>(std::lround(east * scale)),
                           static_cast<std::int16_t>(std::lround(north * scale))};
        }
}

template <class Source>
Result<EncodedChunk> encode_from(const Grid& grid, NodeId node, const Source& source, ChunkScratch& scratch,
                                 std::vector<std::uint8_t>& payload) {
    ChunkScratch::State& state = scratch.state();
    state.split_bits.clear();
    state.fan_bits.clear();
    state.bisection.begin(node, node_extent(grid, node));
    const bool fits = state.bisection.refine([&](std::uint32_t x, std::uint32_t y) {
        const bool splits = source.in_level(x, y, 0);
        state.split_bits.put(splits);
        return splits;
    });
    state.sides.begin(state.bisection.vertices(), node_extent(grid, node));
    state.sides.find_fans([&](std::uint32_t x, std::uint32_t y) {
        if (!has_fans(grid, node)) return false;
        const bool splits = source.in_level(x, y, -1);
        state.fan_bits.put(splits);
        return splits;
    });
    if (!fits || state.bisection.vertices().size() + state.sides.fans().size() > kMaxChunkVertices)
        return Error{"a chunk would need more than 65534 vertices"};
    encode_heights_and_parents(node, source, state);
    const EncodedChunk chunk = describe(has_fans(grid, node), state);
    pack(state, payload);
    return chunk;
}

}  // namespace

Result<EncodedChunk> encode_chunk(const Grid& grid, NodeId node, const ChunkSource& source,
                                  ChunkScratch& scratch, std::vector<std::uint8_t>& payload) {
    return encode_from(grid, node, source, scratch, payload);
}

Result<EncodedChunk> encode_chunk(const Grid& grid, NodeId node, const DenseChunkSource& source,
                                  ChunkScratch& scratch, std::vector<std::uint8_t>& payload) {
    return encode_from(grid, node, source, scratch, payload);
}

Result<void> decode_chunk(const Grid& grid, NodeId node, const NodeRecord& record,
                          const ChunkSpacing& spacing, std::span<const std::uint8_t> mesh_payload,
                          const HeightsTile& heights, ChunkScratch& scratch, ChunkView chunk) {
    ChunkScratch::State& state = scratch.state();
    RIDGELINE_TRY(decode_mesh(grid, node, mesh_payload, state));
    const bool fans = has_fans(grid, node);
    ChunkRanges ranges;
    const std::uint32_t index_count = place_ranges(count_triangles(state, fans), ranges);
    const std::size_t vertex_count = state.quanta.size() + state.sides.fans().size();
    const bool mask_agrees = !record.has_mask() || !heights.cell_valid.empty();
    if (vertex_count != record.vertex_count || index_count != record.index_count || !mask_agrees ||
        heights.quads != grid.quads())
        return kDamaged;
    find_parent_surface(state.bisection.vertices(), state);
    write_vertices(node_extent(grid, node), state, chunk.vertices());
    write_indices(fans, state, ranges, chunk.indices());
    chunk.ranges() = ranges;
    if (record.has_mask()) write_mask(heights, chunk.mask());
    write_normals(heights, spacing, grid.step(node.level), chunk.normals());
    return decode_relief(mesh_payload, record, heights, chunk.relief());
}

}  // namespace ridgeline::io
