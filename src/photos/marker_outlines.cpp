#include "photos/marker_outlines.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace treerec {

namespace {

// Small markers need a window that is not much wider than their border, blurred ones one that is wider than
// their blur.
constexpr int kWindows[] = {7, 19, 51};  // pixels
constexpr int kDarker = 6;               // grey levels than the window's mean
constexpr int kRowsBetweenChecks = 64;
// Of the square of a loop's length; a square that lies level has .0625, one on its tip that is seen from the
// side, at 70 degrees, .02.
constexpr double kLeastArea = 0.012;
constexpr double kLeastSolid = 0.85;  // of its convex hull, that a loop fills

constexpr uint8_t kDark = 1, kFollowed = 2;

using Loop = std::vector<glm::ivec2>;

// Dark pixels, in a frame of light ones.
struct Darkness {
    int stride = 0;
    std::vector<uint8_t> cells;

    uint8_t& at(int x, int y) {
        return cells[static_cast<size_t>(y + 1) * static_cast<size_t>(stride) + static_cast<size_t>(x + 1)];
    }
};

class Sums {
  public:
    explicit Sums(const GreyPicture& picture)
        : stride_(static_cast<size_t>(picture.width) + 1),
          sums_(stride_ * (static_cast<size_t>(picture.height) + 1)) {
        for (int y = 0; y < picture.height; y++) {
            const uint8_t* row = picture.row(y);
            const uint32_t* above = sums_.data() + static_cast<size_t>(y) * stride_;
            uint32_t* here = sums_.data() + static_cast<size_t>(y + 1) * stride_;
            uint32_t sum = 0;
            for (int x = 0; x < picture.width; x++) {
                sum += row[x];
                here[x + 1] = above[x + 1] + sum;
            }
        }
    }
    const uint32_t* row(int y) const { return sums_.data() + static_cast<size_t>(y) * stride_; }

