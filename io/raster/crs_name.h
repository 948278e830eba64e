// What people call a coordinate system: its name, and its number in a register. Any thread.
#pragma once

#include <string>

namespace ridgeline::raster {

struct CrsName {
    std::string name;       // "none" without a system
    std::string authority;  // "EPSG:32610"; empty where no register has it
};

// A system without a name of its own goes by that of its equal in the register, else by zone or projection
// and datum.
CrsName name_of_crs(const std::string& wkt);

}  // namespace ridgeline::raster
