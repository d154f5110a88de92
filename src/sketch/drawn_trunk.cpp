#include "sketch/drawn_trunk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sketch/clean.h"

namespace treerec {

namespace {

struct Row {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    bool empty() const { return low > high; }
};

// Where a line crosses a height.
Row row_at(const FlatLine& line, double y, bool closed) {
    Row row;
    const size_t sides = closed ? line.size() : line.size() - 1;
    for (size_t i = 0; i < sides; i++) {
        const DVec2 a = line[i], b = line[i + 1 == line.size() ? 0 : i + 1];
        if ((a.y <= y) == (b.y <= y)) continue;
        const double x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
        row.low = std::min(row.low, x);
        row.high = std::max(row.high, x);
    }
    return row;
}

// Rows from bottom to top as a line with radii; those across a leaning trunk are wider than it is thick.
DrawnLine middle_of_rows(const std::vector<Row>& rows, double bottom, double step) {
    DrawnLine middle;
    for (size_t i = 0; i < rows.size(); i++) {
        if (rows[i].empty()) continue;
        middle.points.emplace_back(0.5 * (rows[i].low + rows[i].high),
                                   bottom + step * static_cast<double>(i));
        middle.radii.push_back(0.5 * (rows[i].high - rows[i].low));
    }
    const FlatLine& p = middle.points;
    const size_t n = p.size();
    std::vector<double> radii = middle.radii;
    for (size_t i = 0; i < n; i++) {
        const DVec2 way = unit_or(p[std::min(i + 2, n - 1)] - p[i < 2 ? 0 : i - 2], DVec2(0.0, 1.0));
        radii[i] = std::max(0.5, middle.radii[i] * std::abs(way.y));
    }
    middle.radii = radii;
    return middle;
}

// A slanting base or top cuts off corners: rows there are as wide as the first whole one.
void widen_ends(std::vector<Row>& rows) {
    std::vector<double> widths;
    for (const Row& row : rows)
        if (!row.empty()) widths.push_back(row.high - row.low);
    if (widths.size() < 5) return;
    std::nth_element(widths.begin(), widths.begin() + static_cast<ptrdiff_t>(widths.size() / 2),
                     widths.end());
    const double usual = widths[widths.size() / 2];
    const size_t most = rows.size() / 4;
    for (const bool top : {false, true}) {
        const auto at = [&](size_t i) -> Row& { return rows[top ? rows.size() - 1 - i : i]; };
        size_t whole = 0;
        while (whole < most && (at(whole).empty() || at(whole).high - at(whole).low < 0.7 * usual))
            whole++;
        for (size_t i = 0; i < whole && whole < most; i++)
            at(i) = at(whole);
    }
}

constexpr double kRowStep = 4.0;  // pixels
constexpr int kMostRows = 500;

}  // namespace

FlatLine upward(const FlatLine& line, bool* reversed) {
    *reversed = line.back().y < line.front().y;
    FlatLine up = line;
    if (*reversed) std::reverse(up.begin(), up.end());
    return up;
}

DrawnLine middle_of_sides(const FlatLine& left, const FlatLine& right) {
    const FlatBox a = line_box(left), b = line_box(right);
    const double bottom = std::max(a.low.y, b.low.y), top = std::min(a.high.y, b.high.y);
    const int count = std::clamp(static_cast<int>((top - bottom) / kRowStep), 2, kMostRows);
    const double step = (top - bottom) / count;
    std::vector<Row> rows;
    for (int i = 0; i <= count; i++) {
        // Not through the end points themselves, where it may be one line alone.
        const double y = bottom + std::clamp(static_cast<double>(i), 0.05, count - 0.05) * step;
        const Row one = row_at(left, y, false), other = row_at(right, y, false);
        Row row;
        if (!one.empty() && !other.empty()) {
            const double x = 0.5 * (one.low + one.high), z = 0.5 * (other.low + other.high);
            row = {std::min(x, z), std::max(x, z)};
        }
        rows.push_back(row);
    }
    DrawnLine middle = middle_of_rows(rows, bottom, step);
    // The longer side goes on alone, and the trunk with it.
    const FlatLine& longer = a.high.y > b.high.y ? left : right;
    if (middle.points.empty()) return middle;
    const DVec2 last = middle.points.back();
    const double radius = middle.radii.back();
    const double top_of_all = std::max(a.high.y, b.high.y);
    const Row from = row_at(longer, last.y, false);
    if (!from.empty() && top_of_all > last.y + std::max(2.0 * kRowStep, 0.1 * (top - bottom))) {
        const double off = last.x - 0.5 * (from.low + from.high);
        const int more = std::clamp(static_cast<int>((top_of_all - last.y) / kRowStep), 1, kMostRows);
        for (int i = 1; i <= more; i++) {
            const double share = static_cast<double>(i) / more;
            const Row row = row_at(longer, last.y + std::min(share, 0.999) * (top_of_all - last.y), false);
            if (row.empty()) continue;
            middle.points.emplace_back(0.5 * (row.low + row.high) + off * (1.0 - 0.8 * share),
                                       last.y + share * (top_of_all - last.y));
            middle.radii.push_back(std::max(0.5, radius * (1.0 - 0.8 * share)));
        }
    }
    return middle;
}

DrawnLine middle_of_outline(const FlatLine& around) {
    const FlatBox box = line_box(around);
    const int count = std::clamp(static_cast<int>(box.size().y / kRowStep), 2, kMostRows);
    const double step = box.size().y / count;
    std::vector<Row> rows;
    for (int i = 0; i <= count; i++)
        rows.push_back(
            row_at(around, box.low.y + std::clamp(static_cast<double>(i), 0.5, count - 0.5) * step, true));
    widen_ends(rows);
    return middle_of_rows(rows, box.low.y, step);
}

FlatLine make_trunk(const FlatLine& outline, double x, double lowest) {
    const FlatBox box = line_box(outline);
    const double height = box.size().y;
    // The canvas ends at 0. A crown that comes down to it stands on its trunk's base.
    double stem_base = std::min(lowest, std::max(0.0, box.low.y - 0.25 * height));
    stem_base = std::min(stem_base, box.low.y);
    return fill_line({DVec2(x, stem_base), DVec2(x, box.low.y + 0.8 * height)},
                     std::max(kMostSpacing, height / kMostRows), kMostSpacing, nullptr);
}

std::optional<Lollipop> split_lollipop(const FlatLine& line, const FlatLine& polygon) {
    constexpr int kRows = 100;
    // Up the trunk and around the crown, back to the trunk.
    const std::vector<double> arcs = line_arcs(line);
    const double length = arcs.back();
    for (const bool backwards : {false, true}) {
        FlatLine way = line;
        if (backwards) std::reverse(way.begin(), way.end());
        const std::vector<double> along = line_arcs(way);
        size_t half = 1;
        while (half + 1 < way.size() && along[half] < 0.5 * length)
            half++;
        const FlatLine beginning(way.begin(), way.begin() + static_cast<ptrdiff_t>(half) + 1);
        const LinePlace meets = nearest_on_line(beginning, way.back());
        const double stem = arc_of(meets, along);
        if (meets.distance > 0.06 * length || stem < 0.08 * length) continue;
        const DVec2 up = meets.point - way[0];
        if (glm::length(up) < 0.8 * stem || up.y < 0.5 * glm::length(up)) continue;
        Lollipop split;
        split.trunk.points.assign(way.begin(), way.begin() + static_cast<ptrdiff_t>(meets.segment) + 1);
        if (split.trunk.points.back() != meets.point) split.trunk.points.push_back(meets.point);
        split.crown.push_back(meets.point);
        split.crown.insert(split.crown.end(), way.begin() + static_cast<ptrdiff_t>(meets.segment) + 1,
                           way.end());
        const FlatBox crown = line_box(split.crown);
        if (crown.low.y < way[0].y + 0.5 * up.y || split.trunk.points.size() < 2) continue;
        return split;
    }
    // Around both: a narrow part below that does not widen, and then suddenly does.
    if (polygon.size() < 3) return std::nullopt;
    const FlatBox box = line_box(polygon);
    const double step = box.size().y / kRows;
    std::vector<double> widths;
    double widest = 0.0;
    for (int i = 0; i < kRows; i++) {
        const Row row = row_at(polygon, box.low.y + (i + 0.5) * step, true);
        widths.push_back(row.empty() ? 0.0 : row.high - row.low);
        widest = std::max(widest, widths.back());
    }
    size_t neck = 0;
    while (neck < kRows && widths[neck] < 0.4 * widest)
        neck++;
    // The last rows below the crown may widen already.
    if (neck < kRows / 10 || neck + 8 > kRows) return std::nullopt;
    const auto mean = [&](size_t from, size_t to) {
        double sum = 0.0;
        for (size_t i = from; i < to; i++)
            sum += widths[i];
        return sum / static_cast<double>(to - from);
    };
    const double lower = mean(neck / 10, neck / 2),
                 upper = mean(neck / 2, std::max(neck / 2 + 1, neck * 9 / 10));
    const double beyond = widths[std::min<size_t>(neck + 8, kRows - 1)];
    if (upper > 1.7 * lower || lower > 3.0 * upper || beyond < 1.6 * upper || upper < 1.0)
        return std::nullopt;
    const double height = box.low.y + static_cast<double>(neck) * step;
    Lollipop split;
    FlatLine stem;
    // Both parts of the polygon by the neck (Sutherland and Hodgman 1974).
    for (size_t i = 0; i < polygon.size(); i++) {
        const DVec2 a = polygon[i], b = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        (a.y >= height ? split.crown : stem).push_back(a);
        if ((a.y >= height) == (b.y >= height)) continue;
        const DVec2 at(a.x + (height - a.y) / (b.y - a.y) * (b.x - a.x), height);
        split.crown.push_back(at);
        stem.push_back(at);
    }
    if (stem.size() < 3 || split.crown.size() < 3) return std::nullopt;
    split.trunk = middle_of_outline(stem);
    if (split.trunk.points.size() < 2) return std::nullopt;
    return split;
}

// Of half the crown's width there: twigs of a crown that its trunk fills would be shorter than it is thick.
constexpr double kThickestInCrown = 0.08;

bool reach_into_crown(DrawnLine& trunk, const FlatLine& outline) {
    const FlatBox box = line_box(outline);
    const DVec2 top = trunk.points.back();
    if (top.y > box.low.y + 0.15 * box.size().y) return false;
    if (top.x < box.low.x || top.x > box.high.x) return false;
    const DVec2 target(0.5 * top.x + 0.5 * line_centroid(outline, 0, outline.size()).x,
                       box.low.y + 0.75 * box.size().y);
    const FlatLine on =
        fill_line({top, target}, std::max(kMostSpacing, box.size().y / kMostRows), kMostSpacing, nullptr);
    const double radius = trunk.radii.empty() ? 0.0 : trunk.radii.back();
    for (size_t i = 1; i < on.size(); i++) {
        trunk.points.push_back(on[i]);
        if (radius == 0.0) continue;
        const double tapered =
            radius * (1.0 - 0.8 * static_cast<double>(i) / static_cast<double>(on.size() - 1));
        const Row crown = row_at(outline, on[i].y, true);
        const double most = crown.empty() ? tapered : kThickestInCrown * 0.5 * (crown.high - crown.low);
        trunk.radii.push_back(std::max(0.5, std::min(tapered, most)));
    }
    return on.size() > 1;
}

}  // namespace treerec
