#include "ridgeline/app/report/report_file.h"

#include <fstream>
#include <string>
#include <system_error>

#include "ridgeline/app/report/page.h"
#include "ridgeline/base/whole_file.h"

namespace ridgeline::app::report {
namespace {

namespace fs = std::filesystem;

// Through links of both kinds; nothing that is not there is the same.
bool same_file(const fs::path& a, const fs::path& b) {
    std::error_code failed;
    return fs::equivalent(a, b, failed) && !failed;
}

bool among_files(const fs::path& file, const fs::path& folder) {
    std::error_code failed;
    for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed))
        if (same_file(entry->path(), file)) return true;
    return false;
}

bool begins_as_page(const fs::path& file) {
    std::string beginning(kPageOpening.size(), '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
    return stream.good() && beginning == kPageOpening;
}

bool is_telemetry(const fs::path& file, std::span<const fs::path> folders) {
    for (const fs::path& folder : folders)
        if (among_files(file, folder) || among_files(file, folder / "thumbs")) return true;
    return false;
}

Result<void> check_replaceable(const fs::path& file, std::span<const fs::path> folders) {
    std::error_code failed;
    if (!fs::is_regular_file(file, failed) || begins_as_page(file)) return {};
    if (is_telemetry(file, folders))
        return Error{file.string() + ": is of the telemetry that the report is made from; name another file"};
    return Error{file.string() + ": stands there and is no report, so it is kept; name another file"};
}

}  // namespace

Result<void> write_report(const fs::path& file, std::string_view page, std::span<const fs::path> folders) {
    RIDGELINE_TRY(check_replaceable(file, folders));
    return write_whole_file(file, page);
}

}  // namespace ridgeline::app::report
