#include "gdal_session.h"

#include <gdal.h>

#include <algorithm>
#include <mutex>

namespace ridgeline::raster {
namespace {

std::string one_line(const char* message) {
    std::string line = message;
    std::replace(line.begin(), line.end(), '\n', ' ');
    while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
    return line;
}

}  // namespace

void prepare_gdal(std::uint64_t cache_bytes) {
    static std::once_flag once;
    std::call_once(once, [] {
        CPLSetErrorHandler(CPLQuietErrorHandler);
        GDALAllRegister();
    });
    GDALSetCacheMax64(static_cast<GIntBig>(cache_bytes));
}

GdalMessages::GdalMessages() { CPLPushErrorHandlerEx(&GdalMessages::hear, this); }

GdalMessages::~GdalMessages() { CPLPopErrorHandler(); }

void GdalMessages::hear(CPLErr level, CPLErrorNum, const char* message) {
    auto* self = static_cast<GdalMessages*>(CPLGetErrorHandlerUserData());
    if (level >= CE_Failure && self->failure_.empty()) self->failure_ = one_line(message);
    if (level == CE_Warning) self->warning_ = one_line(message);
}

std::string GdalMessages::why(const std::string& otherwise) const {
    if (!failure_.empty()) return failure_;
    return warning_.empty() ? otherwise : warning_;
}

}  // namespace ridgeline::raster
