// The surface of limbs.
#include "skeleton/bark.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "geometry/random.h"

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

}  // namespace
}  // namespace treerec
