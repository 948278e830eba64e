// Imagery on the ground: every pixel shows the texel that its place on the ground has, whatever is resident.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <random>

#include "gl/render_scene.h"
#include "gl/shown_blocks.h"
#include "ridgeline/base/log.h"
#include "ridgeline/render/frame_uniforms.h"
#include "ridgeline/render/imagery_texture.h"
#include "ridgeline/shaders/lib/color.h"
#include "ridgeline/shaders/lib/display.h"
#include "ridgeline/shaders/lib/terrain_shading.h"
#include "support/small_imagery.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

constexpr glm::ivec2 kSize(320, 240);
constexpr double kGround_m = 20.0;

// A lattice that matches neither the terrain's samples nor its corner.
io::ImageryInfo askew_frame(const io::TerrainInfo& terrain) {
    io::ImageryInfo frame;
    frame.west_m = terrain.min_east_m() - 3.37;
    frame.north_m = terrain.max_north_m() + 2.71;
    frame.spacing_x_m = 0.25;
    frame.spacing_y_m = 0.3;
    frame.width = 1061;
    frame.height = 890;
    return frame;
}

// Every texel differs from its neighbours, and from those of other tiles.
build::Texel speckled(std::int64_t x, std::int64_t y) {
    std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL ^
                      static_cast<std::uint64_t>(y) * 0xbf58476d1ce4e5b9ULL;
    h = (h ^ (h >> 31)) * 0x94d049bb133111ebULL;
    const auto channel = [&](int shift) { return static_cast<std::uint8_t>(40 + (h >> shift) % 180); };
    return {channel(16), channel(28), channel(40), build::kOpaque};
}

SceneOptions with_imagery(const MemoryTexels::Colour& colour, bool flat) {
    SceneOptions options;
    if (flat)
        options.quanta = [](std::int64_t, std::int64_t) { return static_cast<std::int32_t>(kGround_m); };
    options.finish_store = [colour](const std::filesystem::path& directory) {
        const auto info = io::read_terrain_info(directory);
        REQUIRE(info);
        MemoryTexels texels(askew_frame(*info), colour);
        add_imagery(directory, texels);
    };
    options.stage.frame.size_px = kSize;
    options.stage.wait = app::TileWait::settle;
    return options;
}

app::StageMoment look_down(const glm::dvec3& eye_m, double heading_deg) {
    app::StageMoment moment;
    moment.camera.lens.size_px = kSize;
    moment.camera.pose = {eye_m, Angle::from_degrees(heading_deg), Angle::from_degrees(-90.0)};
    moment.background = render::PlainBackground{255, 0, 255};
    return moment;
}

// The store's tiles as this GPU shows their texels, filtered in linear light in double precision.
class ImageryReference {
  public:
    explicit ImageryReference(const io::Store& store) : store_(store), info_(*store.info().imagery) {}

    // Bilinear at a place, so many of the mip's texels beside it; `mip` of the level's own tiles, as a lookup
    // has it.
    glm::dvec3 sample(const glm::dvec2& place_m, int level, int mip, const glm::dvec2& beside) {
        const double texels = std::ldexp(1.0, level - info_.grid().finest());
        const glm::dvec2 at = info_.texel(place_m.x, place_m.y) * texels;
        const io::NodeId node{level, static_cast<int>(at.x / 256.0), static_cast<int>(at.y / 256.0)};
        const glm::dvec2 in_tile =
            (at - 256.0 * glm::dvec2(node.x, node.y)) / std::ldexp(1.0, mip) - 0.5 + beside;
        const glm::dvec2 first = glm::floor(in_tile), share = in_tile - first;
        glm::dvec3 sum(0.0);
        for (int dy = 0; dy < 2; ++dy)
            for (int dx = 0; dx < 2; ++dx) {
                const double weight = (dx ? share.x : 1.0 - share.x) * (dy ? share.y : 1.0 - share.y);
                sum +=
                    weight * texel(node, mip, static_cast<int>(first.x) + dx, static_cast<int>(first.y) + dy);
            }
        return sum;
    }
    const io::ImageryInfo& info() const { return info_; }

