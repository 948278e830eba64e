// ridgeline_reference FOLDER: writes the manual page and the shell completion, as cmake --install puts them down.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "ridgeline/app/program.h"
#include "ridgeline/app/reference/bash_completion.h"
#include "ridgeline/app/reference/man_page.h"

namespace {

bool write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary);
    out << text;
    out.close();
    if (!out) std::fprintf(stderr, "%s: cannot be written\n", file.c_str());
    return static_cast<bool>(out);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return std::fprintf(stderr, "usage: ridgeline_reference FOLDER\n"), 2;
    const std::filesystem::path folder(argv[1]);
    ridgeline::app::GlobalOptions options;
    ridgeline::app::Program program(ridgeline::app::program_text());
    ridgeline::app::add_everything(program, options);
    const auto usage = program.usage();
    const bool written = write(folder / "ridgeline.1", ridgeline::app::man_page(usage)) &&
                         write(folder / "ridgeline.bash", ridgeline::app::bash_completion(usage));
    return written ? 0 : 1;
}
