#include <nlohmann/json.hpp>

#include <cmath>

#include "ridgeline/base/json_text.h"
#include "ridgeline/base/whole_file.h"
#include "ridgeline/platform/path.h"

namespace ridgeline::platform {

namespace {

using nlohmann::json;

constexpr const char* kFormat = "ridgeline-path-1";
// A pose per frame is kept; a day of them takes 200 MB, and no walk is longer.
constexpr Seconds kLongestPath = std::chrono::hours(24);

Result<double> number_at(const json& sample, const char* key) {
    const auto found = sample.find(key);
    if (found == sample.end()) return Error{std::string("'") + key + "' is missing"};
    if (!found->is_number() || !std::isfinite(found->get<double>()))
        return Error{std::string("'") + key + "' is not a number"};
    return found->get<double>();
}

Result<void> read_number(const json& sample, const char* key, double& value) {
    const auto number = number_at(sample, key);
    if (!number) return number.error();
    value = *number;
    return {};
}

Result<PathSample> parse_sample(const json& object) {
    if (!object.is_object()) return Error{"not an object"};
    const bool above_ground = object.contains("above_ground");
    if (above_ground && object.contains("height")) return Error{"has both 'height' and 'above_ground'"};
    PathSample sample;
    sample.reference = above_ground ? HeightReference::above_ground : HeightReference::absolute;
    double t_s = 0.0;
    double heading_deg = 0.0;
    double pitch_deg = 0.0;
    RIDGELINE_TRY(read_number(object, "t", t_s));
    RIDGELINE_TRY(read_number(object, "east", sample.pose.eye_m.x));
    RIDGELINE_TRY(read_number(object, "north", sample.pose.eye_m.y));
    RIDGELINE_TRY(read_number(object, above_ground ? "above_ground" : "height", sample.pose.eye_m.z));
    RIDGELINE_TRY(read_number(object, "heading_deg", heading_deg));
    RIDGELINE_TRY(read_number(object, "pitch_deg", pitch_deg));
    if (std::abs(pitch_deg) > 90.0) return Error{"'pitch_deg' is not between -90 and 90"};
    sample.t = Seconds(t_s);
    sample.pose.heading = Angle::from_degrees(std::remainder(heading_deg, 360.0));
    sample.pose.pitch = Angle::from_degrees(pitch_deg);
    return sample;
}

Result<void> check_time(const CameraPath& path, Seconds t) {
    if (path.samples.empty()) return {};
    if (t <= path.samples.back().t) return Error{"'t' does not increase"};
    if (t - path.samples.front().t > kLongestPath)
        return Error{"'t' is more than a day after the first sample's"};
    return {};
}

Result<CameraPath> parse_samples(const json& samples) {
    CameraPath path;
    path.samples.reserve(samples.size());
    for (const json& object : samples) {
        const std::string where = "samples[" + std::to_string(path.samples.size()) + "]: ";
        const auto sample = parse_sample(object);
        if (!sample) return Error{where + sample.error().message};
        const auto timely = check_time(path, sample->t);
        if (!timely) return Error{where + timely.error().message};
        path.samples.push_back(*sample);
    }
    return path;
}

json to_json(const PathSample& sample) {
    return {{"t", sample.t.count()},
            {"east", sample.pose.eye_m.x},
            {"north", sample.pose.eye_m.y},
            {sample.reference == HeightReference::absolute ? "height" : "above_ground", sample.pose.eye_m.z},
            {"heading_deg", sample.pose.heading.degrees()},
            {"pitch_deg", sample.pose.pitch.degrees()}};
}

}  // namespace

Result<CameraPath> parse_path(std::string_view text, const std::string& name) {
    const json root = parse_json(text);
    if (root.is_discarded()) return Error{name + ": not a path: not JSON"};
    if (!root.is_object() || root.value("format", json()) != kFormat)
        return Error{name + ": not a path: \"format\" is not \"" + kFormat + "\""};
    const auto samples = root.find("samples");
    if (samples == root.end() || !samples->is_array() || samples->empty())
        return Error{name + ": not a path: \"samples\" is not a list of at least one sample"};
    auto path = parse_samples(*samples);
    if (!path) return Error{name + ": " + path.error().message};
    return path;
}

Result<CameraPath> load_path(const std::filesystem::path& file) {
    const auto text = read_text_file(file);
    if (!text) return text.error();
    return parse_path(*text, file.string());
}

std::string path_to_json(const CameraPath& path) {
    // One sample a line, so that people and diffs can read it.
    std::string text = std::string("{\"format\": \"") + kFormat + "\", \"samples\": [\n";
    for (std::size_t i = 0; i < path.samples.size(); ++i)
        text += json_text(to_json(path.samples[i])) + (i + 1 < path.samples.size() ? ",\n" : "\n");
    return text + "]}\n";
}

Result<void> save_path(const CameraPath& path, const std::filesystem::path& file) {
    RIDGELINE_CHECK(!path.samples.empty());
    return write_whole_file(file, path_to_json(path));
}

}  // namespace ridgeline::platform
