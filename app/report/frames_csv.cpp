#include "ridgeline/app/report/frames_csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "ridgeline/base/whole_file.h"

namespace ridgeline::app::report {
namespace {

// 100 000 frames are 20 MB; beyond this it is no walk's.
constexpr std::size_t kLargestFile_bytes = std::size_t{1} << 30;
// More than any counter counts, and far from where sums and squares overflow.
constexpr double kLargestValue = 1e18;
// Names in messages are cut to what fits a line.
constexpr std::size_t kShownName = 40;

using Columns = std::vector<std::pair<std::string, std::vector<double>>>;

// The next line, without its end, which is taken off `text`.
std::string_view take_line(std::string_view& text) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

std::string_view take_cell(std::string_view& line) {
    const std::size_t end = line.find(',');
    std::string_view cell = line.substr(0, end);
    line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
    while (cell.starts_with(' ')) cell.remove_prefix(1);
    while (cell.ends_with(' ')) cell.remove_suffix(1);
    return cell;
}

std::size_t count_cells(std::string_view line) {
    return static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
}

std::string shown(std::string_view text) {
    return "'" + std::string(text.substr(0, kShownName)) + (text.size() > kShownName ? "…'" : "'");
}

// NaN where nothing was measured; nothing where it is no number that a walk writes.
std::optional<double> number(std::string_view cell) {
    if (cell.empty() || cell == "nan" || cell == "-nan") return std::numeric_limits<double>::quiet_NaN();
    double value = 0.0;
    const auto [end, status] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (status != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
    // Written so that NaN is refused too: only "nan" stands for it.
    if (!(std::abs(value) <= kLargestValue)) return std::nullopt;
    return value;
}

Result<Columns> parse_names(std::string_view line, const std::string& name) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
    if (line.empty()) return Error{name + ": is empty, no telemetry of a walk"};
    Columns columns;
    for (std::size_t left = count_cells(line); left > 0; --left) {
        const std::string_view column = take_cell(line);
        const auto same = [column](const auto& other) { return other.first == column; };
        if (std::any_of(columns.begin(), columns.end(), same))
            return Error{name + ": has two columns " + shown(column)};
        columns.emplace_back(column, std::vector<double>());
    }
    const auto is_frame = [](const auto& column) {
        return column.first == "frame" || column.first == "frame_ms";
    };
    if (std::none_of(columns.begin(), columns.end(), is_frame))
        return Error{name + ": has neither a column frame nor frame_ms, so it is no telemetry of a walk"};
    return columns;
}

Result<void> parse_row(std::string_view line, const std::string& place, Columns& columns) {
    if (const std::size_t cells = count_cells(line); cells != columns.size())
        return Error{place + ": has " + std::to_string(cells) + " cells for " +
                     std::to_string(columns.size()) + " columns"};
    for (auto& [column, values] : columns) {
        const std::string_view cell = take_cell(line);
        const auto value = number(cell);
        if (!value)
            return Error{place + ": " + shown(cell) + " is no number that a walk writes, in column " +
                         shown(column)};
        values.push_back(*value);
    }
    return {};
}

}  // namespace

const std::vector<double>* FrameTable::find(std::string_view column) const {
    for (const auto& [name, values] : columns_)
        if (name == column) return &values;
    return nullptr;
}

Result<FrameTable> parse_frames_csv(std::string_view text, const std::string& name) {
    auto columns = parse_names(take_line(text), name);
    if (!columns) return columns.error();
    for (std::size_t line_number = 2; !text.empty(); ++line_number) {
        const std::string_view line = take_line(text);
        if (line.empty() && text.empty()) break;
        RIDGELINE_TRY(parse_row(line, name + ": line " + std::to_string(line_number), *columns));
    }
    return FrameTable(std::move(*columns));
}

Result<FrameTable> read_frames_csv(const std::filesystem::path& file) {
    const auto text = read_text_file(file, kLargestFile_bytes);
    if (!text) return text.error();
    return parse_frames_csv(*text, file.string());
}

}  // namespace ridgeline::app::report
