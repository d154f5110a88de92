#include "geometry/groups.h"

#include <gtest/gtest.h>

#include <set>

#include "geometry/random.h"

namespace treerec {
namespace {

using Link = std::pair<uint32_t, uint32_t>;

// Who can be reached from v, by walking.
std::vector<uint32_t> smallest_reachable(size_t count, const std::vector<Link>& links) {
    std::vector<std::set<uint32_t>> beside(count);
    for (const auto& [a, b] : links) {
        beside[a].insert(b);
        beside[b].insert(a);
    }
    std::vector<uint32_t> smallest(count, UINT32_MAX);
    for (uint32_t start = 0; start < count; start++) {
        if (smallest[start] != UINT32_MAX) continue;
        std::vector<uint32_t> stack{start};
        smallest[start] = start;
        while (!stack.empty()) {
            const uint32_t v = stack.back();
            stack.pop_back();
            for (const uint32_t n : beside[v])
                if (smallest[n] == UINT32_MAX) {
                    smallest[n] = start;
                    stack.push_back(n);
                }
        }
    }
    return smallest;
}

TEST(Groups, AreNamedByTheirSmallestMemberHoweverTheyWereJoined) {
    Random random(7);
    for (int trial = 0; trial < 60; trial++) {
        // Some of several stretches of threads, and links far and near.
        const size_t count = 1 + static_cast<size_t>(random.uniform(0.0, trial % 3 == 0 ? 9000.0 : 50.0));
        const double far = trial % 2 == 0 ? static_cast<double>(count) : 4.0;
        std::vector<Link> links;
        for (double i = random.uniform(0.0, 0.9); i * 1.2 < static_cast<double>(count); i++) {
            const auto a = random.below(static_cast<uint32_t>(count));
            const auto b = static_cast<uint32_t>(a + random.uniform(0.0, far)) % static_cast<uint32_t>(count);
            links.emplace_back(a, b);
        }
        const std::vector<uint32_t> wanted = smallest_reachable(count, links);

        Groups one_by_one(count), at_once(count);
        std::vector<std::vector<uint32_t>> of(count);
        for (const auto& [a, b] : links) {
            const bool apart = one_by_one.find(a) != one_by_one.find(b);
            EXPECT_EQ(one_by_one.join(a, b), apart);
            of[a].push_back(b);
        }
        at_once.join_all([&](uint32_t v, const auto& link) {
            for (const uint32_t n : of[v])
                link(n);
        });
        ASSERT_EQ(one_by_one.names(), wanted);
        ASSERT_EQ(at_once.names(), wanted);
    }
}

}  // namespace
}  // namespace treerec
