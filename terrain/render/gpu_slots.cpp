#include "ridgeline/render/gpu_slots.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ridgeline/base/units.h"

namespace ridgeline::render {
namespace {

// Chunks are some 65 KiB: units of 1 KiB waste less than 1 % of the buffer.
constexpr std::uint64_t kUnitBytes = 1024;
// What 32-bit places of indices reach.
constexpr std::uint64_t kMostGeometryBytes = 4_GiB;
// Squares of a layer's side; 8 keeps the layers of 65^2 squares near a megabyte, so that small caches waste
// little.
constexpr int kMaxSquaresPerSide = 8;

std::uint64_t units_for(std::uint64_t bytes) { return (bytes + kUnitBytes - 1) / kUnitBytes; }

std::uint32_t units_of(const io::ChunkView& chunk) {
    return static_cast<std::uint32_t>(units_for(chunk.layout().mask));
}

std::uint64_t mask_words(int quads) {
    return static_cast<std::uint64_t>(quads) * static_cast<std::uint64_t>(quads) / 32;
}

// Vertices and indices; masks lie in a buffer of their own, small enough for a storage block on every driver.
std::uint64_t geometry_bytes(const io::NodeRecord& record, int quads) {
    return io::chunk_layout(record, {.quads = quads}).mask;
}

struct Needs {
    std::uint64_t nodes = 0;
    std::uint64_t geometry_bytes = 0;  // in whole units
};
Needs needs(std::span<const io::NodeRecord> records, int quads) {
    Needs sum;
    for (const auto& record : records) {
        if (!record.has_data()) continue;
        ++sum.nodes;
        sum.geometry_bytes += units_for(geometry_bytes(record, quads)) * kUnitBytes;
    }
    return sum;
}

// The fewest layers that hold `squares` squares.
GpuSlotsShape with_squares(int quads, std::uint64_t squares, const GpuSlotsOptions& options) {
    const auto side = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(squares))));
    GpuSlotsShape shape{.quads = quads};
    shape.squares_per_side =
        std::clamp(side, 1, std::min(kMaxSquaresPerSide, options.max_texture_size_px / (quads + 1)));
    const auto per_layer = static_cast<std::uint64_t>(shape.squares_per_side * shape.squares_per_side);
    const std::uint64_t layers = (squares + per_layer - 1) / per_layer;
    shape.layers = static_cast<int>(std::min(layers, static_cast<std::uint64_t>(options.max_layers)));
    return shape;
}

double mean_geometry_bytes(const Needs& all) {
    return static_cast<double>(all.geometry_bytes) / static_cast<double>(all.nodes);
}

// Squares for as many chunks of mean size as fit, and a tenth more, because an idle square costs less than an
// idle run of the buffer. Whole layers may come to too much: then fewer.
GpuSlotsShape suitable_squares(int quads, const Needs& all, const GpuSlotsOptions& options) {
    const auto capacity = static_cast<double>(options.capacity_bytes);
    const double chunk_bytes =
        mean_geometry_bytes(all) + static_cast<double>(GpuSlotsShape::square_bytes(quads));
    const double chunks = std::min(capacity / chunk_bytes, static_cast<double>(all.nodes));
    const auto squares = std::min(static_cast<std::uint64_t>(1.1 * chunks) + 1, all.nodes);
    GpuSlotsShape shape = with_squares(quads, squares, options);
    while (shape.layers > 1 &&
           static_cast<double>(shape.total_bytes()) + chunks * mean_geometry_bytes(all) > capacity)
        --shape.layers;
    return shape;
}

}  // namespace

std::uint64_t GpuSlotsShape::square_bytes(int quads) {
    const auto texels = static_cast<std::uint64_t>((quads + 1) * (quads + 1));
    return texels * sizeof(io::NormalTexel) + mask_words(quads) * sizeof(std::uint32_t);
}

std::uint64_t GpuSlotsShape::total_bytes() const {
    return geometry_bytes + static_cast<std::uint64_t>(square_count()) * square_bytes(quads);
}

Result<GpuSlotsShape> plan_gpu_slots(const pager::TileSource& source, const GpuSlotsOptions& options) {
    const int quads = source.grid.quads();
    const Needs level0 = needs(source.records.first(static_cast<std::size_t>(source.grid.first(1))), quads);
    const Needs all = needs(source.records, quads);
    if (all.nodes == 0) return Error{source.name + ": holds no terrain"};
    GpuSlotsShape least = with_squares(quads, level0.nodes, options);
    least.geometry_bytes = level0.geometry_bytes;
    if (least.square_count() < static_cast<int>(level0.nodes))
        return Error{source.name + ": its coarsest level has " + std::to_string(level0.nodes) +
                     " tiles, more than this GPU's textures hold (" + std::to_string(least.square_count()) +
                     ")"};
    const std::uint64_t least_part_bytes = std::max(least.total_bytes(), options.least_other_part_bytes);
    if (least.total_bytes() > options.capacity_bytes)
        return Error{source.name + ": its coarsest level does not fit the GPU cache: use --gpu-cache " +
                     std::to_string((least_part_bytes * options.parts + 1023) / 1024) + "KiB or more"};

    GpuSlotsShape shape = suitable_squares(quads, all, options);
    if (shape.square_count() < least.square_count() ||
        shape.total_bytes() + level0.geometry_bytes > options.capacity_bytes) {
        shape = least;
        shape.geometry_bytes = 0;
    }
    const std::uint64_t rest = options.capacity_bytes - shape.total_bytes();
    shape.geometry_bytes = std::min({rest, all.geometry_bytes, kMostGeometryBytes}) / kUnitBytes * kUnitBytes;
    return shape;
}

