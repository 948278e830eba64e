#include "ridgeline/io/store_place.h"

#include <system_error>

#include "ridgeline/io/terrain_info.h"

namespace ridgeline::io {
namespace {

namespace fs = std::filesystem;

bool is_store(const fs::path& path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored) && fs::exists(path / kInfoFile, ignored);
}

}  // namespace

fs::path normalised(const fs::path& path) {
    const fs::path clean = path.lexically_normal();
    return clean.has_filename() ? clean : clean.parent_path();
}

Result<void> check_target(const fs::path& target, Replace replace) {
    std::error_code ignored;
    const auto status = fs::symlink_status(target, ignored);
    if (!fs::exists(status)) return {};
    if (fs::is_symlink(status))
        return Error{target.string() + ": is a symbolic link; name the place that it leads to"};
    if (!is_store(target)) return Error{target.string() + ": exists and is no terrain; choose another name"};
    if (replace == Replace::never) return Error{target.string() + ": exists already; --force replaces it"};
    return {};
}

}  // namespace ridgeline::io
