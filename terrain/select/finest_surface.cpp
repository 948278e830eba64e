#include <algorithm>

#include "ridgeline/base/least_recent_cache.h"
#include "ridgeline/io/chunk_reader.h"
#include "ridgeline/select/drawn_surface.h"
#include "ridgeline/select/surface_query.h"

namespace ridgeline::select {
namespace {

using io::NodeId;

}  // namespace

struct FinestSurface::State {
    State(const io::Store& used, const FinestSurfaceOptions& options)
        : store(used), chunks(std::max<std::size_t>(options.cached_chunks, 1)), reader(used) {}

    const io::Store& store;
    LeastRecentCache<io::OwnedChunk> chunks;
    io::ChunkReader reader;

    Result<const io::ChunkView*> chunk(NodeId node) {
        const std::int64_t key = store.grid().linear(node);
        if (const io::OwnedChunk* found = chunks.find(key)) return &found->view;
        io::OwnedChunk& made = chunks.make(key);
        if (const auto read = reader.read(node, made); !read) {
            chunks.forget(key);
            return read.error();
        }
        return static_cast<const io::ChunkView*>(&made.view);
    }
};

FinestSurface::FinestSurface(const io::Store& store, const FinestSurfaceOptions& options)
    : state_(std::make_unique<State>(store, options)) {}
FinestSurface::~FinestSurface() = default;
FinestSurface::FinestSurface(FinestSurface&&) noexcept = default;
FinestSurface& FinestSurface::operator=(FinestSurface&&) noexcept = default;

Result<std::optional<double>> FinestSurface::height(double east_m, double north_m) {
    const glm::dvec2 place = state_->store.info().lattice(east_m, north_m);
    return height_at(place.x, place.y);
}

Result<std::optional<double>> FinestSurface::height_at(double column, double row) {
    const io::Grid& grid = state_->store.grid();
    if (!(column >= 0.0 && row >= 0.0 && column <= static_cast<double>(grid.width() - 1) &&
          row <= static_cast<double>(grid.height() - 1)))
        return std::optional<double>();
    const NodeId node = node_at_place(grid, grid.finest(), column, row);
    if (!state_->store.record(node).has_data()) return std::optional<double>();
    const auto chunk = state_->chunk(node);
    if (!chunk) return chunk.error();
    const io::LatticePoint origin = grid.origin(node);
    const auto place = locate(**chunk, grid.quads(), column - static_cast<double>(origin.x),
                              row - static_cast<double>(origin.y));
    if (!place) return std::optional<double>();
    return std::optional(state_->store.info().height_m(mesh_quanta(**chunk, *place)));
}

}  // namespace ridgeline::select
