#include "foliage/crown.h"

#include <algorithm>

#include "geometry/random.h"

namespace treerec {

double Crown::sway(const DVec3& p) const {
    return std::clamp((p.y - ground) / height, 0.0, 1.0);
}

double Crown::openness(const DVec3& p) const {
    const double t = std::clamp(glm::length((p - centre) / radii), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

DVec3 Crown::outward(const DVec3& p) const {
    return normalized_or((p - centre) / (radii * radii), DVec3(0.0, 1.0, 0.0));
}

Crown measure_crown(const Tree& tree) {
    Crown crown;
    const DVec3 root = tree.node(tree.root()).position;
    DVec3 sum(0.0);
    Bounds box;
    int tips = 0;
    for (NodeId id = 0; id < tree.id_end(); id++) {
        if (!tree.contains(id)) continue;
        const Node& node = tree.node(id);
        box.add(node.position);
        if (node.child_count > 0) continue;
        sum += node.position;
        tips++;
    }
    crown.centre = sum / static_cast<double>(tips);
    double across = 0.0, upright = 0.0;
    for (NodeId id = 0; id < tree.id_end(); id++) {
        if (!tree.contains(id) || tree.node(id).child_count > 0) continue;
        const DVec3 from = tree.node(id).position - crown.centre;
        across += from.x * from.x + from.z * from.z;
        upright += from.y * from.y;
    }
    const double extent = box.diagonal();
    const DVec3 largest = glm::max(glm::abs(box.min), glm::abs(box.max));
    crown.coordinate = std::max({largest.x, largest.y, largest.z, 1e-30});
    crown.ground = root.y;
    crown.height = std::max({box.max.y - root.y, 0.05 * extent, 1e-30});
    // Points spread evenly in an ellipsoid lie, by root mean square, at sqrt(2/5) of its half axes across and
    // at sqrt(1/5) upright.
    const double least = std::max(0.1 * extent, 1e-30);
    const double a = std::max(std::sqrt(across / tips / 0.4), least);
    crown.radii = {a, std::max(std::sqrt(upright / tips / 0.2), least), a};
    return crown;
}

double branch_phase(NodeId tip) {
    return static_cast<double>(hash_seed(0x77696e64, static_cast<uint64_t>(tip)) >> 11) * 0x1p-53;
}

}  // namespace treerec
