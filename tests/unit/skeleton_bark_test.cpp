// The surface of branches.
#include "skeleton/cylinders/bark.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/random.h"
#include "geometry/segment.h"

namespace treerec {
namespace {

struct Branches {
    std::vector<SkeletonBranch> branches;
    std::vector<std::vector<Station>> axes;
};

Branches random_branches(Random& random) {
    Branches grown;
    const size_t count = 1 + random.below(300);
    for (size_t l = 0; l < count; l++) {
        SkeletonBranch branch;
        if (l > 0) {
            branch.parent = static_cast<int32_t>(random.below(static_cast<uint32_t>(l)));
            branch.attach =
                static_cast<int32_t>(random.below(static_cast<uint32_t>(grown.axes[branch.parent].size())));
        }
        DVec3 at = l > 0 ? grown.axes[branch.parent][branch.attach].position : DVec3(0.0);
        std::vector<Station> line(1 + random.below(l > 0 ? 6 : 40));
        for (Station& station : line) {
            at += 0.05 * DVec3(random.normal(), random.normal(), random.normal());
            station.position = at;
            station.radius = l % 10 == 0 ? 0.06 : 0.005;
        }
        grown.branches.push_back(branch);
        grown.axes.push_back(line);
    }
    return grown;
}

TEST(Bark, EveryBranchHasOnePlaceInTheOrder) {
    Random random(3);
    for (int trial = 0; trial < 100; trial++) {
        const Branches grown = random_branches(random);
        std::vector<int32_t> order = Bark(grown.branches, grown.axes).branches_by_place();
        std::sort(order.begin(), order.end());
        std::vector<int32_t> all(grown.branches.size());
        std::iota(all.begin(), all.end(), 0);
        EXPECT_EQ(order, all);
    }
}

TEST(Bark, KnowsItsThickestWood) {
    Random random(5);
    const Branches grown = random_branches(random);
    double thickest = 0.0;
    for (const std::vector<Station>& line : grown.axes)
        for (const Station& station : line)
            thickest = std::max(thickest, station.radius);
    EXPECT_EQ(Bark(grown.branches, grown.axes).thickest(), thickest);
}

TEST(Bark, NearestIsThatOfAllPieces) {
    Random random(4);
    for (int trial = 0; trial < 20; trial++) {
        Branches grown = random_branches(random);
        for (std::vector<Station>& line : grown.axes)
            for (Station& station : line)
                station.radius = random.uniform(0.001, trial % 2 == 0 ? 0.02 : 0.2);
        const Bark bark(grown.branches, grown.axes);
        uint32_t hint = 0;
        for (int query = 0; query < 200; query++) {
            const size_t beside = random.below(static_cast<uint32_t>(grown.axes.size()));
            const Vec3 p(grown.axes[beside][0].position +
                         0.05 * DVec3(random.normal(), random.normal(), random.normal()));
            std::vector<uint8_t> except(grown.branches.size(), 0);
            for (uint8_t& left_aside : except)
                left_aside = query % 3 == 0 && random.uniform() < 0.7 ? 1 : 0;
            double least = std::numeric_limits<double>::max();
            const auto look = [&](const DVec3& a, const DVec3& b, double a_radius, double b_radius) {
                double t = 0.0;
                const double distance = distance_to_segment(DVec3(p), a, b, &t);
                least = std::min(least, distance - (a_radius + t * (b_radius - a_radius)));
            };
            for (size_t l = 0; l < grown.axes.size(); l++) {
                if (except[l] != 0) continue;
                const std::vector<Station>& line = grown.axes[l];
                const SkeletonBranch& branch = grown.branches[l];
                if (branch.parent >= 0)
                    look(grown.axes[branch.parent][branch.attach].position, line[0].position, line[0].radius,
                         line[0].radius);
                else if (line.size() == 1)
                    look(line[0].position, line[0].position, line[0].radius, line[0].radius);
                for (size_t i = 1; i < line.size(); i++)
                    look(line[i - 1].position, line[i].position, line[i - 1].radius, line[i].radius);
            }
            const double within =
                query % 4 == 0 ? random.uniform(0.0, 0.1) : std::numeric_limits<double>::max();
            const BarkPlace place = bark.nearest(p, within, hint, &except);
            if (!(least < within)) {
                EXPECT_EQ(place.branch, -1);
                continue;
            }
            ASSERT_GE(place.branch, 0);
            EXPECT_EQ(except[place.branch], 0);
            EXPECT_EQ(place.outside(), least);
            EXPECT_LT(static_cast<size_t>(place.station), grown.axes[place.branch].size());
            // Whatever the hint.
            uint32_t other = 0;
            const BarkPlace again = bark.nearest(p, within, other, &except);
            EXPECT_EQ(std::pair(again.branch, again.station), std::pair(place.branch, place.station));
        }
    }
}

}  // namespace
}  // namespace treerec
