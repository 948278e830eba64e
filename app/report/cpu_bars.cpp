#include "ridgeline/app/report/cpu_bars.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ridgeline/app/report/curve_chart.h"
#include "ridgeline/app/report/headline.h"
#include "ridgeline/app/report/html_text.h"
#include "ridgeline/app/report/quantity.h"

namespace ridgeline::app::report {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct Thread {
    const char* figure;
    const char* name;
};
constexpr std::array kThreads = {
    Thread{"cpu_percent.render", "Render thread"}, Thread{"cpu_percent.workers", "Job workers"},
    Thread{"cpu_percent.io", "I/O thread"}, Thread{nullptr, "All others, drivers too"},
    Thread{"cpu_percent.process", "The whole process"}};

double known(const RunFolder& run, const char* figure) {
    const double* value = run.summary.find(figure);
    return value != nullptr ? *value : kUnknown;
}

// Of a thread, or what is left of the process without the threads that are named.
double percent(const RunFolder& run, const Thread& thread) {
    if (thread.figure != nullptr) return known(run, thread.figure);
    const double left = known(run, "cpu_percent.process") - known(run, "cpu_percent.render") -
                        known(run, "cpu_percent.workers") - known(run, "cpu_percent.io");
    return std::isnan(left) ? left : std::max(left, 0.0);
}

double most_of(std::span<const RunFolder> runs) {
    double most = 0.0;
    for (const RunFolder& run : runs)
        for (const Thread& thread : kThreads)
            if (const double value = percent(run, thread); value > most) most = value;
    return most;
}

std::string bar(double value, double most, std::size_t run) {
    const double share = std::isnan(value) ? 0.0 : std::max(value, 0.0) / most;
    return "<div class=\"bar run " + colour_class(run) + "\"><i style=\"width:" + percent_of(share) +
           "\"></i><span>" + quantity(value, Unit::percent) + "</span></div>";
}

}  // namespace

std::string cpu_by_thread(std::span<const RunFolder> runs) {
    const double most = most_of(runs);
    if (most <= 0.0) return {};
    std::string html =
        "<figure class=\"chart\"><figcaption><h3>CPU by thread</h3><p>of one core, mean over the "
        "run</p></figcaption><table class=\"bars\">";
    for (const Thread& thread : kThreads) {
        html += "<tr><th scope=\"row\">" + std::string(thread.name) + "</th><td>";
        for (std::size_t run = 0; run < runs.size(); ++run)
            html += bar(percent(runs[run], thread), most, run);
        html += "</td></tr>";
    }
    return html + "</table></figure>\n";
}

}  // namespace ridgeline::app::report
