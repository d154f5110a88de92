#include "skeleton/geodesics/root.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "error.h"
#include "pipeline/reconstruct.h"
#include "scan_samples.h"
#include "skeleton/skeleton.h"

namespace treerec {
namespace {

// A tree, and a bush beside it that stands lower and touches it.
PointCloud tree_above_a_bush(uint64_t seed) {
    PointCloud cloud;
    cloud.positions = scan_test::tree_points(seed);
    Random random(seed);
    for (int i = 0; i < 4000; i++)
        cloud.positions.emplace_back(DVec3(1.6, -0.5, 0.0) +
                                     0.8 * std::cbrt(random.uniform()) * random.direction());
    for (int i = 0; i < 600; i++)
        cloud.positions.emplace_back(random.uniform(0.2, 1.2), random.uniform(0.0, 0.15),
                                     random.uniform(-0.2, 0.2));
    return cloud;
}

DVec3 root_of(const SkeletonResult& made) {
    return made.tree.frame().to_scan(made.tree.node(made.tree.root()).position);
}

TEST(Root, StandsWhereAStemIsKnownToStand) {
    for (const SkeletonMethod method :
         {SkeletonMethod::kGeodesic, SkeletonMethod::kDelaunay, SkeletonMethod::kFlood})
        for (const uint64_t seed : {1, 2}) {
            const PointCloud cloud = tree_above_a_bush(seed);
            SkeletonOptions options;
            options.method = method;
            const DVec3 lowest = root_of(skeletonize(cloud, options));
            EXPECT_LT(lowest.y, -0.9);
            options.stem_base = DVec3(0.1, 0.1, -0.1);
            const DVec3 known = root_of(skeletonize(cloud, options));
            EXPECT_LT(std::hypot(known.x, known.z), 0.3);
            EXPECT_GT(known.y, -0.5);
            // Where nothing stands, the lowest wood is as good as ever.
            options.stem_base = DVec3(-8.0, 0.0, 5.0);
            EXPECT_EQ(root_of(skeletonize(cloud, options)), lowest);
        }
}

// Bushes stood lower than some of these stems, and were rooted instead.
TEST(Root, OfATreeInAPlotIsItsStemsBase) {
    const std::string folder = scan_test::scans_folder();
    if (folder.empty()) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    for (const size_t number : {1, 5, 17}) {
        ReconstructOptions options;
        options.clean.pick.number = number;
        options.orient.up = UpAxis::kZ;
        Reconstruction made;
        try {
            made = reconstruct_file(folder + "spanner_MLS_plot.laz", options);
        } catch (const Error& error) {
            GTEST_SKIP() << error.what();  // LAZ needs a library that is not everywhere
        }
        const DVec3 root = made.tree.frame().to_scan(made.tree.node(made.tree.root()).position);
        const DVec3 off = root - made.clean.pick.trees[made.clean.pick.taken].foot;
        EXPECT_LT(std::hypot(off.x, off.y), 0.7) << number;
        EXPECT_LT(std::abs(off.z), 1.5) << number;
    }
}

}  // namespace
}  // namespace treerec
