// GPU buffers of immutable storage; those that the CPU writes or reads stay mapped for as long as they live.
//
// Move-only; render thread only, but the memory of a mapped buffer may be filled by any one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/object.h"

namespace ridgeline::gl {

enum class BufferUse {
    gpu,       // written by the GPU or by copies alone
    update,    // also by Buffer::write
    upload,    // mapped for writing, coherent
    readback,  // mapped for reading, coherent
};

struct BufferOptions {
    std::uint64_t size_bytes = 0;
    BufferUse use = BufferUse::gpu;
    std::string label{};  // for GL's debug output
};

class Buffer {
  public:
    Buffer() = default;
    // Fails when the GPU has not the memory. `initial` fills the front; it may be shorter than the buffer.
    static Result<Buffer> create(const BufferOptions& options, std::span<const std::byte> initial = {});

    bool empty() const { return object_.empty(); }
    GLuint id() const { return object_.id(); }
    std::uint64_t size_bytes() const { return size_bytes_; }
    // Empty unless the use is upload or readback.
    std::span<std::byte> mapped() const { return mapped_; }

    // use = update.
    void write(std::uint64_t offset_bytes, std::span<const std::byte> bytes);
    // Fills with a repeated 32-bit value.
    void clear(std::uint32_t value = 0);
    void bind(GLenum target) const { glBindBuffer(target, id()); }
    // Binds to an indexed target: GL_UNIFORM_BUFFER, GL_SHADER_STORAGE_BUFFER.
    void bind_base(GLenum target, GLuint index) const { glBindBufferBase(target, index, id()); }
    void bind_range(GLenum target, GLuint index, std::uint64_t offset_bytes, std::uint64_t size_bytes) const;

  private:
    struct Traits {
        static void destroy(GLuint id) { glDeleteBuffers(1, &id); }
    };
    Object<Traits> object_;
    std::uint64_t size_bytes_ = 0;
    std::span<std::byte> mapped_;
};

// dst[dst_offset..] = src[src_offset..], on the GPU.
void copy(const Buffer& src, std::uint64_t src_offset_bytes, const Buffer& dst,
          std::uint64_t dst_offset_bytes, std::uint64_t size_bytes);

// The bytes of a value or of a range of values, for the functions that take bytes.
template <class T>
std::span<const std::byte> bytes_of(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}
template <class T>
std::span<const std::byte> bytes_of(std::span<T> values) {
    return std::as_bytes(values);
}

}  // namespace ridgeline::gl
