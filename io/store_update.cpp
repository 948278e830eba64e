#include "ridgeline/io/store_update.h"

#include <system_error>
#include <utility>

#include "ridgeline/io/layer_order.h"
#include "ridgeline/io/output_file.h"
#include "ridgeline/io/store.h"
#include "ridgeline/io/store_place.h"

namespace ridgeline::io {
namespace {

namespace fs = std::filesystem;

// Files of a store never change, so that two directories may share them.
Result<void> share(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::create_hard_link(from, to, error);
    if (!error) return {};
    if (!fs::exists(from)) return Error{from.string() + ": not found: build the terrain again"};
    fs::copy_file(from, to, error);
    if (error) return Error{to.string() + ": " + error.message()};
    return sync_file(to);
}

}  // namespace

StoreUpdate::StoreUpdate(PendingDirectory directory, fs::path target, TerrainInfo info)
    : directory_(std::move(directory)),
      target_(std::move(target)),
      scratch_(directory_.path() / "scratch"),
      info_(std::move(info)) {}

Result<StoreUpdate> StoreUpdate::begin(const fs::path& target, Replace imagery) {
    const fs::path clean = normalised(target);
    // First, since it may bring back a store that a killed maker had put aside.
    PendingDirectory::remove_left(clean);
    auto info = read_terrain_info(clean);
    if (!info) return info.error();
    if (info->imagery && imagery == Replace::never)
        return Error{clean.string() + ": has imagery already; --force replaces it"};
    // Said now, not after hours of work.
    RIDGELINE_TRY(Store::check_terrain(clean));
    RIDGELINE_TRY(check_target(clean, Replace::existing));
    auto directory = PendingDirectory::create(clean);
    if (!directory) return directory.error();
    StoreUpdate update(std::move(*directory), clean, std::move(*info));
    std::error_code error;
    if (!fs::create_directory(update.scratch_, error))
        return Error{update.scratch_.string() + ": " + error.message()};
    for (const char* name : {kNodesFile, layer_file(Layer::heights), layer_file(Layer::mesh)})
        RIDGELINE_TRY(share(clean / name, update.directory() / name));
    return update;
}

Result<TerrainInfo> StoreUpdate::finish(const ImageryInfo& imagery) {
    std::error_code ignored;
    fs::remove_all(scratch_, ignored);
    TerrainInfo info = info_;
    info.imagery = imagery;
    const std::string text = to_json(info);
    RIDGELINE_TRY(write_file(directory() / kInfoFile, std::as_bytes(std::span(text)), {}));
    RIDGELINE_TRY(sync_directory(directory()));
    if (const auto store = Store::open(directory()); !store) return store.error();
    const auto standing = read_terrain_info(target_);
    if (!standing || to_json(*standing) != to_json(info_))
        return Error{target_.string() + ": was changed meanwhile; nothing of it was touched: try again"};
    RIDGELINE_TRY(check_target(target_, Replace::existing));
    RIDGELINE_TRY(directory_.take_place(Replace::existing));
    return info;
}

}  // namespace ridgeline::io
