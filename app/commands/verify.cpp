// ridgeline verify: reads a whole store and compares everything in it with its records.
#include <cstdio>
#include <memory>

#include "ridgeline/app/command.h"
#include "ridgeline/app/progress.h"
#include "ridgeline/base/units.h"
#include "ridgeline/io/store.h"

namespace ridgeline::app {
namespace {

Result<void> verify(const std::filesystem::path& directory, const RunContext& context) {
    const auto store = io::Store::open(directory);
    if (!store) return store.error();
    {
        Progress progress("verifying " + directory.string(), "nodes", Progress::style(context.quiet));
        RIDGELINE_TRY(io::verify_store(
            *store, [&](std::int64_t done, std::int64_t total) { progress.report(done, total); }));
    }
    if (context.quiet) return {};
    std::printf("%s: whole, %s", directory.c_str(), counted(store->grid().node_count(), "node").c_str());
    if (const auto& imagery = store->info().imagery)
        std::printf(", %s of imagery", counted(imagery->tiles, "tile").c_str());
    std::printf("\n");
    return {};
}

}  // namespace

void add_verify(Program& program) {
    auto directory = std::make_shared<std::filesystem::path>();
    const Syntax syntax =
        program.add("verify", "Check every byte of a store", "ridgeline verify alps.terrain");
    add_store(syntax, *directory);
    program.runs("verify", [directory](const RunContext& context) { return verify(*directory, context); });
}

}  // namespace ridgeline::app
