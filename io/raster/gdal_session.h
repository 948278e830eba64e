// GDAL, tamed: registered once, silent on stderr, its messages caught for our own one-line errors.
//
// Thread rules: a GdalMessages catches what GDAL says on its own thread while it lives; scopes nest, the
// innermost hears. What GDAL's worker threads say of their own is dropped: the calling thread hears of the
// failure itself.
#pragma once

#include <cpl_error.h>

#include <cstdint>
#include <string>

namespace ridgeline::raster {

// Registers the drivers, silences GDAL's default handler for all threads, and sets the size of the block
// cache.
void prepare_gdal(std::uint64_t cache_bytes);

class GdalMessages {
  public:
    GdalMessages();
    ~GdalMessages();
    GdalMessages(const GdalMessages&) = delete;
    GdalMessages& operator=(const GdalMessages&) = delete;

    // Whether a message of class failure was heard: then data that came back is not to be trusted.
    bool failed() const { return !failure_.empty(); }
    // The first failure, else the last warning, else `otherwise`; one line.
    std::string why(const std::string& otherwise) const;

  private:
    static void CPL_STDCALL hear(CPLErr level, CPLErrorNum number, const char* message);
    std::string failure_;
    std::string warning_;
};

}  // namespace ridgeline::raster
