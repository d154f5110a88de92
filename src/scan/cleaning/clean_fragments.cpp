#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/point_tree.h"
#include "scan/cleaning/clean_steps.h"
#include "scan/cleaning/samples.h"

namespace treerec {

namespace {

// All lengths as shares of the cloud's extent.
constexpr double kCell = 0.03;
// A part with a share of the points is one of the tree's unless it stands well apart: a stem below a gap, a
// branch seen from one side.
constexpr double kNear = 0.25;
// A few points are a leaf or the end of a twig if they are nearer still.
constexpr double kVeryNear = 0.08;
constexpr size_t kFew = 10;
// How far a part may lie that the tree, or the part, or both point at.
constexpr double kFarInTreesLine = 0.35;
constexpr double kFarInOwnLine = 0.35;
constexpr double kFarInBothLines = 0.5;
constexpr double kFarBelow = 0.5;
constexpr std::array<double, 2> kEnds{0.08, 0.2};  // how much of an end tells its direction
constexpr double kLongish = 1.8;                   // length by width of what has a direction
constexpr double kInLine = 0.85;                   // cosine
constexpr double kLean = 0.35;                     // sideways by height, of a stem through a gap
constexpr double kAim = 0.2;                       // how far beside it an end may point, by distance
constexpr size_t kMostRounds = 16;
constexpr size_t kBlock = 4096;  // points between two looks at the progress

// The straight line through points.
struct Line {
    DVec3 centre{0.0};
    DVec3 axis{0.0, 1.0, 0.0};
    double longish = 0.0;  // deviation along the axis by that across it
};

Line line_through(const std::vector<DVec3>& points) {
    Line line;
    if (points.size() < kFew) return line;
    const double count = static_cast<double>(points.size());
    for (const DVec3& p : points)
        line.centre += p / count;
    DMat3 covariance(0.0);
    for (const DVec3& p : points)
        covariance += glm::outerProduct(p - line.centre, p - line.centre) / count;
    int widest = 0;
    for (int axis = 1; axis < 3; axis++)
        if (covariance[axis][axis] > covariance[widest][widest]) widest = axis;
    DVec3 axis = covariance[widest];
    if (!(glm::length(axis) > 0.0)) return line;
    for (int step = 0; step < 32; step++)
        axis = glm::normalize(covariance * glm::normalize(axis));
    line.axis = axis;
    const double along = glm::dot(axis, covariance * axis);
    const double across =
        0.5 * (covariance[0][0] + covariance[1][1] + covariance[2][2] - along) + 1e-12 * along;
    line.longish = std::sqrt(along / across);
    return line;
}

// For PointTree::search(): all points nearer than a distance.
struct Within {
    float square = 0.0F;
    std::vector<uint32_t> points;

    float limit() const { return square; }
    void add(float distance, uint32_t i) {
        if (distance < square) points.push_back(i);
    }
};

// The tree found so far, which grows by the parts that belong to it.
class Main {
  public:
    Main(std::vector<Vec3> points, double extent)
        : points_(std::move(points)), extent_(extent), tree_(points_) {
        std::vector<float> heights;
        for (const Vec3& p : points_)
            heights.push_back(p.y);
        low_ = quantile(heights, 0.002);
        size_t count = 0;
        for (const Vec3& p : points_) {
            if (p.y > low_ + 0.03 * extent_) continue;
            foot_ += DVec3(p.x, 0.0, p.z);
            count++;
        }
        foot_ /= static_cast<double>(std::max<size_t>(1, count));
        std::vector<double> distances;
        for (const Vec3& p : points_)
            distances.push_back(glm::length(DVec3(p.x, 0.0, p.z) - foot_));
        radius_ = quantile(distances, 0.95);
    }

    double nearest(const Vec3& p, uint32_t& found) const {
        float square = 0.0F;
        tree_.nearest(p, 1, &found, &square);
        return std::sqrt(static_cast<double>(square));
    }
    const Vec3& point(uint32_t i) const { return points_[i]; }