  private:
    // A tile's two mips, gutters and all.
    struct Tile {
        std::vector<glm::dvec3> whole, half;
    };

    // Column and row from the content's corner.
    const glm::dvec3& texel(io::NodeId node, int mip, int column, int row) {
        const Tile& shown = tile(node);
        const auto& texels = mip == 0 ? shown.whole : shown.half;
        const int gutter = io::kImageryGutter >> mip,
                  side = mip == 0 ? io::kImageryTexels : io::kImageryMipTexels;
        return texels[static_cast<std::size_t>((row + gutter) * side + column + gutter)];
    }
    const Tile& tile(io::NodeId node) {
        Tile& shown = tiles_[node];
        if (!shown.whole.empty()) return shown;
        const auto blocks = read_tile(store_, node);
        const auto all = std::span<const io::Bc1Block>(blocks);
        constexpr std::size_t kWhole = std::size_t{io::kImageryBlocks} * io::kImageryBlocks;
        shown.whole = blocks_.linear(all.first(kWhole), io::kImageryBlocks);
        shown.half = blocks_.linear(all.subspan(kWhole), io::kImageryMipBlocks);
        return shown;
    }

    ShownBlocks blocks_;
    const io::Store& store_;
    io::ImageryInfo info_;
    std::map<io::NodeId, Tile> tiles_;
};

// What the shader makes of a picture's colour at a pixel of a flat ground, before it is rounded: 0 to 255.
glm::dvec3 displayed(const shaders::FrameUniforms& frame, const glm::dvec3& position_m,
                     const glm::dvec3& picture) {
    const shaders::GroundPoint point{glm::vec3(position_m), {0, 0, 1},      0.0f, 1.0f,
                                     glm::vec3(0.5f),       glm::vec3(0.5f)};
    const glm::vec3 radiance =
        shaders::pictured_radiance(frame, point, glm::vec4(glm::vec3(picture), 1.0f), 0.0f);
    return glm::dvec3(shaders::srgb_from_linear(shaders::tone_map(radiance))) * 255.0;
}

glm::dvec3 pixel(const gl::Image& image, int x, int y) {
    const std::size_t at = 3 * static_cast<std::size_t>(y * image.size_px.x + x);
    return {std::to_integer<int>(image.rgb[at]), std::to_integer<int>(image.rgb[at + 1]),
            std::to_integer<int>(image.rgb[at + 2])};
}

struct Misses {
    int pixels = 0;
    double worst = 0.0;
};

// Where GPUs may sample instead of a place, in texels: weights have 8 bits, and along the longer side of a
// pixel's print a sampler takes several samples that no standard places, all within the print's half.
std::vector<glm::dvec2> sampled_beside(const glm::dvec2& print_texels) {
    std::vector<double> along{0.0};
    if (!gl::query_capabilities().software && print_texels.x > 1.0)
        for (const double share : {-0.25, -0.125, 0.125, 0.25}) along.push_back(share * print_texels.x);
    std::vector<glm::dvec2> places;
    for (const double x : along)
        for (const double weight_x : {-1.0, 1.0})
            for (const double weight_y : {-1.0, 1.0})
                places.push_back({x + weight_x / 256.0, weight_y / 256.0});
    return places;
}

