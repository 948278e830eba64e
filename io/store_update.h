// A store that stands, given another imagery layer: the new one takes the old one's place in one step.
//
// Everything but imagery is taken over by hard links (copies, where the file system has none), into a
// directory beside the store that then changes places with it. So whatever interrupts this leaves the old
// store or the new one, and who has the old one open keeps it. Thread rules: one thread at a time.
#pragma once

#include <filesystem>

#include "ridgeline/base/result.h"
#include "ridgeline/io/pending_directory.h"
#include "ridgeline/io/terrain_info.h"

namespace ridgeline::io {

class StoreUpdate {
  public:
    // Fails where no store stands, where its terrain does not open, and where it has imagery already unless
    // Replace::existing.
    static Result<StoreUpdate> begin(const std::filesystem::path& target, Replace imagery);

    // What the store says of itself now.
    const TerrainInfo& info() const { return info_; }
    // Where imagery.bin and imagery.tiles go, and a directory for the caller's own scratch.
    const std::filesystem::path& directory() const { return directory_.path(); }
    const std::filesystem::path& scratch() const { return scratch_; }

    // Opens the new store once, so that nothing broken gets in place, and fails where another has come to the
    // target meanwhile.
    Result<TerrainInfo> finish(const ImageryInfo& imagery);

  private:
    StoreUpdate(PendingDirectory directory, std::filesystem::path target, TerrainInfo info);

    PendingDirectory directory_;
    std::filesystem::path target_;
    std::filesystem::path scratch_;
    TerrainInfo info_;
};

}  // namespace ridgeline::io
