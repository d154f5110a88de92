// Trees that bark grows on in tests, and what its surface must always be.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "growth/grow_bark.h"
#include "tree/tree.h"

namespace treerec::test {

// A straight trunk, as thick all along.
inline Tree cylinder(double radius, double height) {
    Tree tree;
    NodeId last = tree.add_root(DVec3(0.0), radius, kTrunkFlag);
    for (int i = 1; i <= 10; i++)
        last = tree.add_child(last, DVec3(0.0, height * i / 10.0, 0.0), radius, kTrunkFlag);
    return tree;
}

// chi: what it is expected to be; a fused surface's falls by two from handle to handle.
inline void expect_sound(const GrowthStep& step, long chi = 2) {
    EXPECT_TRUE(step.closed) << "step " << step.step;
    EXPECT_TRUE(step.outward) << "step " << step.step;
    EXPECT_EQ(step.chi, chi) << "step " << step.step;
    EXPECT_EQ(step.components, 1U) << "step " << step.step;
    EXPECT_EQ(step.intersections, 0U) << "step " << step.step;
    EXPECT_EQ(step.above_longest, 0U) << "step " << step.step;
    EXPECT_EQ(step.unexplained, 0U) << "step " << step.step;
}

// Metres from the Y axis, sorted, of the vertices between two heights whose angle about it is within `width`
// radians of `angle`.
inline std::vector<double> radii(const GrownBark& bark, double low, double high, double angle = 0.0,
                                 double width = 4.0) {
    std::vector<double> found;
    for (const GrownBark::Vertex& vertex : bark.vertices) {
        const DVec3 p(vertex.position);
        if (p.y < low || p.y > high) continue;
        if (std::abs(std::remainder(std::atan2(p.z, p.x) - angle, 2.0 * kPi)) > width) continue;
        found.push_back(std::hypot(p.x, p.z));
    }
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace treerec::test
