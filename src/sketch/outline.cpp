#include "sketch/outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr double kLeastCell = 2.0;     // pixels
constexpr double kMostCells = 600.0;   // along a side of the raster
constexpr double kLeastArea = 100.0;   // square pixels
constexpr double kHatchedShare = 0.4;  // of the convex hull: less is no crown's shape

// A closed line's last point that is its first again, and points that follow their equals.
FlatLine without_repeats(FlatLine polygon) {
    polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
    while (polygon.size() > 1 && polygon.front() == polygon.back())
        polygon.pop_back();
    return polygon;
}

// The line between the places where its first and last fifth cross, if they cross once.
FlatLine cut_overlap(const FlatLine& line) {
    const std::vector<double> arcs = line_arcs(line);
    const double fifth = arcs.back() / 5.0;
    size_t head = 0, tail = line.size() - 1;
    while (head + 1 < line.size() && arcs[head + 1] < fifth)
        head++;
    while (tail > 0 && arcs[tail - 1] > arcs.back() - fifth)
        tail--;
    if (head == 0 || head >= tail || tail + 1 >= line.size()) return line;
    const FlatLine beginning(line.begin(), line.begin() + static_cast<ptrdiff_t>(head) + 1);
    const FlatLine end(line.begin() + static_cast<ptrdiff_t>(tail), line.end());
    const std::vector<LinePlace> at_beginning = crossings(beginning, end);
    if (at_beginning.size() != 1) return line;
    const std::vector<LinePlace> at_end = crossings(end, beginning);
    if (at_end.size() != 1) return line;
    FlatLine cut = {at_beginning[0].point};
    for (size_t i = at_beginning[0].segment + 1; i <= tail + at_end[0].segment; i++)
        cut.push_back(line[i]);
    return cut;
}

// Cells of a raster, with a border of empty ones all around.
struct Raster {
    int width = 0, height = 0;
    double cell = 1.0;
    DVec2 low{0.0};
    std::vector<uint8_t> filled;

    size_t at(int x, int y) const {
        return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
    }
};

// Fills the cells whose centres the polygon winds around.
void fill_polygon(Raster& raster, const FlatLine& polygon) {
    struct Crossing {
        int row, way;
        double x;
    };
    std::vector<Crossing> found;
    for (size_t i = 0; i < polygon.size(); i++) {
        DVec2 a = (polygon[i] - raster.low) / raster.cell;
        DVec2 b = (polygon[i + 1 == polygon.size() ? 0 : i + 1] - raster.low) / raster.cell;
        const int way = a.y < b.y ? 1 : -1;
        if (way < 0) std::swap(a, b);
        const int first = static_cast<int>(std::ceil(a.y - 0.5)),
                  end = static_cast<int>(std::ceil(b.y - 0.5));
        for (int y = std::max(first, 0); y < std::min(end, raster.height); y++)
            found.push_back({y, way, a.x + (y + 0.5 - a.y) / (b.y - a.y) * (b.x - a.x)});
    }
    std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) {
        return a.row < b.row || (a.row == b.row && a.x < b.x);
    });
    int winding = 0;
    for (size_t i = 0; i + 1 < found.size(); i++) {
        // A closed line crosses each row as often up as down.
        winding += found[i].way;
        if (winding == 0) continue;
        const int from = std::max(0, static_cast<int>(std::ceil(found[i].x - 0.5)));
        const int to = std::min(raster.width, static_cast<int>(std::ceil(found[i + 1].x - 0.5)));
        if (from < to)
            std::fill_n(raster.filled.begin() + static_cast<ptrdiff_t>(raster.at(from, found[i].row)),
                        to - from, uint8_t{1});
    }
}

// Keeps the largest part that hangs together by sides. Returns its first cell (the lowest, then leftmost).
size_t keep_largest(Raster& raster) {
    struct Run {
        size_t begin, end;  // cells
        size_t part;        // a run of the same part; itself: the first one
        size_t cells = 0;   // of the part, at its first run
    };
    std::vector<Run> runs;
    const auto first_of = [&](size_t run) {
        while (runs[run].part != run)
            run = runs[run].part = runs[runs[run].part].part;
        return run;
    };
    const size_t row = static_cast<size_t>(raster.width);
    size_t below = 0, above = 0;  // where the runs of the row below begin, and those of this one
    for (size_t start = 0; start < raster.filled.size(); start += row) {
        below = above;
        above = runs.size();
        size_t under = below;
        const uint8_t* const cells = raster.filled.data();
        for (size_t i = start; i < start + row;) {
            const void* const next = std::memchr(cells + i, 1, start + row - i);
            if (!next) break;
            const size_t begin = static_cast<size_t>(static_cast<const uint8_t*>(next) - cells);
            const void* const gap = std::memchr(cells + begin, 0, start + row - begin);
            i = gap ? static_cast<size_t>(static_cast<const uint8_t*>(gap) - cells) : start + row;
            const size_t mine = runs.size();
            runs.push_back({begin, i, mine, 0});
            while (under < above && runs[under].end + row <= begin)
                under++;
            for (size_t k = under; k < above && runs[k].begin + row < i; k++) {
                const size_t one = first_of(k), other = first_of(mine);
                runs[std::max(one, other)].part = std::min(one, other);
            }
        }
    }
    size_t largest = 0;
    for (size_t k = 0; k < runs.size(); k++) {
        const size_t first = first_of(k);
        runs[first].cells += runs[k].end - runs[k].begin;
        if (runs[first].cells > runs[largest].cells) largest = first;
    }
    for (size_t k = 0; k < runs.size(); k++)
        if (first_of(k) != largest)
            std::fill_n(raster.filled.begin() + static_cast<ptrdiff_t>(runs[k].begin),
                        runs[k].end - runs[k].begin, uint8_t{0});
    return runs.empty() ? 0 : runs[largest].begin;
}