Result<GpuSlots> GpuSlots::create(const GpuSlotsShape& shape) {
    auto runs = pager::PageAllocator::create(static_cast<std::uint32_t>(shape.geometry_bytes / kUnitBytes));
    if (!runs) return runs.error();
    GpuSlots slots(shape, std::move(runs).value());
    auto geometry = gl::Buffer::create({shape.geometry_bytes, gl::BufferUse::gpu, "chunks"});
    if (!geometry) return geometry.error();
    slots.geometry_ = std::move(geometry).value();
    const auto squares = static_cast<std::uint64_t>(shape.square_count());
    auto masks = gl::Buffer::create(
        {squares * mask_words(shape.quads) * sizeof(std::uint32_t), gl::BufferUse::gpu, "masks"});
    if (!masks) return masks.error();
    slots.masks_ = std::move(masks).value();
    const int side_px = shape.squares_per_side * (shape.quads + 1);
    auto normals = gl::Texture2DArray::create(
        {.format = GL_RG16_SNORM, .size_px = {side_px, side_px}, .layers = shape.layers, .label = "normals"});
    if (!normals) return normals.error();
    slots.normals_ = std::move(normals).value();
    return slots;
}

GpuSlots::GpuSlots(const GpuSlotsShape& shape, pager::PageAllocator runs)
    : shape_(shape), runs_(std::move(runs)), slots_(static_cast<std::size_t>(shape.square_count())) {
    free_.reserve(slots_.size());
    released_.reserve(slots_.size());
    for (std::size_t square = slots_.size(); square-- > 0;)
        free_.push_back(static_cast<std::uint32_t>(square));
}

GpuSlots::Outcome GpuSlots::store(const io::ChunkView& chunk, gl::StagingRing& staging) {
    if (free_.empty()) return {Stored::no_room};
    const pager::PageRun run = runs_.allocate(units_of(chunk));
    if (!run) return {Stored::no_room};
    const auto staged = staging.allocate(chunk.geometry().size() + chunk.normals().size_bytes());
    if (!staged) {
        runs_.free(run);
        return {Stored::staging_full};
    }
    const std::uint32_t square = free_.back();
    free_.pop_back();
    slots_[square] = {run, 0};
    upload(chunk, square, *staged, staging.buffer());
    return {Stored::yes, pager::GpuSlot{square}};
}

void GpuSlots::upload(const io::ChunkView& chunk, std::uint32_t square,
                      const gl::StagingRing::Allocation& staged, const gl::Buffer& staging) {
    const auto geometry = chunk.geometry();
    const auto normals = std::as_bytes(chunk.normals());
    std::memcpy(staged.bytes.data(), geometry.data(), geometry.size());
    std::memcpy(staged.bytes.data() + geometry.size(), normals.data(), normals.size());

    const std::size_t vertices_and_indices = chunk.layout().mask;
    gl::copy(staging, staged.offset_bytes, geometry_, slots_[square].run.first_page * kUnitBytes,
             vertices_and_indices);
    if (const auto mask = chunk.mask(); !mask.empty())
        gl::copy(staging, staged.offset_bytes + vertices_and_indices, masks_,
                 place(pager::GpuSlot{square}).mask_word * sizeof(std::uint32_t), mask.size_bytes());
    const auto [layer, column, row] = square_place(square);
    const int side = shape_.quads + 1;
    normals_.upload({0, layer, {column * side, row * side}, {side, side}}, {GL_RG, GL_SHORT}, staging,
                    staged.offset_bytes + geometry.size());
}

void GpuSlots::release(pager::GpuSlot slot) {
    const std::uint32_t square = index(slot);
    if (slots_[square].last_frame <= completed_frame_) return free(square);
    released_.push_back(square);
    released_units_ += slots_[square].run.pages;
}

void GpuSlots::free(std::uint32_t square) {
    runs_.free(slots_[square].run);
    slots_[square] = {};
    free_.push_back(square);
}

void GpuSlots::begin_frame(std::uint32_t completed_frame) {
    completed_frame_ = completed_frame;
    std::erase_if(released_, [this](std::uint32_t square) {
        if (slots_[square].last_frame > completed_frame_) return false;
        released_units_ -= slots_[square].run.pages;
        free(square);
        return true;
    });
}

bool GpuSlots::room_is_coming(const io::ChunkView& chunk) const { return released_units_ >= units_of(chunk); }

GpuSlots::SquarePlace GpuSlots::square_place(std::uint32_t square) const {
    const int side = shape_.squares_per_side;
    const int in_layer = static_cast<int>(square) % (side * side);
    return {static_cast<int>(square) / (side * side), in_layer % side, in_layer / side};
}

GpuSlots::Place GpuSlots::place(pager::GpuSlot slot) const {
    const std::uint32_t square = index(slot);
    const std::uint64_t offset_bytes = slots_[square].run.first_page * kUnitBytes;
    const auto [layer, column, row] = square_place(square);
    return {.first_vertex = static_cast<std::uint32_t>(offset_bytes / sizeof(io::ChunkVertex)),
            .first_index = static_cast<std::uint32_t>(offset_bytes / sizeof(std::uint16_t)),
            .normals = static_cast<std::uint32_t>(layer << 16 | row << 8 | column),
            .mask_word = static_cast<std::uint32_t>(square * mask_words(shape_.quads))};
}

std::uint64_t GpuSlots::used_bytes() const {
    return runs_.used_pages() * kUnitBytes +
           (slots_.size() - free_.size()) * GpuSlotsShape::square_bytes(shape_.quads);
}

}  // namespace ridgeline::render
