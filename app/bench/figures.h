// What a suite found: variants by name, each with its metrics, in the order in which they came.
//
// One thread at a time.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace ridgeline::app {

class Figures {
  public:
    // variant: PATH/VARIANT; metric: names joined by dots, with a unit (skyline_px.mean).
    void set(const std::string& variant, const std::string& metric, double value);
    // Null where it was not set.
    const double* find(const std::string& variant, const std::string& metric) const;

    std::vector<std::string> variants() const;

    // {variant: {metric: value}}.
    std::string to_json() const;
    // A row a variant, a column a metric; what a variant lacks is left blank.
    std::string to_table() const;

  private:
    using Row = std::vector<std::pair<std::string, double>>;

    std::vector<std::string> metric_names() const;

    std::vector<std::pair<std::string, Row>> rows_;
};

}  // namespace ridgeline::app