// The outer border of the part that `start` begins, through the middles of the cells' sides,
// counter-clockwise.
FlatLine follow_border(const Raster& raster, size_t start) {
    constexpr std::array<std::array<int, 2>, 4> kWays = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    // A walker along lattice corners keeps filled cells to its left. It starts along the first cell's lower
    // side.
    const int x0 = static_cast<int>(start % static_cast<size_t>(raster.width));
    const int y0 = static_cast<int>(start / static_cast<size_t>(raster.width));
    int x = x0, y = y0, way = 0;
    // The cell to the left of a step from the corner (x, y), and the one to its right.
    const auto filled = [&](int cx, int cy) { return raster.filled[raster.at(cx, cy)] != 0; };
    const auto left = [&](int px, int py, int w) {
        constexpr std::array<std::array<int, 2>, 4> kLeft = {{{0, 0}, {-1, 0}, {-1, -1}, {0, -1}}};
        return filled(px + kLeft[static_cast<size_t>(w)][0], py + kLeft[static_cast<size_t>(w)][1]);
    };
    const auto right = [&](int px, int py, int w) {
        constexpr std::array<std::array<int, 2>, 4> kRight = {{{0, -1}, {0, 0}, {-1, 0}, {-1, -1}}};
        return filled(px + kRight[static_cast<size_t>(w)][0], py + kRight[static_cast<size_t>(w)][1]);
    };
    FlatLine border;
    do {
        const auto& step = kWays[static_cast<size_t>(way)];
        border.push_back(raster.low + raster.cell * DVec2(x + 0.5 * step[0], y + 0.5 * step[1]));
        x += step[0];
        y += step[1];
        // Cells that only share a corner do not hang together: the sharpest turn to the left comes first.
        for (const int turn : {1, 0, 3}) {
            const int next = (way + turn) % 4;
            if (left(x, y, next) && !right(x, y, next)) {
                way = next;
                break;
            }
        }
    } while (x != x0 || y != y0 || way != 0);
    return border;
}

FlatLine smooth_closed(const FlatLine& polygon) {
    FlatLine smooth(polygon.size());
    const size_t n = polygon.size();
    for (size_t i = 0; i < n; i++)
        smooth[i] = 0.25 * polygon[(i + n - 1) % n] + 0.5 * polygon[i] + 0.25 * polygon[(i + 1) % n];
    return smooth;
}

FlatLine unite(const std::vector<FlatLine>& polygons) {
    FlatLine all;
    for (const FlatLine& polygon : polygons)
        all.insert(all.end(), polygon.begin(), polygon.end());
    const FlatBox box = line_box(all);
    Raster raster;
    raster.cell = std::max(kLeastCell, std::max(box.size().x, box.size().y) / kMostCells);
    raster.low = box.low - DVec2(2.0 * raster.cell);
    raster.width = static_cast<int>(box.size().x / raster.cell) + 5;
    raster.height = static_cast<int>(box.size().y / raster.cell) + 5;
    raster.filled.assign(static_cast<size_t>(raster.width) * static_cast<size_t>(raster.height), 0);
    for (const FlatLine& polygon : polygons)
        fill_polygon(raster, polygon);
    const size_t start = keep_largest(raster);
    if (start == 0) return {};
    const FlatLine border = follow_border(raster, start);
    // Twice, so that the steps of the cells are gone; a thin neck may not bear it.
    FlatLine smooth = smooth_closed(smooth_closed(border));
    if (is_simple(smooth)) return smooth;
    return border;
}

}  // namespace