  private:
    size_t stride_;
    std::vector<uint32_t> sums_;  // may run over; differences are right nevertheless
};

void find_darkness(const GreyPicture& picture, const Sums& sums, int window, Darkness& dark) {
    const int half = window / 2, width = picture.width, height = picture.height;
    dark.stride = width + 2;
    dark.cells.assign(static_cast<size_t>(width + 2) * static_cast<size_t>(height + 2), 0);
    for (int y = 0; y < height; y++) {
        const int top = std::max(0, y - half), bottom = std::min(height, y + half + 1);
        const uint32_t *above = sums.row(top), *below = sums.row(bottom);
        const uint8_t* row = picture.row(y);
        uint8_t* out = &dark.at(0, y);
        for (int x = 0; x < width; x++) {
            const int left = std::max(0, x - half), right = std::min(width, x + half + 1);
            const auto area = static_cast<uint32_t>((right - left) * (bottom - top));
            const uint32_t sum = below[right] - below[left] - above[right] + above[left];
            out[x] = (static_cast<uint32_t>(row[x]) + kDarker) * area < sum ? kDark : 0;
        }
    }
}

// Along the cracks between dark and light pixels, dark ones at the right, from the left side of a dark pixel;
// dark pixels that touch at a corner are joined. loop: the corners of pixels on the way.
void follow(Darkness& dark, int x, int y, Loop& loop) {
    constexpr int kAlong[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    // From a corner of pixels, the pixel ahead on the left and on the right.
    constexpr int kLeft[4][2] = {{0, -1}, {0, 0}, {-1, 0}, {-1, -1}};
    constexpr int kRight[4][2] = {{0, 0}, {-1, 0}, {-1, -1}, {0, -1}};
    loop.clear();
    int u = x, v = y + 1, way = 3;
    do {
        loop.push_back({u, v});
        if (way == 3) dark.at(u, v - 1) |= kFollowed;
        u += kAlong[way][0];
        v += kAlong[way][1];
        if (dark.at(u + kLeft[way][0], v + kLeft[way][1]) & kDark)
            way = (way + 3) % 4;
        else if (!(dark.at(u + kRight[way][0], v + kRight[way][1]) & kDark))
            way = (way + 1) % 4;
    } while (u != x || v != y + 1 || way != 3);
}

// Twice the area; positive for loops around dark pixels.
double doubled_area(const Loop& loop) {
    int64_t sum = 0;
    for (size_t i = 0; i < loop.size(); i++) {
        const glm::ivec2 &a = loop[i], &b = loop[i + 1 < loop.size() ? i + 1 : 0];
        sum += static_cast<int64_t>(a.x) * b.y - static_cast<int64_t>(a.y) * b.x;
    }
    return static_cast<double>(sum);
}

double cross(const DVec2& a, const DVec2& b) {
    return a.x * b.y - a.y * b.x;
}

// A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979; in the loop's sense.
std::vector<DVec2> hull_of(const Loop& loop) {
    Loop sorted = loop;
    const auto before = [](const glm::ivec2& a, const glm::ivec2& b) {
        return a.x != b.x ? a.x < b.x : a.y < b.y;
    };
    std::sort(sorted.begin(), sorted.end(), before);
    std::vector<DVec2> hull;
    const auto add = [&](const glm::ivec2& point, size_t least) {
        const DVec2 p(point);
        while (hull.size() >= least + 2 &&
               cross(hull[hull.size() - 1] - hull[hull.size() - 2], p - hull[hull.size() - 1]) <= 0.0)
            hull.pop_back();
        hull.push_back(p);
    };
    for (const glm::ivec2& point : sorted)
        add(point, 0);
    hull.pop_back();
    const size_t lower = hull.size();
    for (size_t i = sorted.size(); i-- > 0;)
        add(sorted[i], lower);
    hull.pop_back();
    return hull;
}

double area_of(const std::vector<DVec2>& polygon) {
    double sum = 0.0;
    for (size_t i = 0; i < polygon.size(); i++)
        sum += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
    return 0.5 * sum;
}

// Takes away the corner that adds the least area, until four are left (M. Visvalingam and J. D. Whyatt, "Line
// generalisation by repeated elimination of points", 1993).
bool reduce_to_four(std::vector<DVec2>& polygon) {
    while (polygon.size() > 4) {
        size_t least = 0;
        double area = INFINITY;
        for (size_t i = 0; i < polygon.size(); i++) {
            const DVec2& a = polygon[(i + polygon.size() - 1) % polygon.size()];
            const DVec2& b = polygon[(i + 1) % polygon.size()];
            const double here = std::abs(cross(polygon[i] - a, b - a));
            if (here < area) {
                area = here;
                least = i;
            }
        }
        polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(least));
    }
    return polygon.size() == 4;
}

struct Line {
    DVec2 middle{0.0};
    DVec2 way{1.0, 0.0};
    double off = 0.0;  // root of the mean square
};

// The loop's points from one index to another, without those near both ends, where blur rounds the corner.
bool line_along(const Loop& loop, size_t from, size_t to, Line& line) {
    constexpr double kCorner = 0.15;
    const size_t count = (to + loop.size() - from) % loop.size();
    const auto skip = static_cast<size_t>(kCorner * static_cast<double>(count) + 0.5);
    if (count < 2 * skip + 3) return false;
    const size_t kept = count - 2 * skip + 1;
    DVec2 sum(0.0);
    for (size_t i = 0; i < kept; i++)
        sum += DVec2(loop[(from + skip + i) % loop.size()]);
    line.middle = sum / static_cast<double>(kept);
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (size_t i = 0; i < kept; i++) {
        const DVec2 p = DVec2(loop[(from + skip + i) % loop.size()]) - line.middle;
        xx += p.x * p.x;
        xy += p.x * p.y;
        yy += p.y * p.y;
    }
    const double half = 0.5 * (xx - yy), root = std::sqrt(half * half + xy * xy);
    if (!(root > 0.0)) return false;
    line.way = half > 0.0 ? DVec2(half + root, xy) : DVec2(xy, root - half);
    if (!(glm::length(line.way) > 0.0)) return false;
    line.way = glm::normalize(line.way);
    line.off = std::sqrt(std::max(0.0, 0.5 * (xx + yy) - root) / static_cast<double>(kept));
    return true;
}

// Four lines along the loop, where they follow it.
bool four_lines(const Loop& loop, const std::vector<DVec2>& corners, double least_side, Outline& outline) {
    std::array<size_t, 4> at{};
    for (size_t k = 0; k < 4; k++) {
        const glm::ivec2 corner(corners[k]);
        at[k] = static_cast<size_t>(std::find(loop.begin(), loop.end(), corner) - loop.begin());
        if (at[k] == loop.size()) return false;
    }
    std::array<Line, 4> lines;
    for (size_t k = 0; k < 4; k++)
        if (!line_along(loop, at[k], at[(k + 1) % 4], lines[k])) return false;
    for (size_t k = 0; k < 4; k++) {
        const Line &before = lines[(k + 3) % 4], &after = lines[k];
        if (!meet(before.middle, before.way, after.middle, after.way, outline[k])) return false;
    }
    const double side = mean_side(outline);
    if (!(side >= least_side) || !is_convex(outline)) return false;
    for (size_t k = 0; k < 4; k++) {
        const DVec2 &b = outline[k], &c = outline[(k + 1) % 4];
        // Blur rounds corners by no more than that.
        if (glm::distance(b, c) < 0.3 * side || glm::distance(b, corners[k]) > 0.25 * side + 2.0)
            return false;
        if (lines[k].off > 0.7 + 0.02 * side) return false;
    }
    return true;
}

}  // namespace

