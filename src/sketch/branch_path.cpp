#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"
#include "sketch/branch_depth.h"
#include "sketch/sketch_axes.h"

namespace treerec {

namespace {

constexpr int kRounds = 8;
constexpr int kWideRounds = 4;
constexpr double kDamping = 0.3;  // of the points' weight
constexpr double kAround = 0.05;  // metres outside of the bark that still pull
constexpr double kBeside = 0.08;  // metres along the axis that a place looks at
constexpr double kStiff = 0.5;    // how far a place gives way to its neighbours, each round
constexpr double kShown = 0.04;   // metres outside of the bark
constexpr size_t kLeastShown = 2;
constexpr double kOnBark = 0.006;  // metres, and an eighth of the radius
constexpr double kClosed = 0.30;   // metres of a gap that is none
constexpr double kDropped = 0.15;

// The points within a reach of a place.
struct Around {
    float square;
    std::vector<uint32_t> found = {};

    float limit() const { return square; }
    void add(float at, uint32_t index) {
        if (at <= square) found.push_back(index);
    }
};

std::vector<DVec3> every(const std::vector<DVec3>& line, double step) {
    const double length = length_of(line);
    const auto count = static_cast<size_t>(std::max(1.0, std::round(length / step)));
    std::vector<DVec3> even;
    for (size_t i = 0; i <= count; i++)
        even.push_back(place_along(line, length * static_cast<double>(i) / static_cast<double>(count)));
    return even;
}

DVec3 way_at(const std::vector<DVec3>& axis, size_t i) {
    return normalized_or(axis[std::min(i + 1, axis.size() - 1)] - axis[i > 0 ? i - 1 : 0],
                         DVec3(0.0, 1.0, 0.0));
}

// Sets runs of `value` that are shorter than `length` metres to the other one.
void close_runs(std::vector<uint8_t>& shown, const std::vector<DVec3>& axis, uint8_t value, double length,
                bool ends) {
    for (size_t begin = 0; begin < shown.size();) {
        size_t end = begin;
        double run = 0.0;
        for (; end < shown.size() && shown[end] == shown[begin]; end++)
            if (end > begin) run += glm::distance(axis[end], axis[end - 1]);
        const bool inner = begin > 0 && end < shown.size();
        if (shown[begin] == value && run < length && (ends || inner))
            std::fill(shown.begin() + static_cast<std::ptrdiff_t>(begin),
                      shown.begin() + static_cast<std::ptrdiff_t>(end), static_cast<uint8_t>(value ? 0 : 1));
        begin = end;
    }
}

}  // namespace

std::vector<DVec3> centre_path(const std::vector<Vec3>& points, const DVec3& joint, const BranchPath& path,
                               double step, const PathRadius& radius, const Progress* progress) {
    std::vector<DVec3> axis{joint};
    for (const BranchPath::Stop& stop : path.stops)
        axis.push_back(stop.place);
    const PointTree near(points);
    for (int round = 0; round < kRounds; round++) {
        if (progress) progress->check();
        axis = every(axis, step);
        std::vector<DVec3> moved = axis;
        for (size_t i = 1; i < axis.size(); i++) {
            const DVec3 way = way_at(axis, i);
            const DVec3 right = any_perpendicular(way), up = glm::cross(way, right);
            const double r = radius.at(static_cast<double>(i) / static_cast<double>(axis.size() - 1));
            // At first the path may lie on the bark: the far side is a diameter away.
            const double reach = (round < kWideRounds ? 2.0 : 1.3) * r + kAround;
            const double blur = 0.5 * r + kAround;
            Around around{static_cast<float>(reach * reach + kBeside * kBeside)};
            near.search(Vec3(axis[i]), around);
            std::sort(around.found.begin(), around.found.end());
            double weights = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
            DVec2 pull(0.0);
            for (const uint32_t k : around.found) {
                const DVec3 off = DVec3(points[k]) - axis[i];
                if (std::abs(glm::dot(off, way)) > kBeside) continue;
                const DVec2 p(glm::dot(off, right), glm::dot(off, up));
                const double distance = glm::length(p);
                const double rest = distance - r;
                if (distance > reach || distance < 1e-6) continue;
                const double part = std::min(1.0, std::abs(rest) / std::max(blur, reach - r));
                const double weight = (1.0 - part * part) * (1.0 - part * part);
                const DVec2 out = p / distance;
                weights += weight;
                xx += weight * out.x * out.x;
                xy += weight * out.x * out.y;
                yy += weight * out.y * out.y;
                pull += out * (weight * rest);
            }
            if (weights < 0.5) continue;
            xx += kDamping * weights;
            yy += kDamping * weights;
            const double area = xx * yy - xy * xy;
            const DVec2 move = DVec2(yy * pull.x - xy * pull.y, xx * pull.y - xy * pull.x) / area;
            moved[i] += right * move.x + up * move.y;
        }
        for (int pass = 0; pass < 2; pass++) {
            const std::vector<DVec3> before = moved;
            for (size_t i = 1; i + 1 < moved.size(); i++)
                moved[i] = before[i] * (1.0 - kStiff) + (before[i - 1] + before[i + 1]) * (0.5 * kStiff);
        }
        axis = moved;
    }
    return axis;
}

double bark_share(const std::vector<Vec3>& points, const std::vector<DVec3>& axis, const PathRadius& radius) {
    const PointTree near(points);
    double shares = 0.0;
    size_t places = 0;
    for (size_t i = 1; i < axis.size(); i++) {
        const DVec3 way = way_at(axis, i);
        const double r = radius.at(static_cast<double>(i) / static_cast<double>(axis.size() - 1));
        const double reach = 2.0 * r + kAround;
        Around around{static_cast<float>(reach * reach + kBeside * kBeside)};
        near.search(Vec3(axis[i]), around);
        size_t on = 0, all = 0;
        for (const uint32_t k : around.found) {
            const DVec3 off = DVec3(points[k]) - axis[i];
            const double along = glm::dot(off, way);
            const double distance = glm::length(off - way * along);
            if (std::abs(along) > kBeside || distance > reach) continue;
            all++;
            on += std::abs(distance - r) < kOnBark + 0.125 * r ? 1 : 0;
        }
        if (all < kLeastShown) continue;
        shares += static_cast<double>(on) / static_cast<double>(all);
        places++;
    }
    return places > 0 ? shares / static_cast<double>(places) : 0.0;
}

std::vector<uint8_t> shown_places(const std::vector<Vec3>& points, const std::vector<DVec3>& axis,
                                  const PathRadius& radius) {
    const PointTree near(points);
    std::vector<uint8_t> shown(axis.size(), 0);
    for (size_t i = 0; i < axis.size(); i++) {
        const DVec3 way = way_at(axis, i);
        const double reach =
            radius.at(static_cast<double>(i) / static_cast<double>(axis.size() - 1)) + kShown;
        Around around{static_cast<float>(reach * reach + kBeside * kBeside)};
        near.search(Vec3(axis[i]), around);
        size_t count = 0;
        for (const uint32_t k : around.found) {
            const DVec3 off = DVec3(points[k]) - axis[i];
            const double along = glm::dot(off, way);
            count += std::abs(along) <= kBeside && glm::length(off - way * along) <= reach ? 1 : 0;
        }
        shown[i] = count >= kLeastShown ? 1 : 0;
    }
    close_runs(shown, axis, 0, kClosed, false);
    close_runs(shown, axis, 1, kDropped, true);
    return shown;
}

}  // namespace treerec