bool is_simple(const FlatLine& polygon) {
    const size_t n = polygon.size();
    if (n < 3) return false;
    struct Side {
        double low, high;
        size_t i;
    };
    std::vector<Side> sides(n);
    for (size_t i = 0; i < n; i++) {
        const DVec2 a = polygon[i], b = polygon[(i + 1) % n];
        if (a == b) return false;
        sides[i] = {std::min(a.x, b.x), std::max(a.x, b.x), i};
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.low < b.low; });
    for (size_t k = 0; k < n; k++) {
        const size_t i = sides[k].i;
        const DVec2 a = polygon[i], b = polygon[(i + 1) % n];
        for (size_t m = k + 1; m < n && sides[m].low <= sides[k].high; m++) {
            const size_t j = sides[m].i;
            const DVec2 c = polygon[j], d = polygon[(j + 1) % n];
            if (std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y)) continue;
            if ((i + 1) % n == j || (j + 1) % n == i) {
                // Neighbours: only one that goes straight back on the other is wrong.
                const DVec2 u = b - a, v = d - c;
                if (std::abs(cross(u, v)) <= 1e-12 * glm::length(u) * glm::length(v) && glm::dot(u, v) < 0.0)
                    return false;
                continue;
            }
            const double c_side = cross(b - a, c - a), d_side = cross(b - a, d - a);
            const double a_side = cross(d - c, a - c), b_side = cross(d - c, b - c);
            if ((c_side > 0.0 && d_side > 0.0) || (c_side < 0.0 && d_side < 0.0)) continue;
            if ((a_side > 0.0 && b_side > 0.0) || (a_side < 0.0 && b_side < 0.0)) continue;
            return false;
        }
    }
    return true;
}

MadeOutline make_outline(const std::vector<FlatLine>& lines) {
    MadeOutline made;
    if (lines.empty()) return made;
    made.chord = glm::length(lines[0].back() - lines[0].front());
    FlatLine all;
    std::vector<FlatLine> polygons;
    for (const FlatLine& line : lines) {
        if (line.size() < 3) continue;
        polygons.push_back(without_repeats(cut_overlap(line)));
        if (polygons.back() != without_repeats(line) && lines.size() == 1) made.chord = 0.0;
        all.insert(all.end(), line.begin(), line.end());
    }
    if (polygons.empty()) return made;
    if (polygons.size() == 1 && is_simple(polygons[0])) {
        made.polygon = polygons[0];
    } else {
        made.united = true;
        made.polygon = unite(polygons);
    }
    if (polygon_area(made.polygon) < 0.0) std::reverse(made.polygon.begin(), made.polygon.end());
    const FlatLine hull = flat_hull(all);
    const double around = hull.size() < 3 ? 0.0 : polygon_area(hull);
    const double inside = made.polygon.size() < 3 ? 0.0 : polygon_area(made.polygon);
    if (around < kLeastArea) {
        made.polygon.clear();
    } else if (made.united && inside < kHatchedShare * around) {
        made.polygon = hull;
        made.hull = true;
    } else if (inside < kLeastArea) {
        made.polygon.clear();
    }
    return made;
}

std::vector<FlatLine> join_arcs(std::vector<FlatLine> lines) {
    constexpr double kOpen = 0.3;   // of its length between its ends
    constexpr double kNear = 0.12;  // of both lengths between the ends of two
    constexpr size_t kMostLines = 40;
    const auto gap = [](const FlatLine& a, const FlatLine& b) { return glm::length(a.back() - b.front()); };
    for (size_t i = 0; i < lines.size() && lines.size() <= kMostLines; i++) {
        bool joined = true;
        while (joined && gap(lines[i], lines[i]) > kOpen * line_length(lines[i])) {
            joined = false;
            for (size_t k = 0; k < lines.size() && !joined; k++) {
                if (k == i || gap(lines[k], lines[k]) <= kOpen * line_length(lines[k])) continue;
                const double near = kNear * (line_length(lines[i]) + line_length(lines[k]));
                for (const bool turned : {false, true}) {
                    FlatLine other = lines[k];
                    if (turned) std::reverse(other.begin(), other.end());
                    // The nearer ends of the two meet.
                    const bool after = gap(lines[i], other) <= gap(other, lines[i]);
                    if (joined || std::min(gap(lines[i], other), gap(other, lines[i])) > near) continue;
                    FlatLine both = after ? lines[i] : other;
                    const FlatLine& rest = after ? other : lines[i];
                    both.insert(both.end(), rest.begin(), rest.end());
                    lines[i] = both;
                    joined = true;
                }
                if (!joined) continue;
                lines.erase(lines.begin() + static_cast<ptrdiff_t>(k));
                if (k < i) i--;
            }
        }
    }
    return lines;
}

FlatLine outline_around(const FlatLine& points, double margin) {
    constexpr int kDirections = 24;
    FlatLine wide;
    for (const DVec2& p : flat_hull(points))
        for (int i = 0; i < kDirections; i++) {
            const SineCosine turn = portable_sine_cosine(2.0 * kPi * i / kDirections);
            wide.push_back(p + margin * DVec2(turn.cosine, turn.sine));
        }
    return flat_hull(wide);
}

}  // namespace treerec
