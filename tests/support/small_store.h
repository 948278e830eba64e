// A store on disk made from a reference terrain, without the builder; the folder goes with the object.
#pragma once

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "ridgeline/io/relief_maker.h"
#include "ridgeline/io/store.h"
#include "support/reference_terrain.h"

namespace ridgeline::test {

class SmallStore {
  public:
    explicit SmallStore(const ReferenceTerrain& terrain) {
        static int number = 0;
        directory_ =
            std::filesystem::temp_directory_path() /
            ("ridgeline-test-" + std::to_string(::getpid()) + "-" + std::to_string(number++) + ".terrain");
        std::filesystem::create_directories(directory_);
        write(terrain);
    }
    ~SmallStore() { std::filesystem::remove_all(directory_); }
    SmallStore(const SmallStore&) = delete;
    SmallStore& operator=(const SmallStore&) = delete;

    const std::filesystem::path& directory() const { return directory_; }

    // What the store foretells of made ground: as many octaves as there can be, of usual gains.
    static io::DetailInfo detail() {
        return {.face_residual_m = {1.0, 2.0, 4.0},
                .edge_residual_m = {0.8, 1.7, 3.6},
                .octaves = std::vector<io::DetailGains>(8, {350, 430, 480, 230})};
    }

  private:
    // The largest vertical error of a node's mesh over its samples, in quanta.
    static double true_error(const ReferenceTerrain& terrain, io::NodeId node) {
        const io::LatticePoint origin = terrain.grid().origin(node);
        const std::int64_t extent = terrain.grid().extent(node.level);
        double error = 0.0;
        for (std::int64_t y = origin.y; y <= origin.y + extent; ++y)
            for (std::int64_t x = origin.x; x <= origin.x + extent; ++x)
                error = std::max(error, std::abs(terrain.surface(node.level, x, y) - terrain.quanta(x, y)));
        return error;
    }

    void write(const ReferenceTerrain& terrain) {
        const io::Grid& grid = terrain.grid();
        std::vector<io::NodeRecord> records(static_cast<std::size_t>(grid.node_count()));
        std::vector<std::uint8_t> heights, meshes;
        io::ChunkScratch scratch;
        io::ReliefMaker reliefs;
        std::vector<io::ReliefBounds> bounds(records.size());
        const auto at = [](std::int64_t place) { return static_cast<std::size_t>(place); };
        for (std::int64_t i = grid.node_count() - 1; i >= 0; --i) {
            const io::NodeId node = grid.node_at(i);
            io::NodeRecord& record = records[static_cast<std::size_t>(i)];
            const std::size_t heights_at = heights.size(), mesh_at = meshes.size();
            io::encode_heights(terrain.heights_tile(node), heights);
            auto chunk =
                io::encode_chunk(grid, node, ReferenceTerrain::NodeSource(terrain, node), scratch, meshes);
            REQUIRE(chunk);
            reliefs.append(grid, node, {}, scratch, terrain.heights_tile(node), *chunk, bounds[at(i)],
                           meshes);
            record.flags = io::NodeRecord::kHasData;
            record.heights = reference(heights, heights_at);
            record.mesh = reference(meshes, mesh_at);
            record.vertex_count = chunk->vertex_count;
            record.index_count = chunk->index_count;
            record.triangle_count = chunk->triangle_count;
            record.min_quanta = chunk->min_quanta;
            record.max_quanta = chunk->max_quanta;
            record.error_m = std::max(record.error_m, static_cast<float>(true_error(terrain, node) + 1e-3));
            if (node.level == 0) continue;
            bounds[at(grid.linear(node.parent()))].add_child({}, node.quarter(), bounds[at(i)]);
            io::NodeRecord& parent = records[static_cast<std::size_t>(grid.linear(node.parent()))];
            parent.error_m = std::max(parent.error_m, record.error_m);
        }
        save(info_of(terrain, records), records, heights, meshes);
    }

    static io::PayloadRef reference(const std::vector<std::uint8_t>& bytes, std::size_t at) {
        return {at, io::payload_checksum(std::span(bytes).subspan(at)),
                static_cast<std::uint32_t>(bytes.size() - at), 0};
    }

    static io::TerrainInfo info_of(const ReferenceTerrain& terrain,
                                   const std::vector<io::NodeRecord>& records) {
        const io::Grid& grid = terrain.grid();
        io::TerrainInfo info;
        info.west_m = 100000.0;
        info.north_m = 200000.0;
        info.width = grid.width();
        info.height = grid.height();
        info.tile = grid.quads() + 1;
        info.detail = detail();
        info.thresholds_m.assign(static_cast<std::size_t>(grid.levels()), 0.0);
        std::vector<std::int32_t> quanta;
        for (std::int64_t y = 0; y < grid.height(); ++y)
            for (std::int64_t x = 0; x < grid.width(); ++x) quanta.push_back(terrain.quanta(x, y));
        info.min_height_m = info.height_m(*std::min_element(quanta.begin(), quanta.end()));
        info.max_height_m = info.height_m(*std::max_element(quanta.begin(), quanta.end()));
        info.heights_tiles = info.mesh_tiles = grid.node_count();
        for (const io::NodeRecord& record : records) {
            info.heights_bytes += record.heights.size;
            info.mesh_bytes += record.mesh.size;
            info.triangles += record.triangle_count;
        }
        return info;
    }

    void save(const io::TerrainInfo& info, const std::vector<io::NodeRecord>& records,
              const std::vector<std::uint8_t>& heights, const std::vector<std::uint8_t>& meshes) const {
        const auto dump = [&](const char* name,
                              std::initializer_list<std::pair<const void*, std::size_t>> parts) {
            std::ofstream file(directory_ / name, std::ios::binary);
            for (const auto& [data, size] : parts)
                file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
        };
        const std::string json = io::to_json(info);
        const std::size_t bytes = records.size() * sizeof(io::NodeRecord);
        io::NodesHeader header;
        header.record_count = records.size();
        header.checksum =
            io::payload_checksum({reinterpret_cast<const std::uint8_t*>(records.data()), bytes});
        dump("nodes.bin", {{&header, sizeof header}, {records.data(), bytes}});
        dump("heights.tiles", {{heights.data(), heights.size()}});
        dump("mesh.tiles", {{meshes.data(), meshes.size()}});
        dump("terrain.json", {{json.data(), json.size()}});
    }

    std::filesystem::path directory_;
};

}  // namespace ridgeline::test
