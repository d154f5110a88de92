#include "sketch/strokes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "error.h"
#include "sketch/sketch_fault.h"

namespace treerec {

namespace {

constexpr std::array kRoles = {"auto", "outline", "trunk", "branch"};
constexpr std::array kRepairs = {"reversed", "closed", "united", "gap", "crossing", "hook", "two_sides"};

constexpr double kSmallestCanvas = 1e-3, kLargestCanvas = 1e6;  // pixels
constexpr double kMostOblong = 100.0;                           // of the longer side to the shorter one
constexpr double kFarthest = 100.0;                             // canvases that a point may be away
constexpr double kHighest = 200.0;                              // metres

// The comparisons are false of what is no number.
bool is_side(double pixels) {
    return pixels >= kSmallestCanvas && pixels <= kLargestCanvas;
}

std::string stroke_fault(const Stroke& stroke, double farthest) {
    if (stroke.points.empty()) return "has no points";
    for (const DVec2& p : stroke.points) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y)) return "has a point whose place is no number";
        if (std::abs(p.x) > farthest || std::abs(p.y) > farthest)
            return "has a point that lies more than 100 canvases away from the canvas";
    }
    if (stroke.pressure.empty()) return {};
    if (stroke.pressure.size() != stroke.points.size())
        return "has " + std::to_string(stroke.pressure.size()) + " pressures for " +
               std::to_string(stroke.points.size()) + " points; it needs one for each, or none";
    for (const float p : stroke.pressure)
        if (!(p >= 0.0F && p <= 1.0F)) return "has a pressure that is not from 0 to 1";
    return {};
}

}  // namespace

const char* stroke_role_name(StrokeRole role) {
    return kRoles.at(static_cast<size_t>(role));
}

StrokeRole parse_stroke_role(const std::string& name) {
    const auto* const found = std::find(kRoles.begin(), kRoles.end(), name);
    if (found == kRoles.end())
        throw Error("A stroke's role is auto, outline, trunk or branch, and not " + quote_word(name) + ".");
    return static_cast<StrokeRole>(found - kRoles.begin());
}

const char* stroke_repair_name(StrokeRepair repair) {
    return kRepairs.at(static_cast<size_t>(repair));
}

void Sketch::number_strokes() {
    std::set<uint32_t> taken;
    for (const Stroke& stroke : strokes)
        taken.insert(stroke.id);
    // Above all others, so that the id of a stroke that was erased does not come back while there are any.
    uint32_t last = taken.empty() ? 0 : *taken.rbegin();
    const auto next = [&] {
        if (last == std::numeric_limits<uint32_t>::max()) last = 0;
        while (!taken.insert(++last).second) {
        }
        return last;
    };
    std::set<uint32_t> seen;
    for (Stroke& stroke : strokes) {
        if (stroke.id == 0 || !seen.insert(stroke.id).second) stroke.id = next();
        seen.insert(stroke.id);
    }
}

std::string sketch_fault(const Sketch& sketch) {
    const DVec2 canvas = sketch.canvas;
    if (!is_side(canvas.x) || !is_side(canvas.y))
        return " has a canvas whose sides are not from 0.001 to 1000000 pixels.";
    if (std::max(canvas.x, canvas.y) > kMostOblong * std::min(canvas.x, canvas.y))
        return " has a canvas that is more than 100 times as long one way as the other.";
    if (!(sketch.height >= 0.0 && sketch.height <= kHighest))
        return " has a tree whose height is not from 0 to 200 metres.";
    if (sketch.strokes.size() > kMostStrokes)
        return " has " + std::to_string(sketch.strokes.size()) + " strokes; at most " +
               std::to_string(kMostStrokes) + " make a tree.";
    size_t points = 0;
    for (const Stroke& stroke : sketch.strokes)
        points += stroke.points.size();
    if (points > kMostStrokePoints)
        return " has strokes of " + std::to_string(points) + " points; at most " +
               std::to_string(kMostStrokePoints) + " are read. Draw with fewer, or thin them.";
    const double farthest = kFarthest * std::max(canvas.x, canvas.y);
    for (size_t i = 0; i < sketch.strokes.size(); i++) {
        const std::string fault = stroke_fault(sketch.strokes[i], farthest);
        if (!fault.empty()) return " has a stroke, number " + std::to_string(i + 1) + ", that " + fault + ".";
    }
    return {};
}

void check_sketch(const Sketch& sketch) {
    const std::string fault = sketch_fault(sketch);
    if (!fault.empty()) throw Error("The sketch" + fault);
}

}  // namespace treerec
