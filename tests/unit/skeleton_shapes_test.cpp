#include <gtest/gtest.h>

#include "skeleton/skeleton.h"
#include "skeleton_shapes.h"
#include "tree/branches.h"

namespace treerec {
namespace {

using test::Wood;
using test::WoodScan;

// The tree in the scan's own coordinates.
struct Piece {
    DVec3 a;
    DVec3 b;
    double radius = 0.0;  // at b
};

std::vector<Piece> pieces_of(const SkeletonResult& result, const WoodScan& scan) {
    const Tree& tree = result.tree;
    const auto in_scan = [&](NodeId id) {
        return scan.cloud.frame.to_tree(tree.frame().to_scan(tree.node(id).position));
    };
    std::vector<Piece> pieces;
    for (NodeId id : tree.depth_first())
        if (id != tree.root())
            pieces.push_back({in_scan(tree.node(id).parent), in_scan(id), tree.node(id).radius});
    return pieces;
}

double distance_to(const DVec3& p, const DVec3& a, const DVec3& b) {
    const double square = glm::dot(b - a, b - a);
    const double t = square > 0.0 ? std::clamp(glm::dot(p - a, b - a) / square, 0.0, 1.0) : 0.0;
    return glm::distance(p, a + t * (b - a));
}

// A stem as wide as an eighth of the tree's height, and a scan that samples it finely.
TEST(Shapes, AThickStemIsMeasured) {
    for (uint64_t seed = 1; seed <= 8; seed++) {
        const WoodScan scan = test::thick_scan(seed);
        const Wood& stem = scan.wood[0];
        size_t looked = 0;
        for (const Piece& piece : pieces_of(skeletonize(scan.cloud, {}), scan)) {
            const double t = test::share_along(stem, piece.b);
            if (t < 0.15 || t > 0.8 || distance_to(piece.b, stem.a, stem.b) > 0.5 * stem.radius(t)) continue;
            looked++;
            EXPECT_NEAR(piece.radius, stem.radius(t), 0.05 * stem.radius(t)) << seed;
            EXPECT_LT(distance_to(piece.b, stem.a, stem.b), 0.03 * stem.radius(t)) << seed;
        }
        EXPECT_GT(looked, 2u) << seed;
    }
}

}  // namespace
}  // namespace treerec
