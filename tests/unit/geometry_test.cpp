#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <thread>

#include "error.h"
#include "geometry/parallel.h"
#include "geometry/random.h"

namespace treerec {
namespace {

TEST(Random, MatchesTheReferenceSequenceOfPcg32) {
    // The published demo of PCG32 (pcg32_srandom(42, 54)) prints these first numbers.
    Random random(42, 54);
    for (uint32_t expected : {0xa15c02b7U, 0x7b47f409U, 0xba1d3330U, 0x83d2f293U, 0xbfa4784bU, 0xcbed606eU})
        EXPECT_EQ(random.next(), expected);
}

TEST(Random, IsUniformAndNormalEnough) {
    Random random(3);
    double sum = 0.0, squares = 0.0, uniform = 0.0;
    const int count = 200000;
    for (int i = 0; i < count; i++) {
        const double value = random.normal();
        sum += value;
        squares += value * value;
        uniform += random.uniform();
        ASSERT_LT(random.below(7), 7U);
        ASSERT_NEAR(glm::length(random.direction()), 1.0, 1e-9);
    }
    EXPECT_NEAR(sum / count, 0.0, 0.01);
    EXPECT_NEAR(squares / count, 1.0, 0.02);
    EXPECT_NEAR(uniform / count, 0.5, 0.005);
}

TEST(ParallelFor, VisitsEveryIndexOnceWithAnyThreadCount) {
    for (int threads : {1, 2, 5}) {
        set_thread_count(threads);
        std::vector<int> visits(10007, 0);
        parallel_for(visits.size(), 64, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; i++)
                visits[i]++;
        });
        EXPECT_EQ(std::accumulate(visits.begin(), visits.end(), 0), 10007);
        EXPECT_EQ(*std::max_element(visits.begin(), visits.end()), 1);
    }
    set_thread_count(0);
    parallel_for(0, 8, [](size_t, size_t) { FAIL(); });
}

TEST(ParallelFor, PassesAnExceptionOn) {
    std::atomic<int> calls{0};
    EXPECT_THROW(parallel_for(1000, 1,
                              [&](size_t begin, size_t) {
                                  calls++;
                                  if (begin == 3) throw Error("three");
                                  // So that the others cannot be through before the exception is caught.
                                  std::this_thread::sleep_for(std::chrono::milliseconds(1));
                              }),
                 Error);
    EXPECT_LT(calls, 1000);
}

TEST(ParallelFor, RunsLoopsInsideOfLoopsOfManyThreadsAtOnce) {
    set_thread_count(3);
    std::atomic<int> sum{0}, caught{0};
    std::vector<std::thread> callers;
    for (int caller = 0; caller < 4; caller++)
        callers.emplace_back([&, caller] {
            for (int round = 0; round < 200; round++)
                try {
                    parallel_for(5, 1, [&](size_t outer, size_t) {
                        parallel_for(100, 7, [&](size_t begin, size_t end) {
                            if (caller == 0 && outer == 2 && begin > 50) throw Error("in the middle");
                            sum += static_cast<int>(end - begin);
                        });
                    });
                } catch (const Error&) {
                    caught++;
                }
        });
    for (std::thread& caller : callers)
        caller.join();
    EXPECT_EQ(caught, 200);
    EXPECT_GE(sum, 3 * 200 * 500);
    set_thread_count(0);
}

TEST(ParallelFor, GoesOnAfterItsThreadsHaveEnded) {
    set_thread_count(4);
    std::atomic<bool> done{false};
    std::thread ending([&] {
        while (!done)
            end_idle_threads();
    });
    for (int round = 0; round < 300; round++) {
        std::atomic<int> sum{0};
        parallel_for(64, 1, [&](size_t begin, size_t) { sum += static_cast<int>(begin); });
        EXPECT_EQ(sum, 64 * 63 / 2);
    }
    done = true;
    ending.join();
    set_thread_count(0);
}

}  // namespace
}  // namespace treerec
