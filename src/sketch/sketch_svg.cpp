// Sketches from SVG drawings.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "error.h"
#include "file_bytes.h"
#include "sketch/read_sketch.h"
#include "sketch/sketch_fault.h"
#include "sketch/svg_path.h"
#include "sketch/xml_scan.h"

namespace treerec {

namespace {

constexpr size_t kLargest = size_t{64} << 20U;  // bytes
constexpr size_t kDeepest = 1000;               // groups in groups
constexpr double kTolerance = 0.25;             // pixels of a canvas that is kCanvasHeight high
constexpr double kMargin = 0.05;                // around a drawing without a size, of its longer side

// A word of a name: 'trunk_left', 'Branch 3' and 'branches' tell a role, 'outlined' does not.
std::optional<StrokeRole> role_told_by(const std::string& name) {
    std::string word;
    for (const char c : lower_case(name) + ".") {
        if (c >= 'a' && c <= 'z') {
            word += c;
            continue;
        }
        if (word == "trunk") return StrokeRole::kTrunk;
        if (word == "outline") return StrokeRole::kOutline;
        if (word == "branch" || word == "branches") return StrokeRole::kBranch;
        word.clear();
    }
    return {};
}

// The value of a property: of the element's style, which goes before an attribute of that name.
std::string property(const XmlTag& tag, std::string_view name) {
    if (const std::string* style = tag.find("style")) {
        std::string_view rest = *style;
        while (!rest.empty()) {
            std::string_view one = rest.substr(0, rest.find(';'));
            rest.remove_prefix(std::min(one.size() + 1, rest.size()));
            const size_t colon = one.find(':');
            if (colon == std::string_view::npos) continue;
            const auto trimmed = [](std::string_view text) {
                const size_t first = text.find_first_not_of(" \t\r\n");
                if (first == std::string_view::npos) return std::string_view();
                return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
            };
            if (trimmed(one.substr(0, colon)) != name) continue;
            const std::string_view value = trimmed(one.substr(colon + 1));
            return lower_case(std::string(value.substr(0, value.find_first_of(" \t!"))));
        }
    }
    const std::string* attribute = tag.find(name);
    return attribute ? lower_case(*attribute) : std::string();
}

// A length in pixels of which 96 are an inch (CSS 2.1, 4.3.2); nothing for a share of what is around, or
// none.
std::optional<double> length_of(const std::string& text) {
    constexpr std::array<std::pair<std::string_view, double>, 9> kUnits = {{{"", 1.0},
                                                                            {"px", 1.0},
                                                                            {"pt", 96.0 / 72.0},
                                                                            {"pc", 16.0},
                                                                            {"mm", 96.0 / 25.4},
                                                                            {"cm", 96.0 / 2.54},
                                                                            {"in", 96.0},
                                                                            {"em", 16.0},
                                                                            {"ex", 8.0}}};
    std::string_view rest = text;
    const std::optional<double> number = take_svg_number(rest);
    if (!number) return {};
    rest = rest.substr(0, rest.find_last_not_of(" \t\r\n") + 1);
    for (const auto& [unit, pixels] : kUnits)
        if (lower_case(std::string(rest)) == unit) return *number * pixels;
    return {};
}

// What an element hands on to those in it.
struct Group {
    std::string_view name;
    Affine to_canvas;
    StrokeRole role = StrokeRole::kAuto;
    bool hidden = false;  // visibility: an element in it may show again
    bool gone = false;    // display: none in it does
};

class SvgReader {
  public:
    // tolerance: in what the drawing's own coordinates measure.
    SvgReader(std::string_view text, const std::string& who, std::optional<double> tolerance)
        : text_(text), who_(who), tolerance_(tolerance) {}

