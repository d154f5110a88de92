#include "pipeline/sketch_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sketch/crown_sections.h"
#include "tree/measure.h"
#include "version.h"

namespace treerec {

namespace {

using Json = nlohmann::ordered_json;

// So far away, in crown heights, that a pinhole sees what a view without perspective does, to a fiftieth of a
// pixel.
constexpr double kFarAway = 2e4;

// Seen along the unit vector `back` from its tip, a picture of `height` metres above `bottom`.
PinholeView far_view(const DVec3& right, const DVec3& back, double middle, double bottom, double height,
                     int rows, double width) {
    PinholeView view;
    view.turn = DMat3(right, DVec3(0.0, 1.0, 0.0), back);
    const double away = kFarAway * height;
    view.centre = right * middle + DVec3(0.0, bottom + 0.5 * height, 0.0) + back * away;
    view.focal = rows / height * away;
    view.height = rows;
    view.width = std::max(1, static_cast<int>(std::lround(rows * width / height)));
    view.principal = DVec2(0.5 * view.width, 0.5 * rows);
    return view;
}

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

Json place(const DVec2& p) {
    return Json::array({number(p.x), number(p.y)});
}

}  // namespace

CrownOverlap measure_crown_overlap(const SketchedTree& sketched, const Sketch& sketch,
                                   std::span<const OutlinePart> parts, int rows, const Progress* progress) {
    // The outline in metres, and its box.
    const double shown = sketch.canvas.y / kCanvasHeight;
    const double pixel = sketched.scale * shown;
    const DVec2 stem_base(sketched.stem_base.x / shown, kCanvasHeight - sketched.stem_base.y / shown);
    std::vector<DVec2> outline;
    DVec2 low(1e300), high(-1e300);
    for (const DVec2& p : sketched.understood.drawn.outline) {
        outline.push_back((p - stem_base) * pixel);
        low = glm::min(low, outline.back());
        high = glm::max(high, outline.back());
    }
    // What sticks out must be in the picture, too; below the crown's base only the trunk is.
    const double height = high.y - low.y;
    const double above = 0.25 * height, beside = std::max(0.5 * (high.x - low.x), above);
    const double width = high.x - low.x + 2.0 * beside;
    const int all_rows = static_cast<int>(std::lround(rows * (1.0 + above / height)));
    const double all_height = height * all_rows / rows;
    const PinholeView front = far_view(DVec3(1.0, 0.0, 0.0), DVec3(0.0, 0.0, 1.0), 0.5 * (low.x + high.x),
                                       low.y, all_height, all_rows, width);
    const SampleMask seen = drawn_outline(parts, front, progress);
    SampleMask drawn(front.width, front.height);
    const double samples = SampleMask::kSamples * all_rows / all_height;
    const auto at = [&](double x, double y) {
        return DVec2((x - (0.5 * (low.x + high.x) - 0.5 * front.width * all_height / all_rows)) * samples,
                     (low.y + all_height - y) * samples);
    };
    const CrownSections crown(outline, false);
    const double strip = height / (4.0 * rows);
    for (double y = low.y; y < high.y; y += strip)
        for (const CrownSections::Section& section : crown.at(y + 0.5 * strip)) {
            const DVec2 a = at(section.left, y), b = at(section.right, y), c = at(section.right, y + strip),
                        d = at(section.left, y + strip);
            drawn.fill({a, b, c});
            drawn.fill({a, c, d});
        }
    CrownOverlap result;
    double both = 0.0, either = 0.0, tree = 0.0, mask = 0.0;
    int leftmost = front.width, rightmost = -1;
    for (int y = 0; y < front.height; y++)
        for (int x = 0; x < front.width; x++) {
            const double s = seen.covered(x, y), d = drawn.covered(x, y);
            both += std::min(s, d);
            either += std::max(s, d);
            tree += s;
            mask += d;
            if (s > 0.0) {
                leftmost = std::min(leftmost, x);
                rightmost = std::max(rightmost, x);
            }
        }
    if (mask > 0.0) result.overlap.recall = both / mask;
    if (tree > 0.0) result.overlap.precision = both / tree;
    if (either > 0.0) result.overlap.iou = both / either;
    if (tree > 0.0) result.outside = 1.0 - both / tree;
    const double metres = all_height / all_rows;
    if (rightmost >= leftmost) result.front_width = (rightmost - leftmost + 1) * metres;
    // From the side: as wide as the tree may be in depth.
    const double depth = 2.0 * crown.reach() + 2.0 * beside;
    const PinholeView side =
        far_view(DVec3(0.0, 0.0, -1.0), DVec3(1.0, 0.0, 0.0), 0.0, low.y, all_height, all_rows, depth);
    const SampleMask sideways = drawn_outline(parts, side, progress);
    leftmost = side.width;
    rightmost = -1;
    for (int y = 0; y < side.height; y++)
        for (int x = 0; x < side.width; x++)
            if (sideways.covered(x, y) > 0) {
                leftmost = std::min(leftmost, x);
                rightmost = std::max(rightmost, x);
            }
    if (rightmost >= leftmost) result.side_width = (rightmost - leftmost + 1) * metres;
    return result;
}

std::string sketch_report_json(const Sketch& sketch, const SketchedTree& sketched,
                               const CrownOverlap* overlap) {
    const Measurements m = measure(sketched.tree);
    Json report;
    report["format_version"] = 1;
    report["version"] = kVersion;
    report["species"] = sketched.species;
    report["seed"] = sketch.seed;
    report["metres_per_pixel"] = number(sketched.scale);
    report["base"] = place(sketched.stem_base);
    report["foot"] = report["base"];  // the old word
    Json strokes = Json::array();
    for (size_t i = 0; i < sketched.understood.strokes.size(); i++) {
        const StrokeReading& reading = sketched.understood.strokes[i];
        Json stroke;
        stroke["stroke"] = i + 1;
        stroke["role"] = stroke_role_name(reading.role);
        Json repairs = Json::array();
        for (const StrokeRepair repair : reading.repairs)
            repairs.push_back(stroke_repair_name(repair));
        stroke["repairs"] = repairs;
        stroke["attach"] = reading.attach ? place(*reading.attach) : Json();
        stroke["fault"] = reading.fault;
        stroke["left_out"] = reading.left_out;
        strokes.push_back(stroke);
    }
    report["strokes"] = strokes;
    report["remarks"] = sketched.remarks;
    report["nodes"] = m.nodes;
    report["tips"] = m.tips;
    report["height_m"] = number(m.height);
    report["crown_radius_m"] = number(m.crown_radius);
    report["crown_base_m"] = number(sketched.crown_base);
    report["length_m"] = number(m.total_length);
    if (overlap) {
        Json crown;
        crown["iou"] = number(overlap->overlap.iou);
        crown["recall"] = number(overlap->overlap.recall);
        crown["precision"] = number(overlap->overlap.precision);
        crown["outside"] = number(overlap->outside);
        crown["side_width_m"] = number(overlap->side_width);
        crown["front_width_m"] = number(overlap->front_width);
        report["crown"] = crown;
    }
    return report.dump(2) + "\n";
}

}  // namespace treerec
