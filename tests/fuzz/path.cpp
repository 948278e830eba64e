// Path files: what is taken resolves to finite poses, and says the same once it is written and read again.
#include <cmath>
#include <string>

#include "fuzz/fuzz_body.h"
#include "ridgeline/base/contract.h"
#include "ridgeline/platform/path.h"

namespace ridgeline::fuzz {
namespace {

// A frame a minute: a path may last a day.
constexpr platform::ResolveOptions kOptions{platform::Seconds(60.0)};

std::optional<double> ground(const glm::dvec2& place) {
    if (!(std::abs(place.x) < 1e6)) return {};
    return 100.0 * std::sin(1e-3 * place.x) + 1e-3 * place.y;
}

void use(const platform::CameraPath& path) {
    const std::string written = platform::path_to_json(path);
    const auto again = platform::parse_path(written, "again");
    RIDGELINE_CHECK(again.ok() && again->samples.size() == path.samples.size());
    const auto resolved = platform::resolve(path, ground, kOptions);
    if (!resolved) return;
    RIDGELINE_CHECK(resolved->frame_count() > 0);
    (void)resolved->at(0.5 * resolved->duration());
}

}  // namespace

Verdict try_input(std::span<const std::uint8_t> bytes) {
    const auto path = platform::parse_path(std::string(bytes.begin(), bytes.end()), "path");
    if (!path) return Verdict::refused;
    use(*path);
    return Verdict::sound;
}

}  // namespace ridgeline::fuzz
