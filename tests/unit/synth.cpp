#include "ridgeline/synth/synth.h"

#include <sys/resource.h>

#include <atomic>
#include <csignal>
#include <fstream>

#include "ridgeline/jobs/job_system.h"
#include "ridgeline/synth/ground_colours.h"
#include "ridgeline/synth/terrain.h"
#include "unit/raster_fixture.h"

using namespace ridgeline::synth;
using ridgeline::raster::TempFolder;

namespace {

std::string bytes_of(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

ridgeline::Result<void> run(const SynthOptions& options, int workers = 2) {
    ridgeline::jobs::JobSystem jobs({.workers = workers, .on_worker_start = {}, .on_worker_stop = {}});
    return synth(options, jobs);
}

std::size_t files_in(const TempFolder& folder) {
    const std::filesystem::directory_iterator entries(folder.file(""));
    return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
}

std::vector<float> heights(const Terrain& terrain, const SampleArea& area) {
    std::vector<float> values(static_cast<std::size_t>(area.columns * area.rows));
    terrain.fill(area, values);
    return values;
}

// Lets no file grow past a size while it lives.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

  private:
    void (*handler_)(int);
    rlimit before_{};
};

}  // namespace

TEST_CASE("a seed gives the same bytes on one worker and on three, another seed other bytes") {
    const TempFolder folder;
    REQUIRE(run({.size = 600, .seed = 4, .path = folder.file("one.tif")}, 1).ok());
    REQUIRE(run({.size = 600, .seed = 4, .path = folder.file("three.tif")}, 3).ok());
    REQUIRE(run({.size = 600, .seed = 5, .path = folder.file("other.tif")}, 3).ok());
    CHECK(bytes_of(folder.file("one.tif")) == bytes_of(folder.file("three.tif")));
    CHECK(bytes_of(folder.file("one.tif")) != bytes_of(folder.file("other.tif")));
    CHECK(files_in(folder) == 3);
}

TEST_CASE("a height depends on its place alone, not on the area it is asked for in") {
    const Terrain terrain({.size = 700, .spacing_m = 10.0f, .seed = 9});
    const auto whole = heights(terrain, {0, 0, 700, 700});
    std::mt19937 generator(1);
    for (int trial = 0; trial < 40; ++trial) {
        SampleArea area;
        area.columns = 1 + static_cast<int>(generator() % 90);
        area.rows = 1 + static_cast<int>(generator() % 90);
        area.column = static_cast<int>(generator() % static_cast<unsigned>(701 - area.columns));
        area.row = static_cast<int>(generator() % static_cast<unsigned>(701 - area.rows));
        const auto part = heights(terrain, area);
        bool same = true;
        for (int row = 0; row < area.rows; ++row)
            for (int column = 0; column < area.columns; ++column)
                same &= part[static_cast<std::size_t>(row * area.columns + column)] ==
                        whole[static_cast<std::size_t>((area.row + row) * 700 + area.column + column)];
        CHECK(same);
    }
}

TEST_CASE("the file is a metric DEM of the wanted size and spacing") {
    const TempFolder folder;
    REQUIRE(run({.size = 301, .spacing_m = 7.5, .path = folder.file("a.tif")}).ok());
    const auto source = ridgeline::raster::open_ok({folder.file("a.tif")});
    const auto& info = source.info();
    CHECK(info.width == 301);
    CHECK(info.height == 301);
    CHECK(info.spacing_x_m == 7.5);
    CHECK(info.spacing_y_m == 7.5);
    CHECK_FALSE(info.warped);
    CHECK(info.data_type == "Float32");
    CHECK(info.crs_wkt.find("UTM zone 33N") != std::string::npos);
    CHECK(info.west_east_m + 150 * 7.5 == doctest::Approx(500e3));
    CHECK(info.notes.empty());
    CHECK(files_in(folder) == 1);
}

