#include "ridgeline/gl/buffer.h"

#include "ridgeline/base/units.h"
#include "ridgeline/gl/debug_output.h"
#include "ridgeline/gl/memory_check.h"

namespace ridgeline::gl {

namespace {

constexpr GLbitfield storage_flags(BufferUse use) {
    switch (use) {
        case BufferUse::gpu:
            return 0;
        case BufferUse::update:
            return GL_DYNAMIC_STORAGE_BIT;
        case BufferUse::upload:
            return GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
        // Client storage: read back bytes belong in memory that the CPU reads fast.
        case BufferUse::readback:
            return GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT | GL_CLIENT_STORAGE_BIT;
    }
    return 0;
}

constexpr GLbitfield mapping_flags(BufferUse use) {
    return storage_flags(use) & ~GLbitfield{GL_DYNAMIC_STORAGE_BIT | GL_CLIENT_STORAGE_BIT};
}

}  // namespace

Result<Buffer> Buffer::create(const BufferOptions& options, std::span<const std::byte> initial) {
    RIDGELINE_ASSERT_ROLE(render);
    RIDGELINE_CHECK(options.size_bytes > 0 && initial.size() <= options.size_bytes);
    GLuint id = 0;
    glCreateBuffers(1, &id);
    Buffer buffer;
    buffer.object_ = Object<Traits>(id);
    buffer.size_bytes_ = options.size_bytes;
    // A shorter front cannot be given to glNamedBufferStorage, which reads as many bytes as it reserves.
    const bool whole = initial.size() == options.size_bytes;
    const GLbitfield fill_later = !whole && !initial.empty() ? GL_DYNAMIC_STORAGE_BIT : 0;
    const MemoryCheck memory;
    glNamedBufferStorage(id, static_cast<GLsizeiptr>(options.size_bytes), whole ? initial.data() : nullptr,
                         storage_flags(options.use) | fill_later);
    RIDGELINE_TRY(memory.finish(options.label, options.size_bytes));
    set_label(GL_BUFFER, id, options.label);
    if (fill_later != 0) buffer.write(0, initial);
    if (mapping_flags(options.use) == 0) return buffer;
    void* address =
        glMapNamedBufferRange(id, 0, static_cast<GLsizeiptr>(options.size_bytes), mapping_flags(options.use));
    if (address == nullptr)
        return Error{options.label + ": the GPU driver cannot map " + format_bytes(options.size_bytes)};
    buffer.mapped_ = {static_cast<std::byte*>(address), options.size_bytes};
    return buffer;
}

void Buffer::write(std::uint64_t offset_bytes, std::span<const std::byte> bytes) {
    RIDGELINE_ASSERT_ROLE(render);
    RIDGELINE_CHECK(offset_bytes + bytes.size() <= size_bytes_);
    glNamedBufferSubData(id(), static_cast<GLintptr>(offset_bytes), static_cast<GLsizeiptr>(bytes.size()),
                         bytes.data());
}

void Buffer::clear(std::uint32_t value) {
    glClearNamedBufferData(id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
}

void Buffer::bind_range(GLenum target, GLuint index, std::uint64_t offset_bytes,
                        std::uint64_t size_bytes) const {
    RIDGELINE_ASSERT(offset_bytes + size_bytes <= size_bytes_);
    glBindBufferRange(target, index, id(), static_cast<GLintptr>(offset_bytes),
                      static_cast<GLsizeiptr>(size_bytes));
}

void copy(const Buffer& src, std::uint64_t src_offset_bytes, const Buffer& dst,
          std::uint64_t dst_offset_bytes, std::uint64_t size_bytes) {
    RIDGELINE_ASSERT_ROLE(render);
    RIDGELINE_CHECK(src_offset_bytes + size_bytes <= src.size_bytes());
    RIDGELINE_CHECK(dst_offset_bytes + size_bytes <= dst.size_bytes());
    glCopyNamedBufferSubData(src.id(), dst.id(), static_cast<GLintptr>(src_offset_bytes),
                             static_cast<GLintptr>(dst_offset_bytes), static_cast<GLsizeiptr>(size_bytes));
}

}  // namespace ridgeline::gl