    // The points within `reach` of a place.
    std::vector<DVec3> around(const Vec3& place, double reach) const {
        Within found{static_cast<float>(reach * reach), {}};
        tree_.search(place, found);
        std::vector<uint32_t>& order = found.points;
        std::sort(order.begin(), order.end());
        std::vector<DVec3> points;
        for (const uint32_t i : order)
            points.emplace_back(points_[i]);
        return points;
    }

    // Whether a part lies where this tree's stem would go on downwards.
    bool stands_on(const std::vector<Vec3>& part) const {
        std::vector<float> heights;
        std::vector<DVec3> places;
        for (const Vec3& p : part) {
            heights.push_back(p.y);
            places.emplace_back(p);
        }
        const double top = quantile(heights, 0.98);
        const double gap = low_ - top;
        if (gap < 0.0 || gap > kFarBelow * extent_) return false;
        const Line line = line_through(places);
        const DVec3 centre(line.centre.x, 0.0, line.centre.z);
        std::vector<double> distances;
        for (const DVec3& p : places)
            distances.push_back(glm::length(DVec3(p.x, 0.0, p.z) - centre));
        const double width = quantile(distances, 0.9);
        // A plate is ground or what lies on it.
        const double height = top - quantile(heights, 0.02);
        if (width > std::max(0.5 * radius_, 0.05 * extent_) || width > 2.0 * height) return false;
        const double off = glm::length(centre - foot_);
        if (off < kLean * gap + width) return true;
        const bool stem = line.longish > kLongish && std::abs(line.axis.y) > 0.8;
        return stem && off < radius_;
    }

    // Whether a part lies over the middle of this tree, as the crown over a stem.
    bool stands_under(const std::vector<Vec3>& part) const {
        DVec3 centre(0.0);
        for (const Vec3& p : part)
            centre += DVec3(p) / static_cast<double>(part.size());
        const double off = glm::length(DVec3(centre.x, 0.0, centre.z) - foot_);
        return centre.y > low_ && off < 0.5 * radius_;
    }

    // Whether a part goes on where an end of this tree points to, or points at this tree.
    bool goes_on_in(const std::vector<Vec3>& part, const Vec3& from, const Vec3& to, bool substantial) const {
        const DVec3 between = DVec3(to) - DVec3(from);
        const double gap = glm::length(between);
        if (!(gap > 0.0)) return true;
        const DVec3 direction = between / gap;
        const auto leads = [&](const std::vector<DVec3>& end, const DVec3& tip, const DVec3& away) {
            const Line line = line_through(end);
            return line.longish > kLongish && std::abs(glm::dot(line.axis, direction)) > kInLine &&
                   glm::dot(tip - line.centre, away) > 0.0;
        };
        bool tree_leads = false;
        bool part_leads = false;
        for (const double share : kEnds) {
            const double reach = share * extent_;
            tree_leads |= leads(around(from, reach), DVec3(from), direction);
            std::vector<DVec3> end;
            for (const Vec3& p : part)
                if (glm::length(DVec3(p) - DVec3(to)) <= reach) end.emplace_back(p);
            part_leads |= leads(end, DVec3(to), -direction);
        }
        if (tree_leads && part_leads) return gap < (substantial ? kFarInBothLines : kNear) * extent_;
        if (!substantial) return false;
        return (tree_leads && gap < kFarInTreesLine * extent_) ||
               (part_leads && gap < kFarInOwnLine * extent_);
    }

    // Whether one of a part's ends points at this tree, past whatever is nearer.
    bool is_aimed_at_by(const std::vector<Vec3>& part) const {
        std::vector<DVec3> places(part.begin(), part.end());
        const Line whole = line_through(places);
        const auto end_towards = [&](const DVec3& way) {
            return *std::ranges::max_element(places, {},
                                             [&](const DVec3& p) { return glm::dot(p - whole.centre, way); });
        };
        for (const DVec3& way : {DVec3(0.0, -1.0, 0.0), whole.axis, -whole.axis}) {
            const DVec3 tip = end_towards(way);
            for (const double share : kEnds) {
                std::vector<DVec3> end;
                for (const DVec3& p : places)
                    if (glm::length(p - tip) <= share * extent_) end.push_back(p);
                const Line line = line_through(end);
                if (line.longish < kLongish) continue;
                const DVec3 out = glm::dot(line.axis, tip - line.centre) < 0.0 ? -line.axis : line.axis;
                if (glm::dot(out, way) < 0.5) continue;
                for (double t = kCell; t < kFarInOwnLine; t += 0.5 * kCell) {
                    uint32_t found = 0;
                    const Vec3 ahead(tip + t * extent_ * out);
                    if (nearest(ahead, found) < (kAim * t + 0.5 * kCell) * extent_) return true;
                }
            }
        }
        return false;
    }

