#include "ridgeline/build/tile_maker.h"

#include <algorithm>

#include "ridgeline/build/node_heights.h"

namespace ridgeline::build {
namespace {

bool has_data(const TileInputs& inputs, io::NodeId node) {
    return inputs.has_data[static_cast<std::size_t>(inputs.grid.linear(node))] != 0;
}

// Nodes a block's side at a level.
std::size_t nodes_a_side(const io::Grid& grid, int level) {
    return static_cast<std::size_t>(std::max<std::int64_t>(kBlock / grid.extent(level), 1));
}
// A node's place among those of its level in its block.
std::size_t place_in_block(const io::Grid& grid, io::NodeId node) {
    const auto side = nodes_a_side(grid, node.level);
    return static_cast<std::size_t>(node.y) % side * side + static_cast<std::size_t>(node.x) % side;
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
    bounds.clear();
    payloads.clear();
    failure.reset();
}

template <class Source>
void TileMaker::encode(const TileInputs& inputs, io::NodeId node, const Source& source,
                       io::ReliefBounds& bounds, TileBatch& batch) {
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
    relief_maker_.append(inputs.grid, node, inputs.relief, chunk_scratch_, tile_, *chunk, bounds,
                         batch.payloads);
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
    find_ranges(inputs, origin);
    for (int level = inputs.grid.finest(); level >= inputs.blocks.top_level(); --level)
        make_level(inputs, origin, level, batch);
    find_errors(inputs, origin, batch);
}

void TileMaker::make_level(const TileInputs& inputs, io::LatticePoint block_origin, int level,
                           TileBatch& batch) {
    const io::Grid& grid = inputs.grid;
    const std::size_t parents = level > 0 ? nodes_a_side(grid, level - 1) : 0;
    parent_bounds_.assign(parents * parents, {});
    for_each_node(grid, block_origin, level, [&](io::NodeId node) {
        if (!has_data(inputs, node)) return;
        if (grid.step(level) <= kMaxWindowStep)
            cut_heights(grid, node, block_origin, window, tile_);
        else
            cut_heights(grid, node, inputs.lattice, tile_);
        const io::LatticePoint corner = grid.origin(node);
        const std::int64_t column = corner.x - block_origin.x, row = corner.y - block_origin.y;
        io::ReliefBounds bounds;
        if (level == grid.finest()) {
            bounds.widen(ranges_[place_in_block(grid, node)].least);
            bounds.widen(ranges_[place_in_block(grid, node)].greatest);
        } else {
            bounds = std::move(bounds_[place_in_block(grid, node)]);
        }
        encode(inputs, node,
               io::DenseChunkSource{&window.quanta()[BlockWindow::at(column, row)], kWindow,
                                    levels_.from(column, row), BlockLevels::kSide, level},
               bounds, batch);
        if (batch.failure || level == 0) return;
        if (level == inputs.blocks.top_level())
            batch.bounds.push_back({node, std::move(bounds)});
        else
            parent_bounds_[place_in_block(grid, node.parent())].add_child(inputs.relief, node.quarter(),
                                                                          bounds);
    });
    bounds_.swap(parent_bounds_);
}

void TileMaker::make_coarse(const TileInputs& inputs, io::NodeId node, io::ReliefBounds& bounds,
                            TileBatch& batch) {
    cut_heights(inputs.grid, node, inputs.lattice, tile_);
    encode(inputs, node, CoarseSource(inputs, node), bounds, batch);
    if (!batch.failure && node.level > 0) batch.bounds.push_back({node, std::move(bounds)});
}

void TileMaker::find_ranges(const TileInputs& inputs, io::LatticePoint block_origin) {
    const int quads = inputs.grid.quads();
    const std::size_t side = nodes_a_side(inputs.grid, inputs.grid.finest());
    ranges_.assign(side * side, {kMaxQuanta, -kMaxQuanta});
    for_each_node(inputs.grid, block_origin, inputs.grid.finest(), [&](io::NodeId node) {
        const io::LatticePoint origin = inputs.grid.origin(node);
        SurfaceErrors::Bounds& range = ranges_[place_in_block(inputs.grid, node)];
        for (int row = 0; row <= quads; ++row) {
            const std::int32_t* samples =
                &window.quanta()[BlockWindow::at(origin.x - block_origin.x, origin.y - block_origin.y + row)];
            for (int column = 0; column <= quads; ++column) {
                range.least = std::min(range.least, samples[column]);
                range.greatest = std::max(range.greatest, samples[column]);
            }
        }
    });
}

void TileMaker::find_errors(const TileInputs& inputs, io::LatticePoint block_origin, TileBatch& batch) {
    const io::Grid& grid = inputs.grid;
    SurfaceErrors::Bounds bounds{kMaxQuanta, -kMaxQuanta};
    for (const SurfaceErrors::Bounds& range : ranges_) {
        bounds.least = std::min(bounds.least, range.least);
        bounds.greatest = std::max(bounds.greatest, range.greatest);
    }
    surface_.set_block(errors, levels_, bounds, window.complete());
    for (int level = 0; level < grid.levels(); ++level) {
        const std::int64_t extent = grid.extent(level);
        const auto side = static_cast<int>(nodes_a_side(grid, level));
        surface_.measure(level, inputs.corners.at(level, block_origin), side, node_errors_);
        const auto first_x = static_cast<std::int32_t>(block_origin.x / extent);
        const auto first_y = static_cast<std::int32_t>(block_origin.y / extent);
        for (int row = 0, i = 0; row < side; ++row)
            for (int column = 0; column < side; ++column, ++i) {
                const io::NodeId node{level, first_x + column, first_y + row};
                if (grid.contains(node))
                    batch.errors.push_back({node, node_errors_[static_cast<std::size_t>(i)]});
            }
    }
}

}  // namespace ridgeline::build