bool meet(const DVec2& a, const DVec2& b, const DVec2& c, const DVec2& d, DVec2& at) {
    const double across = cross(b, d);
    if (!(std::abs(across) > 1e-6 * glm::length(b) * glm::length(d))) return false;
    at = a + b * (cross(c - a, d) / across);
    return true;
}

double mean_side(const Outline& outline) {
    double sum = 0.0;
    for (size_t k = 0; k < 4; k++)
        sum += glm::distance(outline[k], outline[(k + 1) % 4]);
    return 0.25 * sum;
}

bool is_convex(const Outline& outline) {
    constexpr double kSine = 0.05;
    for (size_t k = 0; k < 4; k++) {
        const DVec2 in = outline[k] - outline[(k + 3) % 4], out = outline[(k + 1) % 4] - outline[k];
        if (!(cross(in, out) > kSine * glm::length(in) * glm::length(out))) return false;
    }
    return true;
}

std::vector<Outline> dark_outlines(const GreyPicture& picture, double least_side, const Progress* progress) {
    std::vector<Outline> outlines;
    if (picture.width < 3 || picture.height < 3) return outlines;
    const Sums sums(picture);
    Darkness dark;
    Loop loop;
    for (const int window : kWindows) {
        if (progress) progress->check();
        find_darkness(picture, sums, window, dark);
        for (int y = 0; y < picture.height; y++) {
            if (progress && y % kRowsBetweenChecks == 0) progress->check();
            const uint8_t* row = &dark.at(0, y);
            for (int x = 0; x < picture.width; x++) {
                if (row[x] != kDark || (row[x - 1] & kDark)) continue;
                follow(dark, x, y, loop);
                const double length = static_cast<double>(loop.size());
                if (length < 3.0 * least_side) continue;
                const double area = 0.5 * doubled_area(loop);
                if (area < kLeastArea * length * length) continue;
                std::vector<DVec2> corners = hull_of(loop);
                if (area < kLeastSolid * area_of(corners) - 2.0 * std::sqrt(area) || !reduce_to_four(corners))
                    continue;
                Outline outline;
                if (four_lines(loop, corners, least_side, outline)) outlines.push_back(outline);
            }
        }
    }
    return outlines;
}

}  // namespace treerec
