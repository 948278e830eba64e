#include <fcntl.h>

#include <fstream>

#include "support/data.h"
#include "unit/raster_fixture.h"

using namespace ridgeline::raster;

namespace {

// Reads a source to its end, in the representation it offers.
ridgeline::Result<void> read_all(DemSource& source) {
    const RasterInfo& info = source.info();
    const std::int64_t most_rows = std::max<std::int64_t>(1, (std::int64_t{1} << 20) / info.width);
    std::vector<double> heights;
    std::vector<std::int32_t> steps;
    for (std::int64_t row = 0; row < info.height; row += most_rows) {
        const std::int64_t rows = std::min(most_rows, info.height - row);
        const auto samples = static_cast<std::size_t>(rows * info.width);
        heights.resize(samples);
        RIDGELINE_TRY(source.read_rows(row, rows, heights));
        if (!info.integer_heights) continue;
        steps.resize(samples);
        RIDGELINE_TRY(source.read_steps(row, rows, steps));
    }
    return {};
}

// Opens and reads; the error, or an empty string.
std::string complaint(const std::vector<std::string>& paths, const RasterOptions& options = {}) {
    auto source = DemSource::open(paths, options);
    if (!source) return source.error().message;
    const auto read = read_all(*source);
    return read ? "" : read.error().message;
}

void check_names_file(const std::string& message, const std::string& path) {
    CAPTURE(message);
    CHECK(message.rfind(path + ": ", 0) == 0);
    CHECK(message.find('\n') == std::string::npos);
}

// Overwrites the beginning of a block, so that it does not unpack; damage further in may go unnoticed: libtiff
// does not look at the checksum behind packed bytes.
void break_block(const std::string& path, int column, int row) {
    std::string offset;
    {
        const GDALDatasetUniquePtr dataset(GDALDataset::Open(path.c_str()));
        const std::string item = "BLOCK_OFFSET_" + std::to_string(column) + "_" + std::to_string(row);
        offset = dataset->GetRasterBand(1)->GetMetadataItem(item.c_str(), "TIFF");
    }
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(std::stol(offset));
    file << std::string(200, '\xff') << std::flush;
    REQUIRE(file.good());
}

// What a block of code writes to stderr.
class CapturedStderr {
  public:
    explicit CapturedStderr(const std::string& path) : path_(path), saved_(dup(2)) {
        const int file = ::open(path.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
        dup2(file, 2);
        close(file);
    }
    std::string finish() {
        dup2(saved_, 2);
        close(saved_);
        std::ifstream in(path_);
        return {std::istreambuf_iterator<char>(in), {}};
    }

  private:
    std::string path_;
    int saved_;
};

}  // namespace

TEST_CASE(
    "a file cut at any length is refused by name or reads as what it was; never zeros, never noise on "
    "stderr") {
    const TempFolder folder;
    CapturedStderr noise(folder.file("stderr"));
    std::vector<std::string> wrong;
    for (const bool tiled : {false, true}) {
        Spec spec{.width = 64, .height = 64};
        spec.values = random_values(64 * 64, 1, 3000, 5);
        spec.creation = {"COMPRESS=DEFLATE", "PREDICTOR=2"};
        if (tiled) spec.creation.insert(spec.creation.end(), {"TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16"});
        const std::string whole = write_raster(folder.file("whole.tif"), spec);
        const auto size = std::filesystem::file_size(whole);
        const std::string cut = folder.file("cut.tif");
        for (std::uintmax_t length = 0; length < size; length += 97) {
            std::filesystem::copy_file(whole, cut, std::filesystem::copy_options::overwrite_existing);
            std::filesystem::resize_file(cut, length);
            for (const int threads : {1, 2}) {
                auto source = DemSource::open({cut}, {.threads = threads});
                if (!source) continue;
                std::vector<double> heights(64 * 64);
                if (source->info().width != 64 || !source->read_rows(0, 64, heights)) continue;
                if (heights != spec.values) wrong.push_back(std::to_string(length));
            }
        }
    }
    CHECK(noise.finish() == "");
    CHECK(wrong.empty());
}

TEST_CASE("a damaged file is named in its error, alone, in a mosaic and under a warp") {
    const TempFolder folder;
    Spec spec{.width = 64, .height = 64, .values = random_values(64 * 64, 1, 3000, 5)};
    spec.transform = std::array<double, 6>{8, 0.001, 0, 47, 0, -0.001};
    spec.crs = "EPSG:4326";
    spec.creation = {"COMPRESS=DEFLATE"};
    const std::string good = write_raster(folder.file("good.tif"), spec);
    const std::string bad = folder.file("bad.tif");
    spec.transform = std::array<double, 6>{8.064, 0.001, 0, 47, 0, -0.001};
    write_raster(bad, spec);
    // The directory stands before the data: what is cut off is heights.
    std::filesystem::resize_file(bad, std::filesystem::file_size(bad) / 2);
    check_names_file(complaint({bad}), bad);
    check_names_file(complaint({good, bad}), bad);
    check_names_file(complaint({good, bad}, {.threads = 3}), bad);
    CHECK(complaint({good}).empty());
}

TEST_CASE("a block that does not unpack is never heights, on any number of threads, plain and under a warp") {
    const TempFolder folder;
    Spec spec{.width = 600, .height = 600, .values = random_values(600 * 600, 1, 3000, 5)};
    spec.type = GDT_Float32;
    spec.creation = {"COMPRESS=DEFLATE", "PREDICTOR=3", "TILED=YES"};
    const std::string bad = write_raster(folder.file("bad.tif"), spec);
    break_block(bad, 1, 1);
    for (const int threads : {1, 2, 3}) {
        CAPTURE(threads);
        check_names_file(complaint({bad}, {.threads = threads}), bad);
        check_names_file(complaint({bad}, {.crs = "EPSG:32632", .threads = threads}), bad);
    }
}

TEST_CASE("what is missing, no raster, or empty is refused by name") {
    const TempFolder folder;
    check_names_file(complaint({folder.file("absent.tif")}), folder.file("absent.tif"));
    std::ofstream(folder.file("words.txt")) << "no raster\n";
    check_names_file(complaint({folder.file("words.txt")}), folder.file("words.txt"));
    std::ofstream(folder.file("empty.tif"));
    check_names_file(complaint({folder.file("empty.tif")}), folder.file("empty.tif"));
    std::ofstream(folder.file("no.zip")) << "PK";
    check_names_file(complaint({folder.file("no.zip")}), folder.file("no.zip"));
    CHECK(complaint({}) == "no raster is given");
}

TEST_CASE("a sparse file reads as its nodata; one that declares terabytes and holds nothing is refused") {
    const TempFolder folder;
    Spec spec{.width = 512, .height = 512, .creation = {"TILED=YES", "SPARSE_OK=TRUE"}, .nodata = -1.0};
    DemSource sparse = open_ok({write_raster(folder.file("sparse.tif"), spec)});
    const auto heights = all_heights(sparse);
    CHECK(std::all_of(heights.begin(), heights.end(), [](double height) { return std::isnan(height); }));

    spec.width = spec.height = 60000;
    const std::string hollow = write_raster(folder.file("hollow.tif"), spec);
    check_names_file(complaint({hollow}), hollow);
}

TEST_CASE("a zip archive is read through when it holds one raster") {
    const TempFolder folder;
    const std::string inner = write_raster(folder.file("a.tif"), {.values = ramp(12)});
    const auto add = [&](const std::string& zip, const std::string& name) {
        CPLStringList append;
        append.SetNameValue("APPEND", "TRUE");
        void* handle = CPLCreateZip(zip.c_str(), std::filesystem::exists(zip) ? append.List() : nullptr);
        REQUIRE(handle != nullptr);
        std::ifstream in(inner, std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(in), {}};
        REQUIRE(CPLCreateFileInZip(handle, name.c_str(), nullptr) == CE_None);
        REQUIRE(CPLWriteFileInZip(handle, bytes.data(), static_cast<int>(bytes.size())) == CE_None);
        CPLCloseFileInZip(handle);
        CPLCloseZip(handle);
    };
    const std::string zip = folder.file("one.zip");
    add(zip, "deep/a.tif");
    DemSource source = open_ok({zip});
    CHECK(same_heights(all_heights(source), ramp(12)));
    add(zip, "b.tif");
    check_names_file(complaint({zip}), zip);
    CHECK(complaint({zip}).find("2 rasters") != std::string::npos);
}

TEST_CASE("odd and broken files of GDAL's own tests open and read, or are refused in one line") {
    const auto index = ridgeline::test::data_file("odd/INDEX.tsv");
    if (index.empty()) return;
    const TempFolder folder;
    CapturedStderr noise(folder.file("stderr"));
    std::vector<std::string> unclear;
    int read = 0;
    int refused = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(index.parent_path())) {
        if (!entry.is_regular_file() || entry.path().extension() != ".tif") continue;
        const std::string path = entry.path().string();
        const std::string message = complaint({path});
        ++(message.empty() ? read : refused);
        if (message.empty()) continue;
        if (message.rfind(path + ": ", 0) != 0 || message.find('\n') != std::string::npos)
            unclear.push_back(message);
    }
    CHECK(noise.finish() == "");
    CHECK(unclear == std::vector<std::string>{});
    CHECK(read >= 70);
    CHECK(refused >= 10);
}

TEST_CASE("real terrain reads as its provenance says") {
    const auto hgt = ridgeline::test::data_file("voids/elbrus_N43E042.hgt.zip");
    if (!hgt.empty()) {
        DemSource elbrus = open_ok({hgt.string()});
        const auto heights = all_heights(elbrus, 128);
        double highest = 0;
        for (const double height : heights) highest = std::fmax(highest, height);
        CHECK(highest == doctest::Approx(5620).epsilon(0.005));
        CHECK(elbrus.counts().nodata > 0);
    }
    const auto crater = ridgeline::test::data_file("crater_lake/craterlake-elev-16bit-30m.tif");
    if (crater.empty()) return;
    DemSource undeclared = open_ok({crater.string()});
    all_heights(undeclared);
    CHECK(says(undeclared.info().notes, "undeclared nodata"));
    DemSource declared = open_ok({crater.string()}, {.nodata = -32767.0});
    const auto heights = all_heights(declared);
    CHECK(declared.findings().empty());
    CHECK(std::none_of(heights.begin(), heights.end(), [](double height) { return height < 1000.0; }));
}
