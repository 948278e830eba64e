// The renderer's arithmetic, without a GPU: ranges, slots, uniforms, noise.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "ridgeline/render/frame_uniforms.h"
#include "ridgeline/render/gpu_slots.h"
#include "ridgeline/render/ground_noise.h"
#include "ridgeline/render/mesh_surface.h"

using namespace ridgeline;
using namespace ridgeline::render;

namespace {

// A store's records, as far as slots ask: sizes, from level to level about the same.
struct Records {
    io::Grid grid;
    std::vector<io::NodeRecord> records;

    Records(std::int64_t width, std::int64_t height, int quads, std::mt19937& random)
        : grid(width, height, quads) {
        records.resize(static_cast<std::size_t>(grid.node_count()));
        for (io::NodeRecord& record : records) {
            record.flags = io::NodeRecord::kHasData | (random() % 5 == 0 ? io::NodeRecord::kHasMask : 0u);
            record.vertex_count = 500 + random() % 3000;
            record.index_count = 6 * record.vertex_count;
        }
    }
    pager::TileSource source() const {
        return {.name = "records", .grid = grid, .spacing = {}, .relief = {}, .records = records};
    }
};

std::uint64_t number_before(const std::string& text, const std::string& unit) {
    const auto end = text.find(unit);
    REQUIRE(end != std::string::npos);
    const auto begin = text.find_last_not_of("0123456789", end - 1) + 1;
    return std::stoull(text.substr(begin, end - begin));
}

}  // namespace

TEST_CASE("Merged ranges cover the same indices, in order, with a gap between any two") {
    std::mt19937 random(1);
    for (int round = 0; round < 2000; ++round) {
        // Disjoint ranges, as a chunk has them, some of them empty, shuffled.
        std::vector<io::IndexRange> ranges;
        std::vector<bool> covered(400, false);
        for (std::uint32_t at = 0; at < 380;) {
            const std::uint32_t count = 3 * (random() % 6);
            if (random() % 3 != 0) {
                ranges.push_back({at, count});
                std::fill_n(covered.begin() + at, count, true);
            }
            at += count + (random() % 4 == 0 ? 3 : 0);
        }
        std::ranges::shuffle(ranges, random);
        const std::size_t merged = merge_ranges(ranges);
        std::vector<bool> after(400, false);
        for (std::size_t i = 0; i < merged; ++i) {
            REQUIRE(ranges[i].count > 0);
            if (i > 0) REQUIRE(ranges[i].first > ranges[i - 1].first + ranges[i - 1].count);
            std::fill_n(after.begin() + ranges[i].first, ranges[i].count, true);
        }
        REQUIRE(after == covered);
    }
}

TEST_CASE("GPU slots never take more than their bytes, and hold level 0 wherever they exist") {
    std::mt19937 random(2);
    for (int round = 0; round < 300; ++round) {
        const int quads = 32 << (random() % 3);
        const Records store(2 + random() % 3000, 2 + random() % 3000, quads, random);
        const std::uint64_t capacity = 100'000ULL << (random() % 12);
        const auto shape = plan_gpu_slots(store.source(), {.capacity_bytes = capacity});
        std::uint64_t level0_bytes = 0;
        for (std::int64_t i = 0; i < store.grid.first(1); ++i)
            level0_bytes +=
                (io::chunk_layout(store.records[static_cast<std::size_t>(i)], {.quads = quads}).mask + 1023) /
                1024 * 1024;
        if (!shape) {
            // What the message asks for is enough.
            const std::uint64_t least = number_before(shape.error().message, "KiB") * 1024;
            CHECK(plan_gpu_slots(store.source(), {.capacity_bytes = least / 2}).ok());
            CHECK(least / 2 > capacity);
            continue;
        }
        CHECK(shape->total_bytes() <= capacity);
        CHECK(shape->square_count() >= store.grid.first(1));
        CHECK(shape->geometry_bytes >= level0_bytes);
    }
}

