// Writes a terrain store so that it stands complete at its place or not at all.
//
// Payloads may come in any order; they wait in scratch files in a directory beside the target and are copied
// into their final order at the end: level by level, coarsest first, along a Hilbert curve within a level.
// Then the directory is synced and renamed to the target in one step. A writer that is destroyed unfinished
// removes its directory; one that was killed leaves a directory that the next writer for the same target
// removes.
//
// Thread rules: one thread at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "ridgeline/base/result.h"
#include "ridgeline/io/grid.h"
#include "ridgeline/io/node_record.h"
#include "ridgeline/io/pending_directory.h"
#include "ridgeline/io/store.h"
#include "ridgeline/io/terrain_info.h"

namespace ridgeline::io {

class StoreWriter {
  public:
    // Fails where the target exists or its parent cannot be written to. Replace::existing lets a store give
    // way; what is no store never does. finish() looks again.
    static Result<StoreWriter> create(const std::filesystem::path& target, Replace replace);
    StoreWriter(StoreWriter&&) noexcept;
    StoreWriter& operator=(StoreWriter&&) noexcept;
    ~StoreWriter();

    // The directory that becomes the store: imagery is put there before finish(), by an ImageryWriter.
    const std::filesystem::path& directory() const;
    // A directory for the caller's own scratch; it goes with the writer.
    const std::filesystem::path& scratch() const;

    // Makes room for the nodes' records, all zero. Once, before records are used.
    void begin(const Grid& grid);
    // In linear order. Payload references are the writer's, the rest is the caller's to fill.
    std::span<NodeRecord> records();
    Result<void> put(Layer layer, NodeId node, std::span<const std::uint8_t> payload);

    // Called with payloads done and in all; false stops the writing with an Error.
    using Progress = std::function<bool(std::int64_t, std::int64_t)>;
    // Completes `info` with tiles, bytes and triangles, imagery's apart, writes everything and puts the store
    // in its place.
    Result<TerrainInfo> finish(TerrainInfo info, const Progress& progress = {});

  private:
    struct State;
    explicit StoreWriter(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace ridgeline::io
