#include "ridgeline/app/report/run_folder.h"

#include <algorithm>
#include <map>
#include <system_error>

namespace ridgeline::app::report {
namespace {

namespace fs = std::filesystem;

// The steps from the root, without "." and "..".
std::vector<std::string> steps_to(const fs::path& folder) {
    std::error_code failed;
    fs::path whole = fs::absolute(folder, failed);
    if (failed) whole = folder;
    std::vector<std::string> steps;
    for (const fs::path& step : whole.lexically_normal().relative_path())
        if (!step.empty()) steps.push_back(step.string());
    return steps;
}

std::string last_steps(const std::vector<std::string>& steps, std::size_t count) {
    std::string name;
    for (std::size_t i = steps.size() - std::min(count, steps.size()); i < steps.size(); ++i)
        name += (name.empty() ? "" : "/") + steps[i];
    return name.empty() ? "/" : name;
}

// As many of the last steps as no other folder shares; all of them where another is the same.
std::string shortest_name(const std::vector<std::vector<std::string>>& all,
                          const std::vector<std::string>& steps) {
    for (std::size_t count = 1; count < steps.size(); ++count) {
        const std::string name = last_steps(steps, count);
        const auto shares = [&](const auto& other) {
            return other != steps && last_steps(other, count) == name;
        };
        if (std::none_of(all.begin(), all.end(), shares)) return name;
    }
    return last_steps(steps, steps.size());
}

Result<RunFolder> read_run(const fs::path& folder, const std::string& name, std::size_t thumbnails) {
    std::error_code failed;
    if (!fs::is_directory(folder, failed))
        return Error{folder.string() + ": is no folder; walk --telemetry makes the one that is meant"};
    RunFolder run{.name = name, .frames = {}, .summary = {}, .thumbnails = {}};
    auto summary = read_summary(folder / "summary.json");
    if (!summary) return summary.error();
    auto frames = read_frames_csv(folder / "frames.csv");
    if (!frames) return frames.error();
    run.summary = std::move(*summary);
    run.frames = std::move(*frames);
    const double* count = run.summary.find("frames");
    if (count != nullptr && *count != static_cast<double>(run.frames.frames()))
        return Error{folder.string() +
                     ": frames.csv and summary.json are of different runs, or one was cut short"};
    run.thumbnails = read_thumbnails(folder / "thumbs", thumbnails);
    return run;
}

}  // namespace

std::vector<std::string> names_apart(const std::vector<fs::path>& folders) {
    std::vector<std::vector<std::string>> all;
    for (const fs::path& folder : folders) all.push_back(steps_to(folder));
    std::vector<std::string> names;
    std::map<std::string, int> seen;
    for (const auto& steps : all) {
        const std::string name = shortest_name(all, steps);
        const int times = ++seen[name];
        names.push_back(times == 1 ? name : name + " (" + std::to_string(times) + ")");
    }
    return names;
}

Result<std::vector<RunFolder>> read_runs(const std::vector<fs::path>& folders, std::size_t thumbnails) {
    const std::vector<std::string> names = names_apart(folders);
    std::vector<RunFolder> runs;
    for (std::size_t i = 0; i < folders.size(); ++i) {
        auto run = read_run(folders[i], names[i], thumbnails / folders.size());
        if (!run) return run.error();
        runs.push_back(std::move(*run));
    }
    return runs;
}

}  // namespace ridgeline::app::report
