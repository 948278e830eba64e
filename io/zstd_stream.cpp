#include "ridgeline/io/zstd_stream.h"

#include <zstd.h>

#include <memory>

namespace ridgeline::io {
namespace {

struct FreeContext {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

}  // namespace

void compress(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& out, int level) {
    thread_local const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
    const std::size_t before = out.size();
    out.resize(before + ZSTD_compressBound(bytes.size()));
    const std::size_t size = ZSTD_compressCCtx(context.get(), out.data() + before, out.size() - before,
                                               bytes.data(), bytes.size(), level);
    RIDGELINE_CHECK(!ZSTD_isError(size));
    out.resize(before + size);
}

Result<void> decompress(std::span<const std::uint8_t> compressed, std::span<std::uint8_t> bytes) {
    thread_local const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
    const std::size_t size =
        ZSTD_decompressDCtx(context.get(), bytes.data(), bytes.size(), compressed.data(), compressed.size());
    if (ZSTD_isError(size) || size != bytes.size())
        return Error{"damaged payload: its compressed part does not unpack"};
    return {};
}

Result<void> decompress_front(std::span<const std::uint8_t>& compressed, std::span<std::uint8_t> bytes) {
    const std::size_t size = ZSTD_findFrameCompressedSize(compressed.data(), compressed.size());
    if (ZSTD_isError(size)) return Error{"damaged payload: its compressed part is cut off"};
    const auto frame = compressed.first(size);
    compressed = compressed.subspan(size);
    return decompress(frame, bytes);
}

}  // namespace ridgeline::io