TEST_CASE("mountains are mountains at every size: heights in range, in steps, with summits and low ground") {
    for (const int size : {2, 3, 65, 513, 1300}) {
        for (const std::uint64_t seed : {1ULL, 2ULL, 1ULL << 40}) {
            CAPTURE(size);
            CAPTURE(seed);
            const Terrain terrain({.size = size, .spacing_m = 10.0f, .seed = seed});
            const auto values = heights(terrain, {0, 0, size, size});
            const auto [low, high] = std::minmax_element(values.begin(), values.end());
            CHECK(*low > -50.0f);
            CHECK(*high < 3600.0f);
            CHECK(std::all_of(values.begin(), values.end(),
                              [](float height) { return height * 32.0f == std::floor(height * 32.0f); }));
            if (size < 513) continue;
            CHECK(*high - *low > 250.0f);
            // No cliff a mesh could not show: slopes stay below 75°.
            float steepest = 0.0f;
            for (std::size_t i = 1; i < values.size(); ++i)
                if (i % static_cast<std::size_t>(size) != 0)
                    steepest = std::max(steepest, std::abs(values[i] - values[i - 1]) / 10.0f);
            CHECK(steepest < 3.7f);
            CHECK(steepest > 0.5f);
        }
    }
}

TEST_CASE("what fails leaves nothing, and what stood there stands") {
    const TempFolder folder;
    const auto no_folder = run({.size = 65, .path = folder.file("absent/a.tif")});
    REQUIRE_FALSE(no_folder.ok());
    CHECK(no_folder.error().message.rfind(folder.file("absent/a.tif") + ": cannot be written: ", 0) == 0);

    std::ofstream(folder.file("a.tif")) << "stands";
    {
        const FileSizeLimit disk_full(40000);
        const auto full = run({.size = 513, .path = folder.file("a.tif"), .replace = Replace::existing});
        REQUIRE_FALSE(full.ok());
        CHECK(full.error().message.rfind(folder.file("a.tif") + ": cannot be written: ", 0) == 0);
    }
    const std::atomic<bool> stop = true;
    CHECK_FALSE(run({.size = 513, .path = folder.file("a.tif"), .stop = &stop}).ok());
    CHECK_FALSE(run({.size = 1, .path = folder.file("a.tif")}).ok());
    CHECK_FALSE(run({.spacing_m = -1.0, .path = folder.file("a.tif")}).ok());
    CHECK(bytes_of(folder.file("a.tif")) == "stands");
    CHECK(files_in(folder) == 1);
    std::filesystem::create_directory(folder.file("taken.tif"));
    CHECK_FALSE(run({.size = 65, .path = folder.file("taken.tif")}).ok());
    CHECK(files_in(folder) == 2);
}

TEST_CASE(
    "imagery: a seed gives the same bytes on one worker and on three, and leaves the heights as they are") {
    const TempFolder folder;
    SynthOptions options{.size = 200, .seed = 4, .path = folder.file("alone.tif")};
    REQUIRE(run(options).ok());
    for (const int workers : {1, 3}) {
        const std::string number = std::to_string(workers);
        options.path = folder.file("dem" + number + ".tif");
        options.imagery_path = folder.file("rgb" + number + ".tif");
        REQUIRE(run(options, workers).ok());
        CHECK(bytes_of(options.path) == bytes_of(folder.file("alone.tif")));
    }
    CHECK(bytes_of(folder.file("rgb1.tif")) == bytes_of(folder.file("rgb3.tif")));
    CHECK(files_in(folder) == 5);
}

