// The surface of limbs.
#include "skeleton/bark.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

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

// Of thin wood, the nearest eight stations are looked at; those passed over would not have changed anything.
TEST(Bark, NearestIsThatOfEightStations) {
    Random random(4);
    for (int trial = 0; trial < 20; trial++) {
        Limbs grown = random_limbs(random);
        std::vector<Vec3> positions;
        std::vector<std::pair<int32_t, int32_t>> names;
        for (size_t l = 0; l < grown.axes.size(); l++) {
            const int32_t limb = static_cast<int32_t>(l);
            std::vector<Station>& line = grown.axes[l];
            for (size_t i = 0; i < line.size(); i++) {
                line[i].radius = random.uniform(0.001, 0.02);
                positions.emplace_back(line[i].position);
                names.emplace_back(limb, static_cast<int32_t>(i));
            }
            if (grown.limbs[l].parent < 0) continue;
            const DVec3& fork = grown.axes[grown.limbs[l].parent][grown.limbs[l].attach].position;
            for (const double t : {0.25, 0.5, 0.75}) {
                positions.emplace_back(fork + t * (line[0].position - fork));
                names.emplace_back(limb, 0);
            }
        }
        const Bark bark(grown.limbs, grown.axes);
        for (int query = 0; query < 200; query++) {
            const Vec3 p(positions[random.below(static_cast<uint32_t>(positions.size()))] +
                         Vec3(0.05 * DVec3(random.normal(), random.normal(), random.normal())));
            std::vector<size_t> order(positions.size());
            std::iota(order.begin(), order.end(), size_t{0});
            const auto squared = [&](size_t i) { return glm::dot(p - positions[i], p - positions[i]); };
            std::stable_sort(order.begin(), order.end(),
                             [&](size_t a, size_t b) { return squared(a) < squared(b); });
            double least = std::numeric_limits<double>::max();
            for (size_t k = 0; k < std::min<size_t>(8, order.size()); k++) {
                const auto [limb, station] = names[order[k]];
                least = std::min(least, bark.on_limb(limb, station, DVec3(p)).outside());
            }
            EXPECT_EQ(bark.nearest(p).outside(), least);
        }
    }
}

}  // namespace
}  // namespace treerec
