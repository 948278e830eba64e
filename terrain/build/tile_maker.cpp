#include "ridgeline/build/tile_maker.h"

#include <algorithm>

#include "ridgeline/build/node_heights.h"

namespace ridgeline::build {
namespace {

bool has_data(const TileInputs& inputs, io::NodeId node) {
    return inputs.has_data[static_cast<std::size_t>(inputs.grid.linear(node))] != 0;
}

class CoarseSource final : public io::ChunkSource {
  public:
    CoarseSource(const TileInputs& inputs, io::NodeId node)
        : inputs_(inputs), origin_(inputs.grid.origin(node)), level_(node.level) {}

    std::int32_t quanta(std::int64_t x, std::int64_t y) const override {
        const io::LatticePoint point{origin_.x + x, origin_.y + y};
        if (on_lattice(point)) return inputs_.lattice.quanta(point.x, point.y);
        const FineVertex* vertex = inputs_.fine_vertices.find(point);
        RIDGELINE_CHECK(vertex != nullptr);
        return vertex->quanta;
    }
    bool in_level(std::int64_t x, std::int64_t y, int relative) const override {
        const io::LatticePoint point{origin_.x + x, origin_.y + y};
        if (on_lattice(point))
            return inputs_.lattice.level(inputs_.levels, point.x, point.y) <= level_ - relative;
        const FineVertex* vertex = inputs_.fine_vertices.find(point);
        return vertex != nullptr && vertex->level <= level_ - relative;
    }

  private:
    static bool on_lattice(io::LatticePoint point) { return ((point.x | point.y) & 7) == 0; }

    const TileInputs& inputs_;
    io::LatticePoint origin_;
    int level_;
};

}  // namespace

void TileBatch::clear() {
    entries.clear();
    errors.clear();
    ranges.clear();
    payloads.clear();
    failure.reset();
}

template <class Source>
void TileMaker::encode(const TileInputs& inputs, io::NodeId node, const Source& source, TileBatch& batch) {
    TileBatch::Entry entry;
    entry.node = node;
    entry.has_mask = needs_mask(tile_);
    const std::size_t before = batch.payloads.size();
    io::encode_heights(tile_, batch.payloads);
    entry.heights_bytes = batch.payloads.size() - before;
    auto chunk = io::encode_chunk(inputs.grid, node, source, chunk_scratch_, batch.payloads);
    if (!chunk) {
        batch.failure = chunk.error();
        return;
    }
    entry.chunk = *chunk;
    entry.mesh_bytes = batch.payloads.size() - before - entry.heights_bytes;
    batch.entries.push_back(entry);
}

void TileMaker::make_block(const TileInputs& inputs, std::int64_t block, std::span<const std::int32_t> packed,
                           TileBatch& batch) {
    const io::LatticePoint origin = inputs.blocks.origin(block);
    window.unpack(inputs.grid, origin, packed);
    if (window.has_voids()) window.fill(*inputs.fill);
    window.pad();
    find_vertex_errors(window.quanta(), window.flags(), inputs.metric, errors);
    levels_.find(errors, inputs.lattice, inputs.levels, origin);
    inputs.fine_vertices.set(block, window, levels_);
    for (int level = inputs.blocks.top_level(); level < inputs.grid.levels(); ++level)
        for_each_node(inputs.grid, origin, level, [&](io::NodeId node) {
            if (!has_data(inputs, node)) return;
            if (inputs.grid.step(level) <= kMaxWindowStep)
                cut_heights(inputs.grid, node, origin, window, tile_);
            else
                cut_heights(inputs.grid, node, inputs.lattice, tile_);
            const io::LatticePoint corner = inputs.grid.origin(node);
            const std::int64_t column = corner.x - origin.x, row = corner.y - origin.y;
            encode(inputs, node,
                   io::DenseChunkSource{&window.quanta()[BlockWindow::at(column, row)], kWindow,
                                        levels_.from(column, row), BlockLevels::kSide, level},
                   batch);
        });
    find_ranges(inputs, origin, batch);
    find_errors(inputs, origin, batch);
}

void TileMaker::make_coarse(const TileInputs& inputs, io::NodeId node, TileBatch& batch) {
    cut_heights(inputs.grid, node, inputs.lattice, tile_);
    encode(inputs, node, CoarseSource(inputs, node), batch);
}

void TileMaker::find_ranges(const TileInputs& inputs, io::LatticePoint block_origin, TileBatch& batch) {
    const int quads = inputs.grid.quads();
    for_each_node(inputs.grid, block_origin, inputs.grid.finest(), [&](io::NodeId node) {
        const io::LatticePoint origin = inputs.grid.origin(node);
        std::int32_t least = kMaxQuanta, greatest = -kMaxQuanta;
        for (int row = 0; row <= quads; ++row) {
            const std::int32_t* samples =
                &window.quanta()[BlockWindow::at(origin.x - block_origin.x, origin.y - block_origin.y + row)];
            for (int column = 0; column <= quads; ++column) {
                least = std::min(least, samples[column]);
                greatest = std::max(greatest, samples[column]);
            }
        }
        batch.ranges.push_back({node, least, greatest});
    });
}

void TileMaker::find_errors(const TileInputs& inputs, io::LatticePoint block_origin, TileBatch& batch) {
    const io::Grid& grid = inputs.grid;
    SurfaceErrors::Bounds bounds{kMaxQuanta, -kMaxQuanta};
    for (const TileBatch::NodeRange& range : batch.ranges) {
        bounds.least = std::min(bounds.least, range.min_quanta);
        bounds.greatest = std::max(bounds.greatest, range.max_quanta);
    }
    surface_.set_block(errors, levels_, bounds, window.complete());
    for (int level = 0; level < grid.levels(); ++level) {
        const std::int64_t extent = grid.extent(level);
        const int nodes_a_side = static_cast<int>(std::max<std::int64_t>(kBlock / extent, 1));
        surface_.measure(level, inputs.corners.at(level, block_origin), nodes_a_side, node_errors_);
        const auto first_x = static_cast<std::int32_t>(block_origin.x / extent);
        const auto first_y = static_cast<std::int32_t>(block_origin.y / extent);
        for (int row = 0, i = 0; row < nodes_a_side; ++row)
            for (int column = 0; column < nodes_a_side; ++column, ++i) {
                const io::NodeId node{level, first_x + column, first_y + row};
                if (grid.contains(node))
                    batch.errors.push_back({node, node_errors_[static_cast<std::size_t>(i)]});
            }
    }
}

}  // namespace ridgeline::build
