// A directory that is being made and takes its place, or another's, in one step: or is removed.
//
// It lies beside its target as NAME.partial-PROCESS-NUMBER, carries a mark of ours and is locked while its
// maker lives, so that the next maker for the same target can tell what a killed one left behind, and removes
// that; a folder without the mark is somebody else's, whatever its name, but for an empty one whose maker is
// gone. Thread rules: one thread at a time.
#pragma once

#include <filesystem>
#include <utility>

#include "ridgeline/base/result.h"

namespace ridgeline::io {

// Whether what stands at the target gives way.
enum class Replace { never, existing };

class PendingDirectory {
  public:
    // Removes what killed makers for the target left: directories of theirs, and their marks in what stands
    // there. One that had put the old one aside, where the system cannot swap, has it put back.
    static void remove_left(const std::filesystem::path& target);
    // Removes what killed makers left, first. The target's parent must exist; whether the target may is the caller's business.
    static Result<PendingDirectory> create(const std::filesystem::path& target);
    PendingDirectory(PendingDirectory&& other) noexcept;
    PendingDirectory& operator=(PendingDirectory&& other) noexcept;
    ~PendingDirectory();

    const std::filesystem::path& path() const { return path_; }

    // Renames to the target; with Replace::never that fails where anything has come to stand there. Otherwise
    // what stands there is swapped out and removed: at every moment one of the two stands at the target,
    // wherever the system can swap; elsewhere the old one waits aside until the new is in. What may be
    // replaced is the caller's business.
    Result<void> take_place(Replace replace);

  private:
    PendingDirectory(std::filesystem::path path, std::filesystem::path target, int lock)
        : path_(std::move(path)), target_(std::move(target)), lock_(lock) {}

    std::filesystem::path path_;
    std::filesystem::path target_;
    int lock_ = -1;
};

}  // namespace ridgeline::io
