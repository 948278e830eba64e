#include "ridgeline/base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <string>

namespace ridgeline {
namespace {

spdlog::level::level_enum spdlog_level(LogLevel level) {
    switch (level) {
        case LogLevel::trace:
            return spdlog::level::trace;
        case LogLevel::debug:
            return spdlog::level::debug;
        case LogLevel::info:
            return spdlog::level::info;
        case LogLevel::warn:
            return spdlog::level::warn;
        case LogLevel::error:
            return spdlog::level::err;
        case LogLevel::off:
            break;
    }
    return spdlog::level::off;
}

}  // namespace

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

void set_log_level(LogLevel level) { spdlog::set_level(spdlog_level(level)); }

bool is_logged(LogLevel level) { return spdlog::should_log(spdlog_level(level)); }

void log_line(LogLevel level, std::string_view text) {
    spdlog::default_logger_raw()->log(spdlog_level(level), spdlog::string_view_t(text.data(), text.size()));
}

}  // namespace ridgeline
