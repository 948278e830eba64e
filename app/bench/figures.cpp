#include "ridgeline/app/bench/figures.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "ridgeline/base/json_text.h"

namespace ridgeline::app {
namespace {

template <class Value>
auto find_name(std::vector<std::pair<std::string, Value>>& pairs, const std::string& name) {
    return std::find_if(pairs.begin(), pairs.end(), [&](const auto& pair) { return pair.first == name; });
}

// Four significant digits; whole numbers in full.
std::string number(double value) {
    std::array<char, 32> text{};
    const char* format = value >= 1000.0 ? "%.0f" : "%.4g";
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

}  // namespace

void Figures::set(const std::string& variant, const std::string& metric, double value) {
    auto row = find_name(rows_, variant);
    if (row == rows_.end()) row = rows_.insert(rows_.end(), {variant, {}});
    const auto cell = find_name(row->second, metric);
    if (cell == row->second.end())
        row->second.emplace_back(metric, value);
    else
        cell->second = value;
}

const double* Figures::find(const std::string& variant, const std::string& metric) const {
    for (const auto& [name, row] : rows_)
        for (const auto& [key, value] : row)
            if (name == variant && key == metric) return &value;
    return nullptr;
}

std::vector<std::string> Figures::variants() const {
    std::vector<std::string> names;
    for (const auto& [variant, row] : rows_) names.push_back(variant);
    return names;
}

std::string Figures::to_json() const {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (const auto& [variant, row] : rows_)
        for (const auto& [metric, value] : row) json[variant][metric] = value;
    return json_text(json, 2) + "\n";
}

std::vector<std::string> Figures::metric_names() const {
    std::vector<std::string> names;
    for (const auto& [variant, row] : rows_)
        for (const auto& [metric, value] : row)
            if (std::find(names.begin(), names.end(), metric) == names.end()) names.push_back(metric);
    return names;
}

std::string Figures::to_table() const {
    std::vector<std::vector<std::string>> cells{{""}};
    const std::vector<std::string> names = metric_names();
    cells.front().insert(cells.front().end(), names.begin(), names.end());
    for (const auto& [variant, row] : rows_) {
        cells.push_back({variant});
        for (const std::string& name : names) {
            const double* value = find(variant, name);
            cells.back().push_back(value != nullptr ? number(*value) : std::string());
        }
    }
    std::string table;
    for (const auto& line : cells) {
        for (std::size_t column = 0; column < line.size(); ++column) {
            std::size_t width = 0;
            for (const auto& other : cells) width = std::max(width, other[column].size());
            const std::string pad(width - line[column].size(), ' ');
            table += column == 0 ? line[column] + pad : "  " + pad + line[column];
        }
        table += '\n';
    }
    return table;
}

std::string Figures::table(const char* title, const char* of,
                           std::initializer_list<FigureColumn> columns) const {
    Figures picked;
    for (const std::string& variant : variants()) {
        if (find(variant, of) == nullptr) continue;
        for (const FigureColumn& column : columns)
            if (const double* value = find(variant, column.metric))
                picked.set(variant, column.heading, *value / column.unit);
    }
    return std::string(title) + "\n" + picked.to_table() + "\n";
}

}  // namespace ridgeline::app
