#include "sketch/flat_line.h"

#include <algorithm>
#include <cmath>

namespace treerec {

namespace {

FlatBox box_of(const FlatLine& line, size_t begin, size_t end) {
    FlatBox box{line[begin], line[begin]};
    for (size_t i = begin; i < end; i++) {
        box.low = glm::min(box.low, line[i]);
        box.high = glm::max(box.high, line[i]);
    }
    return box;
}

}  // namespace

double line_length(const FlatLine& line) {
    double length = 0.0;
    for (size_t i = 1; i < line.size(); i++)
        length += glm::length(line[i] - line[i - 1]);
    return length;
}

std::vector<double> line_arcs(const FlatLine& line) {
    std::vector<double> arcs(line.size(), 0.0);
    for (size_t i = 1; i < line.size(); i++)
        arcs[i] = arcs[i - 1] + glm::length(line[i] - line[i - 1]);
    return arcs;
}

FlatBox line_box(const FlatLine& line) {
    return line.empty() ? FlatBox() : box_of(line, 0, line.size());
}

DVec2 line_centroid(const FlatLine& points, size_t begin, size_t end) {
    DVec2 sum(0.0);
    for (size_t i = begin; i < end; i++)
        sum += points[i];
    return sum / static_cast<double>(end - begin);
}

DVec2 point_at(const FlatLine& line, const std::vector<double>& arcs, double arc) {
    const auto after = std::upper_bound(arcs.begin(), arcs.end(), arc);
    if (after == arcs.begin()) return line.front();
    if (after == arcs.end()) return line.back();
    const size_t i = static_cast<size_t>(after - arcs.begin());
    const double along = (arc - arcs[i - 1]) / (arcs[i] - arcs[i - 1]);
    return line[i - 1] + along * (line[i] - line[i - 1]);
}

LinePlace nearest_on_line(const FlatLine& line, const DVec2& p) {
    LinePlace best{0, 0.0, line[0], 0.0};
    DVec2 off = p - line[0];
    double least = glm::dot(off, off);
    for (size_t i = 0; i + 1 < line.size(); i++) {
        const DVec2 way = line[i + 1] - line[i];
        const double square = glm::dot(way, way);
        const double t = square > 0.0 ? std::clamp(glm::dot(p - line[i], way) / square, 0.0, 1.0) : 0.0;
        const DVec2 point = line[i] + t * way;
        off = p - point;
        const double d = glm::dot(off, off);
        if (d < least) {
            least = d;
            best = {i, t, point, 0.0};
        }
    }
    best.distance = std::sqrt(least);
    return best;
}

double arc_of(const LinePlace& place, const std::vector<double>& arcs) {
    if (place.segment + 1 >= arcs.size()) return arcs.back();
    return arcs[place.segment] + place.along * (arcs[place.segment + 1] - arcs[place.segment]);
}

std::optional<DVec2> segments_cross(const DVec2& a, const DVec2& b, const DVec2& c, const DVec2& d) {
    if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x) ||
        std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y))
        return std::nullopt;
    const DVec2 u = b - a, v = d - c;
    const double across = cross(u, v);
    if (std::abs(across) <= 1e-12 * glm::length(u) * glm::length(v)) return std::nullopt;
    const double s = cross(c - a, v) / across, t = cross(c - a, u) / across;
    if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) return std::nullopt;
    return DVec2(s, t);
}

std::vector<LinePlace> crossings(const FlatLine& line, const FlatLine& other) {
    // Boxes of so many sides at once: lines seldom come near each other.
    constexpr size_t kBlock = 16;
    std::vector<FlatBox> blocks;
    for (size_t k = 0; k + 1 < other.size(); k += kBlock)
        blocks.push_back(box_of(other, k, std::min(k + kBlock + 1, other.size())));
    std::vector<LinePlace> found;
    for (size_t i = 0; i + 1 < line.size(); i++) {
        const DVec2 low = glm::min(line[i], line[i + 1]), high = glm::max(line[i], line[i + 1]);
        const size_t before = found.size();
        for (size_t b = 0; b < blocks.size(); b++) {
            if (low.x > blocks[b].high.x || high.x < blocks[b].low.x || low.y > blocks[b].high.y ||
                high.y < blocks[b].low.y)
                continue;
            for (size_t k = b * kBlock; k < (b + 1) * kBlock && k + 1 < other.size(); k++)
                if (const auto at = segments_cross(line[i], line[i + 1], other[k], other[k + 1]))
                    found.push_back({i, at->x, line[i] + at->x * (line[i + 1] - line[i]), 0.0});
        }
        std::sort(found.begin() + static_cast<ptrdiff_t>(before), found.end(),
                  [](const LinePlace& a, const LinePlace& b) { return a.along < b.along; });
    }
    return found;
}

std::optional<LinePlace> first_hit(const DVec2& a, const DVec2& b, const FlatLine& other) {
    std::optional<LinePlace> best;
    const double length = glm::length(b - a);
    for (size_t k = 0; k + 1 < other.size(); k++) {
        const auto at = segments_cross(a, b, other[k], other[k + 1]);
        if (!at || (best && at->x * length >= best->distance)) continue;
        best = LinePlace{k, at->y, other[k] + at->y * (other[k + 1] - other[k]), at->x * length};
    }
    return best;
}

double polygon_area(const FlatLine& polygon) {
    double twice = 0.0;
    for (size_t i = 0; i < polygon.size(); i++)
        twice += cross(polygon[i] - polygon[0], polygon[i + 1 == polygon.size() ? 0 : i + 1] - polygon[0]);
    return 0.5 * twice;
}

bool is_inside(const FlatLine& polygon, const DVec2& p) {
    int winding = 0;
    for (size_t i = 0; i < polygon.size(); i++) {
        const DVec2 a = polygon[i], b = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        if ((a.y <= p.y) == (b.y <= p.y)) continue;
        const double side = cross(b - a, p - a);
        if (a.y <= p.y && side > 0.0) winding++;
        if (a.y > p.y && side < 0.0) winding--;
    }
    return winding != 0;
}

FlatLine flat_hull(FlatLine points) {
    std::sort(points.begin(), points.end(),
              [](const DVec2& a, const DVec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return points;
    FlatLine hull;
    const auto add = [&](const DVec2& p, size_t least) {
        while (hull.size() >= least &&
               cross(hull.back() - hull[hull.size() - 2], p - hull[hull.size() - 2]) <= 0.0)
            hull.pop_back();
        hull.push_back(p);
    };
    for (const DVec2& p : points)
        add(p, 2);
    const size_t least = hull.size() + 1;
    for (size_t i = points.size() - 1; i-- > 0;)
        add(points[i], least);
    hull.pop_back();
    return hull;
}

}  // namespace treerec
