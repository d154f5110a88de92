// Bits that float above and beside a crown: a neighbour's twigs, a bird, what the wind moved.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "pipeline/reconstruct.h"
#include "scan_samples.h"
#include "synth/grow.h"
#include "synth/scan.h"

namespace treerec {
namespace {

using namespace scan_test;

Reconstruction made_of(const std::vector<Vec3>& points) {
    const Folder folder;
    PointCloud cloud;
    cloud.positions = points;
    write_cloud(folder.file("scan.ply"), cloud);
    ReconstructOptions options;
    options.orient.up = UpAxis::kY;
    options.orient.metres_per_unit = 1.0;
    return reconstruct_file(folder.file("scan.ply"), options);
}

// The trunk's place at a height.
DVec2 trunk_at(const Tree& tree, double height) {
    for (const NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (!node.is_trunk() || node.parent == kNoNode) continue;
        const DVec3 from = tree.node(node.parent).position - tree.node(tree.root()).position;
        const DVec3 to = node.position - tree.node(tree.root()).position;
        if (from.y > height || to.y <= height) continue;
        const DVec3 at = from + (height - from.y) / (to.y - from.y) * (to - from);
        return {at.x, at.z};
    }
    return DVec2(std::nan(""));
}

TEST(LooseBits, BendNoTrunk) {
    for (const Habit habit : {Habit::kBirch, Habit::kConifer}) {
        for (const size_t bit : {size_t{12}, size_t{200}}) {
            SCOPED_TRACE(habit_name(habit) + " " + std::to_string(bit));
            GrowOptions grow;
            grow.habit = habit;
            grow.height = 10.0;
            grow.seed = 4;
            VirtualScanOptions scan;
            scan.points = 20000;
            scan.seed = 4;
            std::vector<Vec3> points = scan_tree(grow_tree(grow), scan).cloud.positions;
            const Reconstruction alone = made_of(points);
            Random random(5);
            for (const DVec3& at : {DVec3(0.5, 10.6, 0.2), DVec3(-0.6, 10.9, -0.3), DVec3(3.4, 7.5, 1.0),
                                    DVec3(-2.8, 8.8, 2.0)})
                for (size_t i = 0; i < bit; i++)
                    points.emplace_back(at + 0.15 * std::cbrt(random.uniform()) * random.direction());
            const Reconstruction result = made_of(points);
            for (const double height : {2.0, 5.0, 8.0})
                EXPECT_LT(glm::distance(trunk_at(result.tree, height), trunk_at(alone.tree, height)), 0.03)
                    << height;
        }
    }
}

}  // namespace
}  // namespace treerec
