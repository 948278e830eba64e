#include "dem_source.h"

#include <algorithm>
#include <cmath>

#include "gdal_session.h"
#include "plan.h"
#include "source_file.h"

namespace ridgeline::raster {

struct DemSource::State {
    std::shared_ptr<SourceContext> context = std::make_shared<SourceContext>();
    std::shared_ptr<HeightGrid> grid;
    RasterInfo info;
};

namespace {

void describe_place(const PlacedGrid& joined, RasterInfo& info) {
    const Placement& placement = joined.placement;
    info.width = std::max<std::int64_t>(2, placement.width);
    info.height = std::max<std::int64_t>(2, placement.height);
    info.spacing_x_m = placement.spacing_x();
    info.spacing_y_m = placement.spacing_y();
    info.west_east_m = placement.world_from_pixel[0] + info.spacing_x_m / 2;
    info.north_north_m = placement.world_from_pixel[3] - info.spacing_y_m / 2;
    info.georeferenced = placement.georeferenced;
    // Pixel units count from the bottom row, which a doubled row has below it.
    if (!placement.georeferenced) info.north_north_m = static_cast<double>(info.height - 1);
    info.crs_wkt = wkt_of(placement.crs);
    info.warped = joined.warped;
}

void describe_heights(const HeightGrid& grid, RasterInfo& info) {
    const HeightFormat format = grid.format();
    info.integer_heights = format.integer;
    if (format.integer) {
        info.step_m = format.step_m;
        info.offset_m = format.offset_m;
    }
    info.may_have_nodata = format.may_have_nodata;
    info.natural_rows = std::min(grid.natural_rows(), info.height);
    if (grid.width() == 1) info.notes.push_back("a single column: it is doubled, one spacing on");
    if (grid.height() == 1) info.notes.push_back("a single row: it is doubled, one spacing on");
}

// A note that every source has is said once; others name their source.
void gather_notes(const std::vector<std::shared_ptr<SourceFile>>& files, std::vector<std::string>& notes) {
    for (const auto& file : files) {
        for (const std::string& note : file->notes()) {
            const bool common = std::all_of(files.begin(), files.end(), [&note](const auto& other) {
                return std::find(other->notes().begin(), other->notes().end(), note) != other->notes().end();
            });
            const std::string line = common ? note : file->path() + ": " + note;
            if (std::find(notes.begin(), notes.end(), line) == notes.end()) notes.push_back(line);
        }
    }
}

// Reads the grid's row under each asked-for row, doubling a single row or column.
template <class T, class Read>
Result<void> read_doubled(const HeightGrid& grid, std::int64_t width, std::int64_t rows, const Window& window,
                          std::span<T> target, Read&& read) {
    std::vector<T> row_values(static_cast<std::size_t>(window.samples()));
    RIDGELINE_TRY(read(window, std::span<T>(row_values)));
    for (std::int64_t row = 0; row < rows; ++row)
        for (std::int64_t column = 0; column < width; ++column) {
            const std::int64_t from_row = std::min(row, window.rows - 1);
            const std::int64_t from_column = std::min(column, grid.width() - 1);
            target[static_cast<std::size_t>(row * width + column)] =
                row_values[static_cast<std::size_t>(from_row * window.columns + from_column)];
        }
    return {};
}

template <class T, class Read>
Result<void> read_grid(const HeightGrid& grid, const RasterInfo& info, std::int64_t row, std::int64_t rows,
                       std::span<T> target, Read&& read) {
    RIDGELINE_CHECK(row >= 0 && rows >= 0 && row + rows <= info.height);
    RIDGELINE_CHECK(static_cast<std::int64_t>(target.size()) == rows * info.width);
    if (rows == 0) return {};
    if (grid.width() == info.width && grid.height() == info.height)
        return read({0, row, info.width, rows}, target);
    const std::int64_t first = std::min(row, grid.height() - 1);
    const std::int64_t last = std::min(row + rows, grid.height());
    const Window window{0, first, grid.width(), std::max<std::int64_t>(1, last - first)};
    return read_doubled(grid, info.width, rows, window, target, read);
}

}  // namespace

DemSource::DemSource(std::unique_ptr<State> state) : state_(std::move(state)) {}
DemSource::DemSource(DemSource&&) noexcept = default;
DemSource& DemSource::operator=(DemSource&&) noexcept = default;
DemSource::~DemSource() = default;

Result<DemSource> DemSource::open(const std::vector<std::string>& paths, const RasterOptions& options) {
    if (paths.empty()) return Error{"no raster is given"};
    prepare_gdal(options.cache_bytes);
    const GdalMessages quiet;
    auto state = std::make_unique<State>();
    state->context->options = options;
    std::vector<std::shared_ptr<SourceFile>> files;
    std::vector<PlacedGrid> sources;
    for (const std::string& path : paths) {
        auto file = SourceFile::open(path, state->context);
        if (!file) return file.error();
        files.push_back(*file);
        sources.push_back({*file, (*file)->placement(), path, false});
    }
    RasterInfo& info = state->info;
    info.sources = paths;
    info.driver = files.front()->driver();
    info.data_type = files.front()->data_type();
    gather_notes(files, info.notes);
    auto joined = join(std::move(sources), {options.crs, options.threads}, info.notes);
    if (!joined) return joined.error();
    state->grid = joined->grid;
    describe_place(*joined, info);
    describe_heights(*state->grid, info);
    return DemSource(std::move(state));
}

const RasterInfo& DemSource::info() const { return state_->info; }

Result<void> DemSource::read_rows(std::int64_t row, std::int64_t rows, std::span<double> heights_m) {
    RIDGELINE_TRY(read_grid(*state_->grid, state_->info, row, rows, heights_m,
                            [this](const Window& window, std::span<double> into) {
                                return state_->grid->read_heights(window, into);
                            }));
    state_->context->counts.samples += heights_m.size();
    state_->context->counts.nodata += static_cast<std::uint64_t>(std::count_if(
        heights_m.begin(), heights_m.end(), [](double height_m) { return std::isnan(height_m); }));
    return {};
}

Result<void> DemSource::read_steps(std::int64_t row, std::int64_t rows, std::span<std::int32_t> steps) {
    RIDGELINE_CHECK(state_->info.integer_heights);
    RIDGELINE_TRY(read_grid(*state_->grid, state_->info, row, rows, steps,
                            [this](const Window& window, std::span<std::int32_t> into) {
                                return state_->grid->read_steps(window, into);
                            }));
    state_->context->counts.samples += steps.size();
    state_->context->counts.nodata +=
        static_cast<std::uint64_t>(std::count(steps.begin(), steps.end(), kNoStep));
    return {};
}

const ReadCounts& DemSource::counts() const { return state_->context->counts; }

std::vector<std::string> DemSource::findings() const {
    const ReadCounts& counts = state_->context->counts;
    std::vector<std::string> found;
    if (counts.not_finite > 0)
        found.push_back(std::to_string(counts.not_finite) +
                        " samples are infinite or not a number: taken as nodata");
    if (counts.out_of_range > 0)
        found.push_back(std::to_string(counts.out_of_range) +
                        " samples lie beyond 1000 km of height: taken as nodata");
    // Where real ground comes anywhere near them (ocean floors), they may be ground as well.
    constexpr double kDeepGround_m = -5000.0;
    if (counts.suspect > 0 && state_->context->lowest_unsuspected_m > kDeepGround_m)
        found.push_back(
            std::to_string(counts.suspect) +
            " samples are -9999, -32767 or -32768, which looks like undeclared nodata: use --nodata");
    return found;
}

}  // namespace ridgeline::raster