TEST_CASE("A cache that is large enough holds the whole store") {
    std::mt19937 random(3);
    for (int round = 0; round < 100; ++round) {
        const Records store(2 + random() % 3000, 2 + random() % 3000, 64, random);
        const auto shape = plan_gpu_slots(store.source(), {.capacity_bytes = 4_GiB});
        REQUIRE(shape);
        CHECK(shape->square_count() >= static_cast<int>(store.records.size()));
        std::uint64_t bytes = 0;
        for (const auto& record : store.records)
            bytes += (io::chunk_layout(record, {.quads = 64}).mask + 1023) / 1024 * 1024;
        CHECK(shape->geometry_bytes == bytes);
    }
}

TEST_CASE("The rays of a frame are those of its matrix") {
    std::mt19937 random(4);
    const auto uniform = [&](double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(random);
    };
    io::TerrainInfo info;
    info.max_height_m = 2000.0;
    for (int round = 0; round < 200; ++round) {
        FrameView view;
        view.camera.pose = {{uniform(-1e6, 1e6), uniform(-1e6, 1e6), uniform(0, 5000)},
                            Angle::from_degrees(uniform(-180, 180)),
                            Angle::from_degrees(uniform(-90, 90))};
        view.camera.lens = {Angle::from_degrees(uniform(20, 130)),
                            {300 + static_cast<int>(random() % 900), 401}};
        const auto frame = frame_uniforms(view, info);
        const glm::vec2 pixel(uniform(0, 300), uniform(0, 401));
        const glm::vec3 ray(frame.ray_origin + pixel.x * frame.ray_dx + pixel.y * frame.ray_dy);
        const glm::vec4 clip = frame.clip_from_eye * glm::vec4(ray * 1234.0f, 1.0f);
        const glm::vec2 back = (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * glm::vec2(view.camera.lens.size_px);
        CHECK(clip.w == doctest::Approx(1234.0f).epsilon(1e-4));
        CHECK(back.x == doctest::Approx(pixel.x).epsilon(0.01));
        CHECK(back.y == doctest::Approx(pixel.y).epsilon(0.01));
    }
}

TEST_CASE("The sun stands where it is said to, and night is darker than day") {
    const glm::dvec3 east = sun_direction({Angle::from_degrees(90.0), Angle::from_degrees(0.0)});
    CHECK(east.x == doctest::Approx(1.0));
    CHECK(std::abs(east.y) < 1e-12);
    const glm::dvec3 north = sun_direction({Angle::from_degrees(0.0), Angle::from_degrees(60.0)});
    CHECK(north.y == doctest::Approx(0.5));
    const auto light = [](double elevation_deg) {
        FrameView view;
        view.daylight.sun_elevation = Angle::from_degrees(elevation_deg);
        const auto frame = frame_uniforms(view, {});
        return frame.sun_light.y + frame.sky_light.y;
    };
    for (double elevation = -20.0; elevation < 89.0; elevation += 1.0)
        CHECK(light(elevation) <= light(elevation + 1.0) + 1e-6f);
    CHECK(light(-20.0) < 0.01f * light(45.0));
}

TEST_CASE("Ground noise repeats without a seam and uses its range") {
    constexpr int kSize = 256;
    const auto texels = ground_noise(kSize, 1);
    const auto value = [&](int x, int y) {
        return int{texels[static_cast<std::size_t>((y & 255) * kSize + (x & 255))].value};
    };
    int inside = 0, across = 0, lowest = 255, highest = 0;
    for (int i = 0; i < kSize; ++i) {
        across = std::max(
            {across, std::abs(value(255, i) - value(256, i)), std::abs(value(i, 255) - value(i, 256))});
        for (int x = 1; x < kSize; ++x) inside = std::max(inside, std::abs(value(x, i) - value(x - 1, i)));
        for (int x = 0; x < kSize; ++x)
            lowest = std::min(lowest, value(x, i)), highest = std::max(highest, value(x, i));
    }
    CHECK(across <= inside);
    CHECK(lowest < 40);
    CHECK(highest > 215);
}
