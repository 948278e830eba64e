// CPU time by thread, as bars. HTML.
#pragma once

#include <span>
#include <string>

#include "ridgeline/app/report/run_folder.h"

namespace ridgeline::app::report {

// Empty where no run says.
std::string cpu_by_thread(std::span<const RunFolder> runs);

}  // namespace ridgeline::app::report
