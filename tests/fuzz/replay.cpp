// The driver of every other build: feeds the files of the folders that are named. Those called sound-… come
// from real encoders (make_corpus.cpp) and must decode; of the others it is enough that nothing breaks.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fuzz/fuzz_body.h"

namespace {

namespace fs = std::filesystem;
using ridgeline::fuzz::Verdict;

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

bool feed(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    const bool must_be_sound = path.filename().string().starts_with("sound-");
    const bool well = ridgeline::fuzz::try_input(bytes) == Verdict::sound || !must_be_sound;
    if (!well) std::fprintf(stderr, "%s: no longer decodes: run fuzz_corpus\n", path.c_str());
    return well;
}

}  // namespace

int main(int argc, char** argv) {
    std::size_t fed = 0;
    bool all_well = true;
    for (const char* folder : std::vector<const char*>(argv + 1, argv + argc))
        for (const fs::path& file : files_in(folder)) {
            all_well = feed(file) && all_well;
            ++fed;
        }
    std::printf("%zu inputs\n", fed);
    // A corpus that is not found tests nothing.
    return all_well && fed > 0 ? 0 : 1;
}
