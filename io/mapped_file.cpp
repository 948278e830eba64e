#include "ridgeline/io/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace ridgeline::io {

Result<MappedFile> MappedFile::open(const std::filesystem::path& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return Error{path.string() + ": " + std::strerror(errno)};
    struct stat status {};
    const bool mappable = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0;
    const auto size = mappable ? static_cast<std::size_t>(status.st_size) : 0;
    void* const address = mappable ? ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file, 0) : MAP_FAILED;
    ::close(file);
    if (address == MAP_FAILED) return Error{path.string() + ": empty or not a regular file"};
    return MappedFile({static_cast<const std::byte*>(address), size});
}

void MappedFile::forget_pages() const {
    // Advice: where it is not taken, memory stays as it is.
    if (!bytes_.empty()) ::madvise(const_cast<std::byte*>(bytes_.data()), bytes_.size(), MADV_DONTNEED);
}

MappedFile::~MappedFile() {
    if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

}  // namespace ridgeline::io
