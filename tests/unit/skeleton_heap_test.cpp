#include "skeleton/geodesics/heap.h"

#include <gtest/gtest.h>

#include <functional>
#include <queue>

#include "geometry/random.h"

namespace treerec {
namespace {

TEST(LeastFirst, GivesTheLeastOfWhatIsInIt) {
    Random random(5);
    for (int trial = 0; trial < 200; trial++) {
        const auto next = [&] { return static_cast<uint64_t>(random.uniform(0.0, trial % 2 ? 1e15 : 50.0)); };
        std::vector<uint64_t> start(static_cast<size_t>(trial % 70));
        for (uint64_t& entry : start)
            entry = next();
        std::priority_queue<uint64_t, std::vector<uint64_t>, std::greater<>> wanted(std::greater<>(), start);
        LeastFirst heap(start);
        for (int step = 0; step < 300; step++) {
            ASSERT_EQ(heap.empty(), wanted.empty());
            if (!wanted.empty() && random.uniform() < 0.55) {
                ASSERT_EQ(heap.pop(), wanted.top());
                wanted.pop();
            } else {
                const uint64_t entry = next();
                heap.push(entry);
                wanted.push(entry);
            }
        }
        for (; !wanted.empty(); wanted.pop())
            ASSERT_EQ(heap.pop(), wanted.top());
        EXPECT_TRUE(heap.empty());
    }
}

}  // namespace
}  // namespace treerec
