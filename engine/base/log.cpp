#include "ridgeline/base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>

#include <string>

namespace ridgeline {

Result<void> set_up_logging(std::string_view level) {
    const auto parsed = spdlog::level::from_str(std::string(level));
    if (parsed == spdlog::level::off && level != "off")
        return Error{"log level '" + std::string(level) + "': use trace, debug, info, warn, error or off"};
    static const auto logger = spdlog::stderr_color_mt("ridgeline");
    spdlog::set_default_logger(logger);
    spdlog::set_pattern("ridgeline: %^%l%$: %v");
    spdlog::set_level(parsed);
    return {};
}

}  // namespace ridgeline
