// Whole stores: opened, verified and every chunk of them decoded; as they stand, and with checksums that fit,
// so that damage reaches what is behind them.
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "fuzz/bundle.h"
#include "fuzz/fuzz_body.h"
#include "fuzz/input.h"
#include "ridgeline/io/chunk_reader.h"
#include "ridgeline/io/record_table.h"
#include "ridgeline/io/store.h"
#include "support/sealed_json.h"

namespace ridgeline::fuzz {
namespace {

namespace fs = std::filesystem;
using Files = std::map<std::string, std::string>;

// One folder a process, gone with it.
class Folder {
  public:
    Folder() { fs::create_directories(path_); }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    void hold(const Files& files) const {
        for (const char* name : kBundled) {
            const auto file = files.find(name);
            if (file == files.end()) {
                fs::remove(path_ / name);
                continue;
            }
            std::ofstream(path_ / name, std::ios::binary) << file->second;
        }
    }
    const fs::path& path() const { return path_; }

  private:
    fs::path path_ =
        fs::temp_directory_path() / ("ridgeline-fuzz-" + std::to_string(::getpid()) + ".terrain");
};

Files unbundle(Input& input) {
    Files files;
    while (!input.empty()) {
        const char* name = kBundled[input.byte() % kBundled.size()];
        const auto bytes = input.take(input.word());
        files[name] = std::string(bytes.begin(), bytes.end());
    }
    return files;
}

std::uint64_t checksum(std::string_view bytes) {
    return io::payload_checksum({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

void seal(std::string_view layer, std::uint64_t offset, std::uint32_t size, std::uint64_t& sum) {
    if (offset <= layer.size() && size <= layer.size() - offset) sum = checksum(layer.substr(offset, size));
}
void seal(Files& files, io::NodeRecord& record) {
    seal(files["heights.tiles"], record.heights.offset, record.heights.size, record.heights.checksum);
    seal(files["mesh.tiles"], record.mesh.offset, record.mesh.size, record.mesh.checksum);
}
void seal(Files& files, io::ImageryRecord& record) {
    seal(files["imagery.tiles"], record.offset, record.size, record.checksum);
}

template <class Record, class Header>
void seal_table(Files& files, const char* name) {
    std::string table = files[name];
    if (table.size() < sizeof(Header)) return;
    for (std::size_t at = sizeof(Header); at + sizeof(Record) <= table.size(); at += sizeof(Record)) {
        Record record;
        std::memcpy(&record, &table[at], sizeof record);
        seal(files, record);
        std::memcpy(&table[at], &record, sizeof record);
    }
    const auto records = std::as_bytes(std::span(table)).subspan(sizeof(Header));
    const auto header = io::header_of<Header>(records, records.size() / sizeof(Record));
    std::memcpy(table.data(), &header, sizeof header);
    files[name] = table;
}

Files sealed_files(Files files) {
    if (const auto json = test::sealed(files["terrain.json"])) files["terrain.json"] = *json;
    seal_table<io::NodeRecord, io::NodesHeader>(files, "nodes.bin");
    if (files.contains("imagery.bin")) seal_table<io::ImageryRecord, io::ImageryHeader>(files, "imagery.bin");
    return files;
}

void decode_all(const io::Store& store) {
    io::ChunkReader reader(store);
    io::OwnedChunk chunk;
    for (std::int64_t i = 0; i < store.grid().node_count(); ++i) {
        const io::NodeId node = store.grid().node_at(i);
        if (store.record(node).has_data()) (void)reader.read(node, chunk);
    }
}

Verdict try_files(const Files& files) {
    static const Folder kFolder;
    kFolder.hold(files);
    const auto store = io::Store::open(kFolder.path());
    if (!store) return Verdict::refused;
    decode_all(*store);
    return io::verify_store(*store, [](std::int64_t, std::int64_t) {}) ? Verdict::sound : Verdict::refused;
}

}  // namespace

Verdict try_input(std::span<const std::uint8_t> bytes) {
    Input input(bytes);
    const Files files = unbundle(input);
    const Verdict as_it_stands = try_files(files);
    // What was sound is sound again; it need not be tried twice.
    if (as_it_stands == Verdict::refused) (void)try_files(sealed_files(files));
    return as_it_stands;
}

}  // namespace ridgeline::fuzz
