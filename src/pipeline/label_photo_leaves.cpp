#include "pipeline/label_photo_leaves.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/point_tree.h"
#include "photos/bark_colours.h"

namespace treerec {

namespace {

constexpr double kStemFrom = 0.03,
                 kStemTo = 0.3;  // of the tree's height: what is clear of grass, and of leaves
constexpr double kThick = 0.5;   // of the stem's radius: what is thinner is a branch
constexpr double kOnStem = 1.3;  // radii from the axis
constexpr double kCrown = 0.35;  // of the height, from there on
constexpr double kLeafy = 0.3;   // share of the crown's points

// Places on the stem's axis a quarter of its radius apart, and their radii.
struct StemAxis {
    std::vector<Vec3> places;
    std::vector<double> radii;
};

StemAxis stem_axis(const Tree& tree, double height) {
    StemAxis axis;
    NodeId here = tree.root();
    double thick = tree.node(here).radius;
    while (true) {
        NodeId next = kNoNode;
        for (const NodeId child : tree.children(here))
            if (next == kNoNode || tree.node(child).radius > tree.node(next).radius) next = child;
        if (next == kNoNode) return axis;
        const Node &from = tree.node(here), &to = tree.node(next);
        if (to.radius < kThick * thick || from.position.y > kStemTo * height) return axis;
        thick = std::min(thick, to.radius);
        const double length = glm::distance(from.position, to.position);
        const auto pieces =
            static_cast<size_t>(std::clamp(4.0 * length / std::max(to.radius, 1e-6), 1.0, 1000.0));
        for (size_t k = 0; k < pieces; k++) {
            const double t = static_cast<double>(k) / static_cast<double>(pieces);
            axis.places.emplace_back(glm::mix(from.position, to.position, t));
            axis.radii.push_back(glm::mix(from.radius, to.radius, t));
        }
        here = next;
    }
}

}  // namespace

bool label_photo_leaves(PointCloud& cloud, const Tree& tree, const DVec3& sky, const Progress* progress) {
    double height = 0.0, reach = 0.0;
    for (const NodeId id : tree.depth_first()) {
        const DVec3& p = tree.node(id).position;
        height = std::max(height, p.y);
        reach = std::max(reach, std::hypot(p.x, p.z));
    }
    const StemAxis axis = stem_axis(tree, height);
    if (axis.places.empty()) return false;
    const PointTree nearest(axis.places, progress);
    std::vector<uint32_t> bark, crown;
    for (uint32_t i = 0; i < cloud.size(); i++) {
        const Vec3 p(tree.frame().to_tree(cloud.frame.to_scan(DVec3(cloud.positions[i]))));
        const double y = static_cast<double>(p.y);
        if (y > kCrown * height && y <= height && std::hypot(p.x, p.z) <= reach) crown.push_back(i);
        uint32_t place = 0;
        float squared = 0.0F;
        if (y < kStemFrom * height || y > kStemTo * height || nearest.nearest(p, 1, &place, &squared) != 1)
            continue;
        const double most = kOnStem * axis.radii[place];
        if (static_cast<double>(squared) <= most * most) bark.push_back(i);
    }
    std::vector<uint8_t> unlike = unlike_bark(cloud, bark, sky, progress);
    if (unlike.empty() || crown.empty()) return false;
    const auto leaves = std::count_if(crown.begin(), crown.end(), [&](uint32_t i) { return unlike[i] != 0; });
    if (static_cast<double>(leaves) < kLeafy * static_cast<double>(crown.size())) return false;
    cloud.labels = {"leaf_by_colour", true, std::move(unlike), true};
    return true;
}

}  // namespace treerec
