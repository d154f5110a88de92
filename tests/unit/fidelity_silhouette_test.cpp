#include "fidelity/silhouette.h"

#include <gtest/gtest.h>

#include <cmath>

#include "error.h"
#include "geometry/parallel.h"
#include "mesh/branch_tubes.h"
#include "random_tree.h"

namespace treerec {
namespace {

// An upright rectangle in the plane of the azimuth's view: seen in full from there, as a line from across.
Mesh board(double azimuth_degrees, double left, double right, double bottom, double top) {
    const double a = azimuth_degrees * 3.14159265358979323846 / 180.0;
    Mesh mesh;
    for (const auto& [x, y] :
         {std::pair(left, bottom), std::pair(right, bottom), std::pair(right, top), std::pair(left, top)})
        mesh.positions.push_back(Vec3(DVec3(x * std::cos(a), y, x * std::sin(a))));
    for (uint32_t index : {0u, 1u, 2u, 0u, 2u, 3u})
        mesh.indices.push_back(index);
    return mesh;
}

TEST(Silhouette, MeasuresKnownAreasFromEverySide) {
    for (int v = 0; v < 4; v++) {
        // 2 m x 4 m against its right half and a piece above: 1024 pixels are 5 m.
        const Mesh before = board(45.0 * v, -1.0, 1.0, 0.0, 4.0), after = board(45.0 * v, 0.0, 1.0, 0.0, 5.0);
        const SilhouetteChange change = compare_silhouettes(before, after);
        const double square_metre = (1024.0 / 5.0) * (1024.0 / 5.0);
        for (int other = 0; other < 4; other++) {
            const SilhouetteView& view = change.views[static_cast<size_t>(other)];
            const double seen = std::abs(std::cos((v - other) * 3.14159265358979323846 / 4.0));
            EXPECT_NEAR(view.before / square_metre, 8.0 * seen, 0.03);
            EXPECT_NEAR(view.after / square_metre, 5.0 * seen, 0.03);
            EXPECT_NEAR(view.differing / square_metre, 5.0 * seen, 0.03);
            if (seen < 0.1) continue;
            EXPECT_NEAR(view.share_of_silhouette(), 5.0 / 9.0, 0.005);
            EXPECT_NEAR(view.share_of_picture(), 5.0 / 10.0, 0.01);
        }
    }
}

TEST(Silhouette, AMoveOfLessThanAPixelCountsByItsPart) {
    const Mesh before = board(0.0, 0.0, 4.0, 0.0, 4.0);
    Mesh after = before;
    for (Vec3& p : after.positions)
        p.x *= 1.0F + 0.25F / 64.0F;  // a quarter of a pixel at the right edge
    EXPECT_NEAR(compare_silhouettes(before, after, 64).views[0].differing, 0.25 * 64.0, 17.0);
    EXPECT_GT(compare_silhouettes(before, after, 64).views[0].differing, 0.0);
}

TEST(Silhouette, NothingDiffersFromItself) {
    const Mesh mesh = build_branch_tubes(test::random_tree(1, 500));
    const SilhouetteView same = compare_silhouettes(mesh, mesh).all();
    EXPECT_EQ(same.differing, 0.0);
    EXPECT_EQ(same.before, same.after);
    EXPECT_GT(same.before, 1000.0);
    const SilhouetteView gone = compare_silhouettes(mesh, {}).all();
    EXPECT_EQ(gone.share_of_silhouette(), 1.0);
    const SilhouetteView empty = compare_silhouettes({}, {}).all();
    EXPECT_EQ(empty.share_of_silhouette(), 0.0);
    EXPECT_EQ(empty.share_of_picture(), 0.0);
}

TEST(Silhouette, IsTheSameOnAnyNumberOfThreads) {
    const Mesh a = build_branch_tubes(test::random_tree(1, 500));
    const Mesh b = build_branch_tubes(test::random_tree(2, 500));
    set_thread_count(1);
    const SilhouetteView one = compare_silhouettes(a, b, 300).all();
    set_thread_count(4);
    const SilhouetteView four = compare_silhouettes(a, b, 300).all();
    set_thread_count(0);
    EXPECT_EQ(one.differing, four.differing);
    EXPECT_EQ(one.before, four.before);
    // The other way round nothing changes but the names.
    EXPECT_EQ(compare_silhouettes(b, a, 300).all().differing, one.differing);
}

TEST(Silhouette, RefusesPicturesOutOfRangeAndHearsACancel) {
    struct Cancel : Progress {
        bool cancelled() const override { return true; }
    };
    EXPECT_THROW(compare_silhouettes({}, {}, 15), Error);
    EXPECT_THROW(compare_silhouettes({}, {}, 4097), Error);
    const Mesh mesh = board(0.0, 0.0, 1.0, 0.0, 1.0);
    const Cancel cancel;
    EXPECT_THROW(compare_silhouettes(mesh, mesh, 64, &cancel), Cancelled);
}

}  // namespace
}  // namespace treerec
