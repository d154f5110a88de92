// Sketches as our own JSON.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

#include "error.h"
#include "sketch/read_sketch.h"
#include "sketch/sketch_fault.h"
#include "sketch/twig_stock.h"

namespace treerec {

namespace {

using Json = nlohmann::json;

constexpr const char* kFormat = "treerec sketch";
constexpr int kVersion = 1;
// All the points that a sketch may have, with their pressures, take less.
constexpr size_t kLargest = size_t{16} << 20U;  // bytes
constexpr double kMostRadius = 40.0, kMostDensity = 4.0;
constexpr int kDeepest = 8;  // of what is in what; ours has 4

// Reads one sketch; who: the subject of what it throws.
class Reader {
  public:
    explicit Reader(const std::string& who) : who_(who) {}

    Sketch read(std::string_view text, SketchOptions* options) const {
        const Json json = parse(text);
        require_ours(json);
        Sketch sketch;
        if (const Json* canvas = member(json, "canvas")) {
            const std::optional<DVec2> size = pair_of(*canvas);
            if (!size) fail("has a 'canvas' that is not [width, height] in pixels");
            sketch.canvas = *size;
        }
        sketch.height = number_of(json, "height", sketch.height);
        if (const Json* species = member(json, "species")) {
            if (!species->is_string()) fail("has a 'species' that is no text");
            sketch.species = species->get<std::string>();
        }
        if (const Json* seed = member(json, "seed")) {
            if (!seed->is_number_unsigned()) fail("has a 'seed' that is no whole number from 0 on");
            sketch.seed = seed->get<uint64_t>();
        }
        if (const Json* twigs = member(json, "twigs"))
            sketch.twigs =
                std::make_shared<const TwigStock>(parse_twig_stock(twigs->dump(), who_ + ": its twigs"));
        read_options(json, options);
        const Json* strokes = member(json, "strokes");
        if (!strokes || !strokes->is_array()) fail("has no list of 'strokes'");
        if (strokes->size() > kMostStrokes)
            fail("has " + std::to_string(strokes->size()) + " strokes; at most " +
                 std::to_string(kMostStrokes) + " make a tree");
        for (const Json& stroke : *strokes)
            sketch.strokes.push_back(stroke_of(stroke, sketch.strokes.size() + 1));
        const std::string fault = sketch_fault(sketch);
        if (!fault.empty()) throw Error(who_ + fault);
        sketch.number_strokes();
        return sketch;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { throw Error(who_ + " " + what + "."); }

    // They are checked, too, where nobody asks for them.
    void read_options(const Json& json, SketchOptions* options) const {
        SketchOptions told = options ? *options : SketchOptions();
        told.trunk_radius = number_of(json, "trunk_radius", told.trunk_radius);
        if (!(told.trunk_radius >= 0.0 && told.trunk_radius <= kMostRadius))
            fail("has a 'trunk_radius' that is not from 0 to 40 m");
        told.density = number_of(json, "density", told.density);
        if (!(told.density >= 0.0 && told.density <= kMostDensity))
            fail("has a 'density' that is not from 0 to 4");
        const auto word = [&](const char* name, const char* usual, const char* other, bool otherwise) {
            const Json* value = member(json, name);
            if (!value) return otherwise;
            if (*value != usual && *value != other)
                fail(std::string("has a '") + name + "' that is neither '" + usual + "' nor '" + other + "'");
            return *value == other;
        };
        told.depth = word("depth", "true", "paper", told.depth == SketchDepth::kPaper) ? SketchDepth::kPaper
                                                                                       : SketchDepth::kTrue;
        told.crown = word("crown", "sections", "alpha", told.crown == SketchCrown::kAlpha)
                         ? SketchCrown::kAlpha
                         : SketchCrown::kSections;
        if (options) *options = told;
    }

    Json parse(std::string_view text) const {
        if (text.size() > kLargest) fail("is larger than 16 MiB, which no sketch is");
        bool too_deep = false;
        const auto shallow = [&](int depth, Json::parse_event_t, Json&) {
            too_deep = too_deep || depth > kDeepest;
            return depth <= kDeepest;
        };
        Json json;
        try {
            json = Json::parse(text.begin(), text.end(), shallow);
        } catch (const Json::parse_error& error) {
            // It counts the bytes from 1.
            const std::string_view before = text.substr(0, error.byte > 0 ? error.byte - 1 : 0);
            const auto line = std::count(before.begin(), before.end(), '\n') + 1;
            const size_t start = before.rfind('\n') + 1;  // npos + 1 is 0
            fail("cannot be read as JSON: something is wrong or missing in line " + std::to_string(line) +
                 ", at its byte " + std::to_string(before.size() - start + 1));
        } catch (const Json::exception&) {
            // The one other thing that a text can have: 1e999.
            fail("has a number that is too large");
        }
        if (too_deep) fail("is JSON, but no sketch: it has lists in lists in lists");
        return json;
    }

    void require_ours(const Json& json) const {
        const Json* format = json.is_object() ? member(json, "format") : nullptr;
        if (!format) fail("is JSON, but no sketch: it does not begin with {\"format\": \"treerec sketch\"");
        if (!format->is_string() || *format != kFormat)
            fail("is no sketch: its format is " +
                 quote_word(format->is_string() ? format->get<std::string>() : "not told") +
                 ", and not 'treerec sketch'");
        const Json* version = member(json, "version");
        if (!version || !version->is_number_unsigned() || *version == 0)
            fail("does not tell the version of its format, a whole number from 1 on");
        if (*version > kVersion)
            fail("was written by a newer version of this program (its format is version " +
                 std::to_string(version->get<uint64_t>()) + ", and version " + std::to_string(kVersion) +
                 " is read here); update to open it");
    }

    Stroke stroke_of(const Json& json, size_t number) const {
        const std::string which = "has a stroke, number " + std::to_string(number) + ", ";
        if (!json.is_object()) fail(which + "that is no {\"points\": ...}");
        Stroke stroke;
        const Json* points = member(json, "points");
        if (!points || !points->is_array() || points->empty()) fail(which + "that has no points");
        stroke.points.reserve(points->size());
        for (const Json& point : *points) {
            const std::optional<DVec2> place = pair_of(point);
            if (!place)
                fail(which + "whose point " + std::to_string(stroke.points.size() + 1) +
                     " is not [x, y], two numbers");
            stroke.points.push_back(*place);
        }
        if (const Json* pressure = member(json, "pressure")) {
            if (!pressure->is_array()) fail(which + "whose 'pressure' is no list");
            stroke.pressure.reserve(pressure->size());
            for (const Json& value : *pressure) {
                if (!value.is_number()) fail(which + "that has a pressure that is no number");
                stroke.pressure.push_back(value.get<float>());
            }
        }
        if (const Json* role = member(json, "role")) {
            if (!role->is_string()) fail(which + "whose 'role' is no text");
            try {
                stroke.role = parse_stroke_role(role->get<std::string>());
            } catch (const Error& error) {
                throw Error(who_ + " " + which + "whose role is unknown. " + error.what());
            }
        }
        if (const Json* id = member(json, "id")) {
            if (!id->is_number_unsigned() || id->get<uint64_t>() > UINT32_MAX)
                fail(which + "whose 'id' is no whole number from 0 to 4294967295");
            stroke.id = id->get<uint32_t>();
        }
        return stroke;
    }

    double number_of(const Json& json, const char* name, double otherwise) const {
        const Json* value = member(json, name);
        if (!value) return otherwise;
        if (!value->is_number()) fail(std::string("has a '") + name + "' that is no number");
        return value->get<double>();
    }

    static std::optional<DVec2> pair_of(const Json& json) {
        if (!json.is_array() || json.size() != 2 || !json[0].is_number() || !json[1].is_number()) return {};
        return DVec2(json[0].get<double>(), json[1].get<double>());
    }

    static const Json* member(const Json& json, const char* name) {
        const auto found = json.find(name);
        return found != json.end() ? &*found : nullptr;
    }

    const std::string& who_;
};

// The shortest decimal that reads back as the same number.
template <typename Number>
void append(std::string& out, Number value) {
    std::array<char, 40> digits{};
    out.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

void append(std::string& out, const DVec2& pair) {
    out += '[';
    append(out, pair.x);
    out += ", ";
    append(out, pair.y);
    out += ']';
}

template <typename Values>
void append_list(std::string& out, const Values& values) {
    out += '[';
    for (size_t i = 0; i < values.size(); i++) {
        if (i > 0) out += ", ";
        append(out, values[i]);
    }
    out += ']';
}

}  // namespace

Sketch parse_sketch_json(std::string_view text, const std::string& who, SketchOptions* options) {
    return Reader(who).read(text, options);
}

std::string sketch_json(const Sketch& sketch, const SketchOptions& options) {
    check_sketch(sketch);
    std::string out = std::string("{\"format\": \"") + kFormat + "\", \"version\": ";
    append(out, kVersion);
    out += ",\n \"canvas\": ";
    append(out, sketch.canvas);
    out += ", \"height\": ";
    append(out, sketch.height);
    // A species' name may be anything that a resource holds.
    out += ", \"species\": " + Json(sketch.species).dump(-1, ' ', true, Json::error_handler_t::replace);
    out += ", \"seed\": ";
    append(out, sketch.seed);
    if (options.depth == SketchDepth::kPaper) out += ", \"depth\": \"paper\"";
    if (options.crown == SketchCrown::kAlpha) out += ", \"crown\": \"alpha\"";
    const SketchOptions usual;
    if (options.trunk_radius != usual.trunk_radius) {
        out += ", \"trunk_radius\": ";
        append(out, options.trunk_radius);
    }
    if (options.density != usual.density) {
        out += ", \"density\": ";
        append(out, options.density);
    }
    if (sketch.twigs) out += ",\n \"twigs\": " + twig_stock_json(*sketch.twigs);
    out += ",\n \"strokes\": [";
    for (size_t i = 0; i < sketch.strokes.size(); i++) {
        const Stroke& stroke = sketch.strokes[i];
        out += i > 0 ? ",\n  {\"id\": " : "\n  {\"id\": ";
        append(out, stroke.id);
        out += std::string(", \"role\": \"") + stroke_role_name(stroke.role) + "\", \"points\": ";
        append_list(out, stroke.points);
        if (!stroke.pressure.empty()) {
            out += ", \"pressure\": ";
            append_list(out, stroke.pressure);
        }
        out += '}';
    }
    return out + (sketch.strokes.empty() ? "]}\n" : "\n ]}\n");
}

}  // namespace treerec