  private:
    std::vector<Vec3> points_;
    double extent_;
    PointTree tree_;
    double low_ = 0.0;
    DVec3 foot_{0.0};
    double radius_ = 0.0;
};

}  // namespace

std::vector<uint8_t> find_fragments(const std::vector<Vec3>& points, double spacing,
                                    const Progress* progress) {
    std::vector<uint8_t> goes(points.size());
    if (points.size() < 10) return goes;
    const std::array<Range, 3> ranges = robust_ranges(points, progress);
    const double extent = std::max({ranges[0].size(), ranges[1].size(), ranges[2].size()});
    if (!(extent > 0.0)) return goes;
    const std::vector<uint32_t> label =
        connected_components(points, ranges, std::max(kCell * extent, 3.0 * spacing), progress);

    const size_t count = *std::max_element(label.begin(), label.end()) + size_t{1};
    if (count == 1) return goes;
    std::vector<size_t> size(count);
    for (const uint32_t l : label)
        size[l]++;
    const size_t largest = static_cast<size_t>(std::max_element(size.begin(), size.end()) - size.begin());
    // Points that are all far from each other are no fragments of anything.
    if (size[largest] < 10) return goes;

    const size_t substantial = std::max<size_t>(5, points.size() / 200);
    std::vector<Vec3> tree;
    std::vector<std::vector<Vec3>> parts(count);
    for (size_t i = 0; i < points.size(); i++) {
        if (label[i] == largest)
            tree.push_back(points[i]);
        else if (size[label[i]] >= std::min(kFew, substantial))
            parts[label[i]].push_back(points[i]);
    }
    std::vector<uint8_t> stays(count);
    stays[largest] = 1;
    // What stays may be what another part goes on from: a branch in three pieces.
    const auto any_left = [&] {
        for (size_t l = 0; l < count; l++)
            if (!stays[l] && !parts[l].empty()) return true;
        return false;
    };
    for (size_t round = 0; round < kMostRounds && any_left(); round++) {
        const Main main(tree, extent);
        bool grew = false;
        for (size_t l = 0; l < count; l++) {
            if (progress) progress->check();
            if (stays[l] || parts[l].empty()) continue;
            double gap = std::numeric_limits<double>::max();
            uint32_t from = 0;
            Vec3 to(0.0F);
            for (size_t i = 0; i < parts[l].size(); i++) {
                if (progress && i % kBlock == 0) progress->check();
                const Vec3& p = parts[l][i];
                uint32_t found = 0;
                const double distance = main.nearest(p, found);
                if (distance >= gap) continue;
                gap = distance;
                from = found;
                to = p;
            }
            const bool is_substantial = size[l] >= substantial;
            // Nearness counts from the tree itself, and half as far from what was added to it: else one stray
            // part would bring the next.
            const double near = (round == 0 ? 1.0 : 0.5) * kNear;
            if (is_substantial)
                stays[l] = gap <= near * extent ||
                           (gap <= kFarInTreesLine * extent && main.stands_under(parts[l])) ||
                           main.stands_on(parts[l]) || main.is_aimed_at_by(parts[l]);
            else
                stays[l] = round == 0 && gap <= kVeryNear * extent;
            stays[l] = stays[l] || (gap <= kFarInBothLines * extent &&
                                    main.goes_on_in(parts[l], main.point(from), to, is_substantial));
            if (!stays[l]) continue;
            grew = true;
            tree.insert(tree.end(), parts[l].begin(), parts[l].end());
        }
        if (!grew) break;
    }
    for (size_t i = 0; i < points.size(); i++)
        goes[i] = !stays[label[i]];
    return goes;
}

}  // namespace treerec
