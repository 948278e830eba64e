// The variants that suite `horizon` compares. The first is what the others are held against.
#pragma once

#include <array>
#include <string>

#include "ridgeline/select/view.h"

namespace ridgeline::app {

struct HorizonVariant {
    const char* name;
    select::HorizonMode mode;

    std::string on(const std::string& path) const { return path + "/" + name; }
};

constexpr std::array<HorizonVariant, 3> kHorizonVariants = {{{"off", select::HorizonMode::off},
                                                             {"boxes", select::HorizonMode::boxes},
                                                             {"ridges", select::HorizonMode::ridges}}};

}  // namespace ridgeline::app
