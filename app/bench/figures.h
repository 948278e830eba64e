// What a suite found: variants by name, each with its metrics, in the order in which they came.
//
// One thread at a time.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace ridgeline::app {

// A column of a table: a metric, in units of its own.
struct FigureColumn {
    const char* metric;
    const char* heading;  // another one in each column
    double unit = 1.0;
};

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
    // Under a title: these columns, of the variants that have the metric `of`.
    std::string table(const char* title, const char* of, std::initializer_list<FigureColumn> columns) const;

  private:
    using Row = std::vector<std::pair<std::string, double>>;

    std::vector<std::string> metric_names() const;

    std::vector<std::pair<std::string, Row>> rows_;
};

}  // namespace ridgeline::app