// Compares settled pictures straight down with the reference, pixel by pixel: between what the two mips
// beside the pixel's width have there. GPUs may weigh the two as they like.
class PictureCheck {
  public:
    PictureCheck(RenderScene& scene, ImageryReference& reference, const app::StageMoment& moment)
        : reference_(reference), camera_(moment.camera) {
        scene.stage().show(moment);
        image_ = gl::read_image(scene.stage().target());
        frame_ = render::frame_uniforms(
            {camera_, scene.stage().selection().eye, 1.0, moment.daylight, moment.background}, scene.info());
        tangents_ = platform::half_tangents(camera_.lens);
        height_m_ = camera_.pose.eye_m.z - kGround_m;
        const io::ImageryInfo& info = reference.info();
        const glm::dvec2 print =
            2.0 * tangents_.x * height_m_ / kSize.x / glm::dvec2(info.spacing_x_m, info.spacing_y_m);
        // As the shader has it: by the longer side of the print, unless that is eight times the other.
        const double coarseness = std::log2(std::min(print.x, print.y));
        const int finest = info.grid().finest();
        const int coarser = std::clamp(static_cast<int>(std::floor(coarseness + 0.02)), 0, finest);
        level_ = finest - coarser;
        mips_ = coarseness > 0.02 ? 2 : 1;
        for (int mip = 0; mip < mips_; ++mip)
            beside_.push_back(sampled_beside(print / std::ldexp(1.0, coarser + mip)));
    }

    Misses misses() {
        Misses misses;
        for (int y = 0; y < kSize.y; ++y)
            for (int x = 0; x < kSize.x; ++x) {
                const double most = off(x, y);
                misses.pixels += most > 0.0;
                misses.worst = std::max(misses.worst, most);
            }
        return misses;
    }

  private:
    struct Range {
        glm::dvec3 low{255.0}, high{0.0};
        // How far beyond so many steps of it.
        double off(const glm::dvec3& found, double steps) const {
            const glm::dvec3 by =
                glm::max(glm::max(low - steps - found, found - high - steps), glm::dvec3(0.0));
            return std::max({by.x, by.y, by.z});
        }
    };

    void take_in(Range& range, const glm::dvec3& position_m, int mip, const glm::dvec2& beside) {
        const glm::dvec2 place(camera_.pose.eye_m + position_m);
        const glm::dvec3 shown = displayed(frame_, position_m, reference_.sample(place, level_, mip, beside));
        range.low = glm::min(range.low, shown);
        range.high = glm::max(range.high, shown);
    }

    double off(int x, int y) {
        const glm::dvec2 ndc((x + 0.5) / kSize.x * 2.0 - 1.0, 1.0 - (y + 0.5) / kSize.y * 2.0);
        const glm::dvec3 ray = platform::forward(camera_.pose) +
                               platform::right(camera_.pose) * (ndc.x * tangents_.x) +
                               platform::up(camera_.pose) * (ndc.y * tangents_.y);
        const glm::dvec3 position_m = ray * (height_m_ / -ray.z);
        const io::ImageryInfo& info = reference_.info();
        const glm::dvec2 place(camera_.pose.eye_m + position_m);
        const glm::dvec2 cell = info.texel(place.x, place.y);
        if (cell.x < 1.0 || cell.y < 1.0 || cell.x > info.width - 1.0 || cell.y > info.height - 1.0)
            return 0.0;
        const glm::dvec3 found = pixel(image_, x, y);
        if (found == glm::dvec3(255, 0, 255)) return 0.0;
        Range range;
        for (int mip = 0; mip < mips_; ++mip) take_in(range, position_m, mip, {});
        // A step for the rounding.
        if (range.off(found, 1.0) == 0.0) return 0.0;
        // However the colours change here, two more are all that software's weights may cost.
        const double at_place = gl::query_capabilities().software ? range.off(found, 3.0) : 0.0;
        for (int mip = 0; mip < mips_; ++mip)
            for (const glm::dvec2& beside : beside_[static_cast<std::size_t>(mip)])
                take_in(range, position_m, mip, beside);
        return std::max(at_place, range.off(found, 1.0));
    }

    ImageryReference& reference_;
    platform::Camera camera_;
    gl::Image image_;
    shaders::FrameUniforms frame_;
    glm::dvec2 tangents_;
    double height_m_ = 0.0;
    int level_ = 0, mips_ = 1;
    std::vector<std::vector<glm::dvec2>> beside_;  // of each mip
};

}  // namespace

