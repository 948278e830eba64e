#include "ridgeline/render/ground_readback.h"

#include <cstring>

#include "ridgeline/gl/debug_output.h"
#include "ridgeline/shaders/lib/ground_cells.h"
#include "ridgeline/telemetry/clock.h"

namespace ridgeline::render {
namespace {

using select::GroundMask;
using shaders::GroundResult;

static_assert(shaders::kGroundGrids == GroundMask::kGrids && shaders::kGroundSide == GroundMask::kSide);
static_assert(sizeof(GroundResult::cells) == GroundMask::kWords * sizeof(std::uint64_t));

enum Location : GLint { kCorner, kCellsPerMetre, kCentre, kCount, kNear, kStep };

constexpr std::int64_t kLongestPoll_ns = 100'000;

GLuint groups(int size_px, int step_px) {
    const int samples = (size_px - 2) / step_px + 2;
    return static_cast<GLuint>((samples + shaders::kGroundGroup - 1) / shaders::kGroundGroup);
}

select::GroundRectangle rectangle_of(const GroundResult& result, const glm::dvec3& eye_m) {
    if (result.reach[0] == 0) return {};
    const auto reach = [&](int side) {
        return static_cast<double>(shaders::from_ordered_bits(result.reach[side]));
    };
    return {{eye_m.x - reach(0), eye_m.y - reach(1)}, {eye_m.x + reach(2), eye_m.y + reach(3)}};
}

}  // namespace

Result<GroundReader> GroundReader::create(const select::GroundLattice& lattice,
                                          const GroundSampling& sampling) {
    GroundReader reader;
    reader.lattice_ = lattice;
    reader.sampling_ = sampling;
    auto program = gl::Program::create({{"passes/ground_readback.comp"}, {}});
    if (!program) return program.error();
    reader.program_ = std::move(program).value();
    auto result = gl::Buffer::create({.size_bytes = sizeof(GroundResult), .label = "ground readback"});
    if (!result) return result.error();
    reader.result_ = std::move(result).value();
    auto ring = gl::ReadbackRing::create(
        {.slot_bytes = sizeof(GroundResult), .slots = kFrames, .label = "ground readback ring"});
    if (!ring) return ring.error();
    reader.ring_ = std::move(ring).value();
    return reader;
}

void GroundReader::set_uniforms(const platform::Camera& camera) {
    const glm::dvec2 eye(camera.pose.eye_m);
    const glm::ivec2 centre = lattice_.cell(eye);
    program_.set(kCorner, glm::vec2(lattice_.corner_m + glm::dvec2(centre) * lattice_.cell_m - eye));
    program_.set(kCellsPerMetre, static_cast<float>(lattice_.cells_per_m));
    program_.set(kCentre, centre);
    program_.set(kCount, lattice_.cells);
    program_.set(kNear, static_cast<float>(camera.lens.near_m));
    program_.set(kStep, sampling_.step_px);
}

void GroundReader::read(const gl::Texture2D& depth, const Seen& seen) {
    ++counters_.asked;
    if (ring_.in_flight() == kFrames) {
        ++counters_.refused;
        return;
    }
    const gl::DebugGroup group("ground readback");
    result_.clear();
    result_.bind_base(GL_SHADER_STORAGE_BUFFER, shaders::kGroundResultBinding);
    depth.bind(shaders::kGroundDepthUnit);
    set_uniforms(*seen.camera);
    program_.use();
    const glm::ivec2 size = depth.size_px();
    glDispatchCompute(groups(size.x, sampling_.step_px.x), groups(size.y, sampling_.step_px.y), 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    ++number_;
    asked_[number_ % kFrames] = {seen.frame, seen.sight};
    ring_.request(result_, 0, sizeof(GroundResult), number_);
}

void GroundReader::poll() {
    const std::int64_t start_ns = telemetry::now_ns(), waits = telemetry::waits_of_this_thread();
    while (const auto bytes = ring_.take()) take(*bytes);
    const bool waited = telemetry::waits_of_this_thread() > waits;
    counters_.stalls += waited && telemetry::now_ns() - start_ns > kLongestPoll_ns ? 1 : 0;
}

void GroundReader::take(const gl::ReadbackRing::Arrived& bytes) {
    GroundResult result;
    std::memcpy(&result, bytes.bytes.data(), sizeof result);
    const Asked& asked = asked_[bytes.tag % kFrames];
    newest_.frame = asked.frame;
    newest_.sight = asked.sight;
    newest_.rectangle = rectangle_of(result, asked.sight.eye_m);
    newest_.mask.clear(lattice_, glm::dvec2(asked.sight.eye_m));
    // Two words make one, the western first: as memory has them.
    std::array<std::uint64_t, GroundMask::kWords> words;
    std::memcpy(words.data(), result.cells, sizeof result.cells);
    newest_.mask.mark(words);
    arrived_ = true;
    ++counters_.arrived;
}

}  // namespace ridgeline::render