TEST_CASE("imagery: a colour depends on its place alone, not on the area it is asked for in") {
    const TerrainOptions options{.size = 150, .spacing_m = 10.0f, .seed = 9};
    const Terrain terrain(options);
    const GroundColours ground(terrain, options, 3);
    const int side = static_cast<int>(GroundColours::side(150, 3));
    const auto colours = [&](const SampleArea& area) {
        std::vector<std::uint8_t> values(static_cast<std::size_t>(area.columns * area.rows) * kColourBytes);
        ground.fill(area, values);
        return values;
    };
    const auto whole = colours({0, 0, side, side});
    std::mt19937 generator(1);
    for (int trial = 0; trial < 40; ++trial) {
        SampleArea area;
        area.columns = 1 + static_cast<int>(generator() % 90);
        area.rows = 1 + static_cast<int>(generator() % 90);
        area.column = static_cast<int>(generator() % static_cast<unsigned>(side + 1 - area.columns));
        area.row = static_cast<int>(generator() % static_cast<unsigned>(side + 1 - area.rows));
        const auto part = colours(area);
        bool same = true;
        for (int row = 0; row < area.rows; ++row)
            for (int i = 0; i < 3 * area.columns; ++i)
                same &= part[static_cast<std::size_t>(3 * row * area.columns + i)] ==
                        whole[static_cast<std::size_t>(3 * ((area.row + row) * side + area.column) + i)];
        CHECK(same);
    }
}

TEST_CASE("imagery: its texels have their centres on the samples, and of all ground there is some") {
    const TempFolder folder;
    REQUIRE(run({.size = 301,
                 .spacing_m = 7.5,
                 .path = folder.file("a.tif"),
                 .imagery_path = folder.file("rgb.tif"),
                 .imagery_ratio = 2})
                .ok());
    const GDALDatasetUniquePtr dem(GDALDataset::Open(folder.file("a.tif").c_str()));
    const GDALDatasetUniquePtr rgb(GDALDataset::Open(folder.file("rgb.tif").c_str()));
    REQUIRE(rgb);
    CHECK(rgb->GetRasterXSize() == 601);
    CHECK(rgb->GetRasterCount() == 3);
    CHECK(rgb->GetRasterBand(3)->GetColorInterpretation() == GCI_BlueBand);
    std::array<double, 6> ours{}, theirs{};
    rgb->GetGeoTransform(ours.data());
    dem->GetGeoTransform(theirs.data());
    CHECK(ours[1] == 3.75);
    CHECK(ours[0] + ours[1] / 2 == doctest::Approx(theirs[0] + theirs[1] / 2).epsilon(1e-12));
    CHECK(ours[3] + ours[5] / 2 == doctest::Approx(theirs[3] + theirs[5] / 2).epsilon(1e-12));
    std::vector<std::uint8_t> colours(601 * 601 * 3);
    REQUIRE(rgb->RasterIO(GF_Read, 0, 0, 601, 601, colours.data(), 601, 601, GDT_Byte, 3, nullptr, 3, 3 * 601,
                          1, nullptr) == CE_None);
    int green = 0, snow = 0;
    for (std::size_t i = 0; i < colours.size(); i += 3) {
        green += colours[i + 1] > colours[i] && colours[i + 1] > colours[i + 2] ? 1 : 0;
        snow += colours[i] > 225 && colours[i + 2] > 225 ? 1 : 0;
    }
    CHECK(green > 601 * 601 / 5);
    CHECK(snow > 601 * 601 / 200);
}

TEST_CASE("imagery: what stands in its way stops both files") {
    const TempFolder folder;
    std::ofstream(folder.file("rgb.tif")) << "stands";
    const SynthOptions options{
        .size = 65, .path = folder.file("a.tif"), .imagery_path = folder.file("rgb.tif")};
    CHECK_FALSE(run(options).ok());
    CHECK_FALSE(run({.size = 65, .path = folder.file("a.tif"), .imagery_path = folder.file("a.tif")}).ok());
    CHECK(bytes_of(folder.file("rgb.tif")) == "stands");
    CHECK(files_in(folder) == 1);
}

TEST_CASE("progress counts every row once, in order") {
    const TempFolder folder;
    ridgeline::jobs::JobSystem jobs;
    std::vector<std::int64_t> done;
    REQUIRE(
        synth({.size = 600, .path = folder.file("a.tif")}, jobs, [&](std::int64_t rows, std::int64_t all) {
            CHECK(all == 600);
            done.push_back(rows);
        }).ok());
    CHECK(done == std::vector<std::int64_t>{256, 512, 600});
}