// EXT_texture_compression_s3tc gives the exact mix; GPUs round it, and their sRGB tables, each in its way.
TEST_CASE("a GPU shows the colours that a block has, nearly") {
    GlContext gl;
    if (!gl) return;
    constexpr int kSide = 16;
    std::mt19937 random(5);
    std::vector<io::Bc1Block> blocks(kSide * kSide);
    for (io::Bc1Block& block : blocks) {
        block.first = static_cast<std::uint16_t>(random());
        block.second = static_cast<std::uint16_t>(random());
        block.indices = static_cast<std::uint32_t>(random());
    }
    const auto shown = ShownBlocks().linear(blocks, kSide);
    double worst = 0.0;
    for (int y = 0; y < 4 * kSide; ++y)
        for (int x = 0; x < 4 * kSide; ++x) {
            const build::Texel texel =
                texel_of_block(blocks[static_cast<std::size_t>(y / 4 * kSide + x / 4)], y % 4 * 4 + x % 4);
            const glm::vec3 found(shown[static_cast<std::size_t>(y * 4 * kSide + x)]);
            const glm::vec3 off =
                shaders::srgb_from_linear(found) * 255.0f - glm::vec3(texel.red, texel.green, texel.blue);
            for (int channel = 0; channel < 3; ++channel)
                worst = std::max(worst, static_cast<double>(std::abs(off[channel])));
        }
    CAPTURE(worst);
    // An H100 was seen to be 6.1 off.
    CHECK(worst <= (gl::query_capabilities().software ? 1.5 : 7.0));
}

TEST_CASE(
    "each pixel of a view straight down shows the texel of its place, at every level and across tiles' "
    "borders") {
    GlContext gl;
    if (!gl) return;
    RenderScene scene(with_imagery(speckled, true));
    REQUIRE(scene.stage().has_imagery());
    ImageryReference reference(scene.store());
    const double tangent = platform::half_tangents({.size_px = kSize}).x;
    // Of pixels to a texel: magnified, a texel each, and far enough for every coarser level.
    for (const double texels_per_pixel : {0.11, 0.3, 1.0, 1.5, 2.0, 3.1, 4.0, 6.0}) {
        const double height_m = texels_per_pixel * 0.25 * kSize.x / (2.0 * tangent);
        for (const auto& [column, row, heading] :
             {std::array{61.0, 74.5, 0.0}, std::array{60.3, 74.4, 90.0}, std::array{128.2, 100.7, 180.0}}) {
            const auto moment = look_down(scene.place(column, row, kGround_m + height_m), heading);
            const Misses misses = PictureCheck(scene, reference, moment).misses();
            CAPTURE(texels_per_pixel);
            CAPTURE(column);
            CHECK(misses.pixels == 0);
            CHECK(misses.worst == 0.0);
        }
    }
}

namespace {

// Pixels of ground that are not blue, which the imagery is all over and the tint nowhere.
int pixels_without_imagery(const gl::Image& image) {
    int count = 0;
    for (int y = 0; y < image.size_px.y; ++y)
        for (int x = 0; x < image.size_px.x; ++x) {
            const glm::dvec3 found = pixel(image, x, y);
            count += found != glm::dvec3(255, 0, 255) && found.z < 1.5 * std::max(found.x, found.y);
        }
    return count;
}

build::Texel blue(std::int64_t x, std::int64_t y) {
    return {0, static_cast<std::uint8_t>((x / 8 + y / 8) % 2 * 20), 220, build::kOpaque};
}

// Somewhere over the ground, looking anywhere, from one of three turned directions of light.
app::StageMoment anywhere(RenderScene& scene, std::mt19937& random, int frame) {
    const auto within = [&](double least, double most) {
        return std::uniform_real_distribution(least, most)(random);
    };
    app::StageMoment moment = look_down({}, within(0.0, 360.0));
    const double column = within(10.0, 246.0), row = within(10.0, 240.0);
    moment.camera.pose.eye_m =
        scene.place(column, row, scene.surface_m(column, row) + std::exp(within(0.7, 6.0)));
    moment.camera.pose.pitch = Angle::from_degrees(within(-90.0, 5.0));
    moment.number = static_cast<std::uint64_t>(frame);
    moment.now = pager::Seconds(frame / 60.0);
    moment.daylight.sun_elevation = Angle::from_degrees(60.0);
    return moment;
}

}  // namespace