    Sketch read() {
        XmlScan scan(text_, who_);
        std::vector<Group> groups;
        bool ended = false;
        while (const std::optional<XmlTag> tag = scan.next()) {
            if (tag->kind == XmlTag::Kind::kClose) {
                close(groups, tag->name);
                ended = groups.empty();
                if (ended) break;
                continue;
            }
            if (groups.empty() && tag->local_name() != "svg")
                fail("is no SVG drawing: it begins with <" + plain(tag->name) + ">, and not with <svg>");
            if (groups.size() == kDeepest) fail("has groups in groups, more than 1000 deep");
            Group group = enter(*tag, groups);
            if (!group.gone && !group.hidden) add_shape(*tag, group);
            if (tag->kind == XmlTag::Kind::kOpen) groups.push_back(std::move(group));
            ended = groups.empty();
            if (ended) break;
        }
        if (!ended && groups.empty()) fail("is no SVG drawing: it has no <svg>");
        if (!ended) fail("ends too early: its <" + plain(groups.back().name) + "> does not end");
        if (sketch_.strokes.empty())
            fail("shows no lines: no path, line, polyline, polygon, circle or ellipse");
        return std::move(sketch_);
    }

    bool has_canvas() const { return has_canvas_; }

  private:
    [[noreturn]] void fail(const std::string& what) const { throw Error(who_ + " " + what + "."); }

    static std::string plain(std::string_view name) {
        const std::string quoted = quote_word(name);
        return quoted.substr(1, quoted.size() - 2);
    }

    // An end that fits no beginning is as if it were not there.
    static void close(std::vector<Group>& groups, std::string_view name) {
        for (size_t i = groups.size(); i > 0; i--)
            if (groups[i - 1].name == name) {
                groups.resize(i - 1);
                return;
            }
    }

    Group enter(const XmlTag& tag, const std::vector<Group>& groups) {
        Group group = groups.empty() ? Group() : groups.back();
        group.name = tag.name;
        const std::string_view kind = tag.local_name();
        if (groups.empty()) {
            take_canvas(tag);
            group.to_canvas = {1.0, 0.0, 0.0, 1.0, -corner_.x, -corner_.y};
        } else if (kind == "svg") {
            const auto at = [&](const char* name) {
                const std::string* value = tag.find(name);
                return value ? length_of(*value).value_or(0.0) : 0.0;
            };
            group.to_canvas = group.to_canvas * Affine{1.0, 0.0, 0.0, 1.0, at("x"), at("y")};
        }
        // What is only shown where something else asks for it.
        for (const char* name :
             {"defs", "symbol", "clipPath", "mask", "marker", "pattern", "glyph", "metadata"})
            group.gone = group.gone || kind == name;
        group.gone = group.gone || property(tag, "display") == "none";
        const std::string visibility = property(tag, "visibility");
        if (!visibility.empty() && visibility != "inherit") group.hidden = visibility != "visible";
        if (const std::string* transform = tag.find("transform")) {
            const std::optional<Affine> own = parse_svg_transform(*transform);
            if (!own) fail("has a transform that cannot be read: " + quote_word(*transform));
            group.to_canvas = group.to_canvas * *own;
        }
        for (const char* name : {"inkscape:label", "id", "class"})
            if (const std::string* told = tag.find(name))
                if (const std::optional<StrokeRole> role = role_told_by(*told)) {
                    group.role = *role;
                    break;
                }
        return group;
    }

    void take_canvas(const XmlTag& tag) {
        DVec2 size(0.0);
        if (const std::string* box = tag.find("viewBox")) {
            const std::optional<std::vector<double>> numbers = parse_svg_numbers(*box);
            if (!numbers || numbers->size() != 4)
                fail("has a viewBox that is not four numbers: " + quote_word(*box));
            corner_ = {(*numbers)[0], (*numbers)[1]};
            size = {(*numbers)[2], (*numbers)[3]};
        } else if (tag.find("width") && tag.find("height")) {
            size = {length_of(*tag.find("width")).value_or(0.0),
                    length_of(*tag.find("height")).value_or(0.0)};
        }
        // A size of nothing shows nothing, but means that nobody told one.
        has_canvas_ = size.x > 0.0 && size.y > 0.0;
        if (!has_canvas_) return;
        sketch_.canvas = size;
        if (!tolerance_) tolerance_ = kTolerance * size.y / kCanvasHeight;
    }

    double number(const XmlTag& tag, const char* name) const {
        const std::string* text = tag.find(name);
        if (!text) return 0.0;
        const std::optional<double> length = length_of(*text);
        if (!length)
            fail("has an element <" + plain(tag.name) + "> whose " + name +
                 " is no length: " + quote_word(*text));
        return *length;
    }

