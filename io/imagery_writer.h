// Writes imagery.bin and imagery.tiles into a directory that is being made; who makes it puts it in its
// place.
//
// Payloads may come in any order; they wait in a scratch file until finish(). Thread rules: one thread at a
// time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/io/imagery_info.h"
#include "ridgeline/io/imagery_record.h"
#include "ridgeline/io/output_file.h"

namespace ridgeline::io {

enum class Holes { none, some };

class ImageryWriter {
  public:
    // `scratch` is a directory that exists; its caller removes it.
    static Result<ImageryWriter> create(const std::filesystem::path& directory,
                                        const std::filesystem::path& scratch, const Grid& grid);

    // The parents of nodes with a tile must get one too.
    Result<void> put(NodeId node, std::span<const std::uint8_t> payload, Holes holes);

    // Called with tiles done and in all; false stops the writing with an Error.
    using Progress = std::function<bool(std::int64_t, std::int64_t)>;
    // Writes both files and sets tiles and bytes.
    Result<void> finish(ImageryInfo& info, const Progress& progress = {});

  private:
    ImageryWriter(std::filesystem::path directory, OutputFile waiting, const Grid& grid);
    ImageryRecord& record(NodeId node) { return records_[static_cast<std::size_t>(grid_.linear(node))]; }

    std::filesystem::path directory_;
    OutputFile waiting_;
    Grid grid_;
    std::vector<ImageryRecord> records_;
    std::int64_t tiles_ = 0;
};

}  // namespace ridgeline::io