TEST_CASE(
    "ground is never without its imagery, whatever is missing, late, damaged or has no room; caches keep "
    "their bytes") {
    GlContext gl;
    if (!gl) return;
    set_log_level(LogLevel::off);
    SceneOptions options = with_imagery(blue, false);
    options.stage.wait = app::TileWait::never;
    unsigned seed = 0;
    for (const char* fault : {"", "delay=3ms", "error=0.4,corrupt=0.2,short-read=0.2"})
        for (const std::uint64_t gpu_bytes : {1_MiB, 2_MiB, 64_MiB}) {
            options.stage.frame.gpu_cache_bytes = gpu_bytes;
            options.stage.pager.ram_bytes = gpu_bytes == 1_MiB ? 2_MiB : 32_MiB;
            if (*fault) options.stage.pager.fault = pager::parse_fault(fault).value();
            RenderScene scene(options);
            std::mt19937 random(++seed);
            const auto some_came = [&] {
                return scene.stage().pager().counters(pager::TileKind::imagery).loaded > 0;
            };
            // A fast GPU has drawn them all before the disk has answered once: then more.
            constexpr int kFrames = 60, kMostFrames = 100'000;
            for (int frame = 0; frame < kFrames || (!some_came() && frame < kMostFrames); ++frame) {
                scene.stage().show(anywhere(scene, random, frame));
                CAPTURE(fault);
                CAPTURE(gpu_bytes);
                CAPTURE(frame);
                REQUIRE(pixels_without_imagery(gl::read_image(scene.stage().target())) == 0);
                REQUIRE(scene.stage().gpu_cache_bytes() <= gpu_bytes);
                REQUIRE(scene.stage().gpu_imagery_bytes() <= gpu_bytes / 2);
                REQUIRE(scene.stage().pager().ram_bytes_used() <= options.stage.pager.ram_bytes);
            }
            CHECK(some_came());
        }
    set_log_level(LogLevel::info);
}

TEST_CASE("where there is no imagery the ground keeps its tint, and without showing imagery all of it does") {
    GlContext gl;
    if (!gl) return;
    const auto western_half = [](std::int64_t x, std::int64_t y) {
        return x < 530 ? blue(x, y) : build::Texel{};
    };
    RenderScene scene(with_imagery(western_half, false));
    auto moment = look_down(scene.place(128.0, 120.0, 200.0), 0.0);
    moment.cover = render::Cover::tint;
    scene.stage().show(moment);
    const gl::Image tint = gl::read_image(scene.stage().target());
    moment.cover = render::Cover::imagery;
    scene.stage().show(moment);
    const gl::Image both = gl::read_image(scene.stage().target());
    // Texel 530 lies 1.13 m west of the eye; a few texels of filter beside it.
    const double pixel_m = 2.0 * platform::half_tangents(moment.camera.lens).x * (200.0 - 20.0) / kSize.x;
    const int border = kSize.x / 2 + static_cast<int>((530 * 0.25 - 3.37 - 128.0) / pixel_m);
    int blue_pixels = 0;
    for (int y = 0; y < kSize.y; ++y)
        for (int x = 0; x < kSize.x; ++x) {
            if (x > border + 12) {
                // A step of dithering where filtered coverage is not quite nothing.
                const glm::dvec3 off = glm::abs(pixel(both, x, y) - pixel(tint, x, y));
                REQUIRE(std::max({off.x, off.y, off.z}) <= 1.0);
            }
            const glm::dvec3 found = pixel(both, x, y);
            blue_pixels += x < border - 12 && found.z > 1.5 * std::max(found.x, found.y);
        }
    CHECK(blue_pixels > 5000);
}