    void add_shape(const XmlTag& tag, const Group& group) {
        const std::string_view kind = tag.local_name();
        // Without a canvas the first reading only finds how large the drawing is.
        SvgLines lines(group.to_canvas, tolerance_.value_or(1e9), kMostStrokePoints + 1 - points_);
        if (kind == "path") {
            const std::string* data = tag.find("d");
            if (!data) return;
            const size_t read = lines.add_path(*data);
            if (read < data->size())
                fail("has a path that cannot be read from its character " + std::to_string(read + 1) +
                     " on: " + quote_word(std::string_view(*data).substr(read)));
        } else if (kind == "polyline" || kind == "polygon") {
            const std::string* text = tag.find("points");
            if (!text) return;
            const std::optional<std::vector<double>> numbers = parse_svg_numbers(*text);
            if (!numbers || numbers->size() % 2 != 0)
                fail("has a <" + plain(kind) +
                     "> whose points are not pairs of numbers: " + quote_word(*text));
            std::vector<DVec2> points;
            for (size_t i = 0; i < numbers->size(); i += 2)
                points.emplace_back((*numbers)[i], (*numbers)[i + 1]);
            lines.add_polyline(points, kind == "polygon");
        } else if (kind == "line") {
            lines.add_polyline(
                {{number(tag, "x1"), number(tag, "y1")}, {number(tag, "x2"), number(tag, "y2")}}, false);
        } else if (kind == "circle" || kind == "ellipse") {
            const DVec2 radii =
                kind == "circle" ? DVec2(number(tag, "r")) : DVec2(number(tag, "rx"), number(tag, "ry"));
            if (radii.x > 0.0 && radii.y > 0.0)
                lines.add_ellipse({number(tag, "cx"), number(tag, "cy")}, radii);
        }
        keep(lines, group.role);
    }

    void keep(SvgLines& lines, StrokeRole role) {
        for (std::vector<DVec2>& line : lines.take()) {
            // A dot is no line.
            if (std::all_of(line.begin(), line.end(), [&](const DVec2& p) { return p == line.front(); }))
                continue;
            points_ += line.size();
            Stroke stroke;
            stroke.points = std::move(line);
            stroke.role = role;
            sketch_.strokes.push_back(std::move(stroke));
        }
        if (sketch_.strokes.size() > kMostStrokes)
            fail("has more than " + std::to_string(kMostStrokes) +
                 " lines; a tree is drawn with a few strokes");
        if (points_ > kMostStrokePoints || lines.full())
            fail("has lines of more than " + std::to_string(kMostStrokePoints) +
                 " points; a tree is drawn with a few strokes");
    }

    std::string_view text_;
    const std::string& who_;
    std::optional<double> tolerance_;
    Sketch sketch_;
    DVec2 corner_{0.0};
    bool has_canvas_ = false;
    size_t points_ = 0;
};

// Makes a canvas around what is drawn.
void fit_canvas(Sketch& sketch) {
    DVec2 low(INFINITY), high(-INFINITY);
    for (const Stroke& stroke : sketch.strokes)
        for (const DVec2& p : stroke.points) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    const double margin = kMargin * std::max(high.x - low.x, high.y - low.y);
    for (Stroke& stroke : sketch.strokes)
        for (DVec2& p : stroke.points)
            p += DVec2(margin) - low;
    sketch.canvas = high - low + DVec2(2.0 * margin);
}

}  // namespace

Sketch parse_sketch_svg(std::string_view text, const std::string& who) {
    if (text.size() > kLargest)
        throw Error(who + " is larger than 64 MiB; a tree is drawn with a few strokes.");
    SvgReader reader(text, who, {});
    Sketch sketch = reader.read();
    if (!reader.has_canvas()) {
        fit_canvas(sketch);
        sketch = SvgReader(text, who, kTolerance * sketch.canvas.y / kCanvasHeight).read();
        fit_canvas(sketch);
    }
    const std::string fault = sketch_fault(sketch);
    if (!fault.empty()) throw Error(who + fault);
    sketch.number_strokes();
    return sketch;
}

}  // namespace treerec
