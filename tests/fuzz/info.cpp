// terrain.json, as it stands and with a checksum that fits: what is taken must say the same once it is written
// and read again.
#include <string>

#include "fuzz/fuzz_body.h"
#include "ridgeline/base/contract.h"
#include "ridgeline/io/terrain_info.h"
#include "support/sealed_json.h"

namespace ridgeline::fuzz {
namespace {

void use(const io::TerrainInfo& info) {
    const io::Grid grid = info.grid();
    RIDGELINE_CHECK(grid.node_count() > 0 && grid.contains(grid.node_at(grid.node_count() - 1)));
    if (info.imagery) RIDGELINE_CHECK(info.imagery->grid().node_count() > 0);
    const std::string written = io::to_json(info);
    const auto again = io::terrain_info_from_json(written);
    RIDGELINE_CHECK(again.ok() && io::to_json(*again) == written);
}

Verdict try_text(const std::string& text) {
    const auto info = io::terrain_info_from_json(text);
    if (!info) return Verdict::refused;
    use(*info);
    return Verdict::sound;
}

}  // namespace

Verdict try_input(std::span<const std::uint8_t> bytes) {
    const std::string text(bytes.begin(), bytes.end());
    const Verdict as_it_stands = try_text(text);
    const auto fitting = test::sealed(text);
    if (fitting) (void)try_text(*fitting);
    return as_it_stands;
}

}  // namespace ridgeline::fuzz
