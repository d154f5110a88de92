#include "sketch/read_branch.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "error.h"
#include "file_bytes.h"
#include "sketch/strokes.h"

namespace treerec {

namespace {

using Json = nlohmann::json;

constexpr int kVersion = 1;
constexpr const char* kFormat = "treerec branch";
constexpr const char* kOldFormat = "treerec limb";
constexpr int kLargestPicture = 100000;  // pixels

struct Reader {
    const std::string& who;

    [[noreturn]] void fail(const std::string& what) const { throw Error(who + ": " + what); }

    const Json& member(const Json& object, const char* name) const {
        if (!object.is_object() || !object.contains(name)) fail(std::string("\"") + name + "\" is missing.");
        return object[name];
    }

    double number(const Json& value, const char* name) const {
        if (!value.is_number() || !std::isfinite(value.get<double>()))
            fail(std::string("\"") + name + "\" has something that is no number.");
        return value.get<double>();
    }

    template <typename Vector>
    Vector vector(const Json& value, const char* name) const {
        constexpr int count = Vector::length();
        if (!value.is_array() || value.size() != static_cast<size_t>(count))
            fail(std::string("\"") + name + "\" must be " + std::to_string(count) + " numbers.");
        Vector v(0.0);
        for (int i = 0; i < count; i++)
            v[i] = number(value[static_cast<size_t>(i)], name);
        return v;
    }

    PinholeView view(const Json& camera, bool of_scan, const ScanFrame& frame) const {
        DVec3 place = vector<DVec3>(member(camera, "position"), "position");
        DVec3 right = vector<DVec3>(member(camera, "right"), "right");
        DVec3 up = vector<DVec3>(member(camera, "up"), "up");
        if (of_scan) {
            place = frame.to_tree(place);
            right = frame.turn_to_tree(right);
            up = frame.turn_to_tree(up);
        }
        const DVec3 back = glm::cross(right, up);
        if (!(glm::length(back) > 1e-6 * glm::length(right) * glm::length(up)) || !is_finite(back) ||
            !(glm::length(back) > 1e-12))
            fail("the camera's \"right\" and \"up\" must be two directions.");
        PinholeView view;
        view.turn[0] = glm::normalize(right);
        view.turn[2] = glm::normalize(back);
        view.turn[1] = glm::cross(view.turn[2], view.turn[0]);
        view.centre = place;
        view.focal = number(member(camera, "focal"), "focal");
        if (!(view.focal > 0.0)) fail("the camera's \"focal\" must be above 0.");
        const DVec2 size = vector<DVec2>(member(camera, "size"), "size");
        if (!(size.x >= 1.0 && size.y >= 1.0 && size.x <= kLargestPicture && size.y <= kLargestPicture))
            fail("the camera's \"size\" must be 1 to " + std::to_string(kLargestPicture) + " pixels.");
        view.width = static_cast<int>(size.x);
        view.height = static_cast<int>(size.y);
        view.principal = camera.contains("principal") ? vector<DVec2>(camera["principal"], "principal")
                                                      : 0.5 * DVec2(view.width, view.height);
        return view;
    }

    std::vector<BranchStroke> read(std::string_view text, const ScanFrame& frame) const {
        const Json json = Json::parse(text.begin(), text.end(), nullptr, false);
        if (json.is_discarded()) fail("this is no JSON.");
        const Json& format = member(json, "format");
        if (format != kFormat && format != kOldFormat)
            fail(std::string("\"format\" must be \"") + kFormat + "\".");
        const double version = number(member(json, "version"), "version");
        if (version > kVersion) fail("it is of a newer version of Tree Reconstruction: update to read it.");
        if (version != kVersion) fail("\"version\" must be 1.");
        bool of_scan = true;
        if (json.contains("space")) {
            const Json& space = json["space"];
            if (space != "scan" && space != "tree") fail("\"space\" is \"scan\" or \"tree\".");
            of_scan = space == "scan";
        }
        const PinholeView seen = view(member(json, "camera"), of_scan, frame);
        const Json& strokes = member(json, "strokes");
        if (!strokes.is_array() || strokes.empty()) fail("\"strokes\" must be a list with at least one.");
        if (strokes.size() > kMostStrokes)
            fail("there are more than " + std::to_string(kMostStrokes) + " strokes.");
        std::vector<BranchStroke> read;
        size_t count = 0;
        for (const Json& one : strokes) {
            const Json& points = member(one, "points");
            if (!points.is_array() || points.empty()) fail("\"points\" must be a list with at least one.");
            count += points.size();
            if (count > kMostStrokePoints)
                fail("there are more than " + std::to_string(kMostStrokePoints) + " points.");
            BranchStroke stroke;
            stroke.view = seen;
            for (const Json& point : points)
                stroke.points.push_back(vector<DVec2>(point, "points"));
            read.push_back(std::move(stroke));
        }
        return read;
    }
};

nlohmann::ordered_json list(const DVec3& v) {
    return {v.x, v.y, v.z};
}

nlohmann::ordered_json list(const DVec2& v) {
    return {v.x, v.y};
}

}  // namespace

std::vector<BranchStroke> parse_branch_json(std::string_view text, const ScanFrame& frame,
                                            const std::string& who) {
    return Reader{who}.read(text, frame);
}

std::vector<BranchStroke> read_branch_strokes(const std::string& path, const ScanFrame& frame) {
    return parse_branch_json(read_file(path).view(), frame, "'" + path + "'");
}

bool is_branch_file(const std::string& path) {
    const auto bytes = read_file(path);
    const Json json = Json::parse(bytes.view().begin(), bytes.view().end(), nullptr, false);
    return json.is_object() && json.contains("format") &&
           (json["format"] == kFormat || json["format"] == kOldFormat);
}

std::string branch_json(const std::vector<BranchStroke>& strokes) {
    const PinholeView& view = strokes.front().view;
    nlohmann::ordered_json json;
    json["format"] = kFormat;
    json["version"] = kVersion;
    json["space"] = "tree";
    json["camera"] = {{"position", list(view.centre)},     {"right", list(view.turn[0])},
                      {"up", list(view.turn[1])},          {"focal", view.focal},
                      {"size", {view.width, view.height}}, {"principal", list(view.principal)}};
    json["strokes"] = nlohmann::ordered_json::array();
    for (const BranchStroke& stroke : strokes) {
        nlohmann::ordered_json points = nlohmann::ordered_json::array();
        for (const DVec2& p : stroke.points)
            points.push_back(list(p));
        json["strokes"].push_back({{"points", points}});
    }
    return json.dump() + "\n";
}

}  // namespace treerec
