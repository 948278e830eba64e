// What `ridgeline report` reads: frames.csv and summary.json.
#include <string>

#include "fuzz/fuzz_body.h"
#include "fuzz/input.h"
#include "ridgeline/app/report/frames_csv.h"
#include "ridgeline/app/report/summary_file.h"
#include "ridgeline/base/contract.h"

namespace ridgeline::fuzz {

Verdict try_input(std::span<const std::uint8_t> bytes) {
    Input input(bytes);
    const bool summary = input.byte() == 's';
    const auto rest = input.rest();
    const std::string text(rest.begin(), rest.end());
    if (summary) return app::report::parse_summary(text, "summary.json") ? Verdict::sound : Verdict::refused;
    const auto table = app::report::parse_frames_csv(text, "frames.csv");
    if (!table) return Verdict::refused;
    if (const auto* column = table->find("frame_ms")) RIDGELINE_CHECK(column->size() == table->frames());
    return Verdict::sound;
}

}  // namespace ridgeline::fuzz
