// The surface of limbs.
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

struct Limbs {
    std::vector<Limb> limbs;
    std::vector<std::vector<Station>> axes;
};

Limbs random_limbs(Random& random) {
    Limbs grown;
    const size_t count = 1 + random.below(300);
    for (size_t l = 0; l < count; l++) {
        Limb limb;
        if (l > 0) {
            limb.parent = static_cast<int32_t>(random.below(static_cast<uint32_t>(l)));
            limb.attach =
                static_cast<int32_t>(random.below(static_cast<uint32_t>(grown.axes[limb.parent].size())));
        }
        DVec3 at = l > 0 ? grown.axes[limb.parent][limb.attach].position : DVec3(0.0);
        std::vector<Station> line(1 + random.below(l > 0 ? 6 : 40));
        for (Station& station : line) {
            at += 0.05 * DVec3(random.normal(), random.normal(), random.normal());
            station.position = at;
            station.radius = l % 10 == 0 ? 0.06 : 0.005;
        }
        grown.limbs.push_back(limb);
        grown.axes.push_back(line);
    }
    return grown;
}

TEST(Bark, EveryLimbHasOnePlaceInTheOrder) {
    Random random(3);
    for (int trial = 0; trial < 100; trial++) {
        const Limbs grown = random_limbs(random);
        std::vector<int32_t> order = Bark(grown.limbs, grown.axes).limbs_by_place();
        std::sort(order.begin(), order.end());
        std::vector<int32_t> all(grown.limbs.size());
        std::iota(all.begin(), all.end(), 0);
        EXPECT_EQ(order, all);
    }
}

TEST(Bark, KnowsItsThickestWood) {
    Random random(5);
    const Limbs grown = random_limbs(random);
    double thickest = 0.0;
    for (const std::vector<Station>& line : grown.axes)
        for (const Station& station : line)
            thickest = std::max(thickest, station.radius);
    EXPECT_EQ(Bark(grown.limbs, grown.axes).thickest(), thickest);
}

TEST(Bark, NearestIsThatOfAllPieces) {
    Random random(4);
    for (int trial = 0; trial < 20; trial++) {
        Limbs grown = random_limbs(random);
        for (std::vector<Station>& line : grown.axes)
            for (Station& station : line)
                station.radius = random.uniform(0.001, trial % 2 == 0 ? 0.02 : 0.2);
        const Bark bark(grown.limbs, grown.axes);
        uint32_t hint = 0;
        for (int query = 0; query < 200; query++) {
            const size_t beside = random.below(static_cast<uint32_t>(grown.axes.size()));
            const Vec3 p(grown.axes[beside][0].position +
                         0.05 * DVec3(random.normal(), random.normal(), random.normal()));
            std::vector<uint8_t> except(grown.limbs.size(), 0);
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
                const Limb& limb = grown.limbs[l];
                if (limb.parent >= 0)
                    look(grown.axes[limb.parent][limb.attach].position, line[0].position, line[0].radius,
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
                EXPECT_EQ(place.limb, -1);
                continue;
            }
            ASSERT_GE(place.limb, 0);
            EXPECT_EQ(except[place.limb], 0);
            EXPECT_EQ(place.outside(), least);
            EXPECT_LT(static_cast<size_t>(place.station), grown.axes[place.limb].size());
            // Whatever the hint.
            uint32_t other = 0;
            const BarkPlace again = bark.nearest(p, within, other, &except);
            EXPECT_EQ(std::pair(again.limb, again.station), std::pair(place.limb, place.station));
        }
    }
}

}  // namespace
}  // namespace treerec