TEST_CASE("a cache too small for level 0 of the imagery is an error that names the least that does") {
    GlContext gl;
    if (!gl) return;
    RenderScene scene(with_imagery(blue, true));
    const auto source = pager::tile_source(scene.store());
    const auto refused = render::plan_slots(render::imagery_demand(source), {.capacity_bytes = 32_KiB});
    REQUIRE_FALSE(refused);
    const std::string message = refused.error().message;
    CAPTURE(message);
    const auto least = std::stoull(message.substr(message.find("--gpu-cache ") + 12));
    CHECK(render::plan_slots(render::imagery_demand(source), {.capacity_bytes = (least << 10) / 2}));
    CHECK_FALSE(
        render::plan_slots(render::imagery_demand(source), {.capacity_bytes = ((least - 2) << 10) / 2}));
    for (const std::uint64_t capacity : {200_KiB, 1_MiB, 100_MiB}) {
        const auto shape = render::plan_slots(render::imagery_demand(source),
                                              {.capacity_bytes = capacity, .max_layers = 12});
        REQUIRE(shape);
        CHECK(shape->total_bytes() <= capacity);
        CHECK(shape->layers() <= 12);
    }
}

TEST_CASE(
    "one size of the GPU cache is named where either kind's level 0 does not fit, and it does for both") {
    GlContext gl;
    if (!gl) return;
    for (const auto& [width, quads] : {std::pair{257, 32}, std::pair{257, 128}, std::pair{129, 64}}) {
        CAPTURE(quads);
        SceneOptions options = with_imagery(blue, false);
        options.width = options.height = width;
        options.quads = quads;
        RenderScene scene(options);
        jobs::JobSystem jobs{{.workers = 1}};
        const auto error_with = [&](std::uint64_t gpu_cache_bytes) {
            options.stage.frame.gpu_cache_bytes = gpu_cache_bytes;
            const auto stage = app::TerrainStage::create(scene.store(), jobs, options.stage);
            return stage ? std::string() : stage.error().message;
        };
        const std::string message = error_with(1_KiB);
        CAPTURE(message);
        REQUIRE(message.find("--gpu-cache ") != std::string::npos);
        const auto least = std::stoull(message.substr(message.find("--gpu-cache ") + 12));
        CHECK(error_with(least << 10).empty());
        CHECK_FALSE(error_with((least - 1) << 10).empty());
    }
}

TEST_CASE("while imagery is not shown nothing is read back or scheduled for it, and then again") {
    GlContext gl;
    if (!gl) return;
    RenderScene scene(with_imagery(speckled, true));
    auto moment = look_down(scene.place(128.0, 120.0, 200.0), 0.0);
    CHECK(scene.stage().show(moment).tiles_scheduled > 0);
    const gl::Image shown = gl::read_image(scene.stage().target());
    const auto asked = scene.stage().readback_counters().asked;
    CHECK(asked > 0);
    moment.cover = render::Cover::tint;
    for (int frame = 0; frame < 4; ++frame) {
        ++moment.number;
        const app::StageReport report = scene.stage().show(moment);
        CHECK(report.tiles_scheduled == 0);
        CHECK_FALSE(report.readback_age);
    }
    CHECK(scene.stage().readback_counters().asked == asked);
    ++moment.number;
    moment.cover = render::Cover::imagery;
    CHECK(scene.stage().show(moment).tiles_scheduled > 0);
    CHECK(scene.stage().readback_counters().asked > asked);
    CHECK(gl::read_image(scene.stage().target()).rgb == shown.rgb);
}
