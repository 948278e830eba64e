// The page's style and script, which are written into it.
#pragma once

#include <string_view>

namespace ridgeline::app::report {

// CSS: light, dark where the reader's system is, and print, which is always light.
extern const std::string_view kPageStyle;
// JavaScript: the crosshair that all charts share, and runs that are hidden and shown. The page says all
// without it.
extern const std::string_view kPageScript;

}  // namespace ridgeline::app::report
