// How fast bark grows: Mizoguchi and Miyata's (2014) parameters and sizes (table 3).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>

#include "bench.h"
#include "geometry/parallel.h"
#include "growth/run.h"

namespace treerec::bench {

namespace {

using namespace growth;

constexpr double kLongest = 0.150,
                 kShortest = 0.070;      // T_s and T_m, metres (Mizoguchi and Miyata 2014, figure 23)
constexpr double kApicalSpeed = 0.060;   // S_a, metres a step
constexpr double kCambiumSpeed = 0.003;  // S_c, metres a step
constexpr int kSteps = 300;
constexpr double kGolden = 2.399963229728653;  // radians between one branch and the next
constexpr double kBudSteps = 12.0;             // between a tip's passing and the branch

void add_branch(GrowthPlan& plan, int32_t parent, double along, const DVec3& from, const DVec3& direction,
                double first_step) {
    GrowthBranch branch;
    branch.parent = parent;
    branch.parent_along = along;
    const double length = kApicalSpeed * (plan.steps - first_step);
    const DVec3 end = from + direction * length;
    branch.axis.push_back({from, from, direction, 0.0, 0.0, first_step, kCambiumSpeed});
    branch.axis.push_back({end, end, direction, length, 0.0, static_cast<double>(plan.steps), kCambiumSpeed});
    plan.branches.push_back(std::move(branch));
}

// Branches about an axis, each as far from the last along it as round it, and `orders` of theirs.
void ramify(GrowthPlan& plan, int32_t parent, int count, int orders) {
    const GrowthBranch stem = plan.branches[static_cast<size_t>(parent)];
    const DVec3 up = stem.axis.front().direction, x = any_perpendicular(up), y = glm::cross(up, x);
    const double length = stem.axis.back().along;
    for (int i = 0; i < count; i++) {
        const double along = length * (0.15 + 0.75 * i / count);
        const double angle = kGolden * i;
        const DVec3 direction =
            glm::normalize(x * std::cos(angle) + y * std::sin(angle) + up * (orders > 1 ? 0.5 : 0.8));
        const double first = stem.first_step() + along / kApicalSpeed + kBudSteps;
        add_branch(plan, parent, along, stem.axis.front().position + up * along, direction, first);
        if (orders > 1) ramify(plan, static_cast<int32_t>(plan.branches.size()) - 1, count / 4, orders - 1);
    }
}

struct Case {
    const char* name;
    int branches;
    int orders;
    int steps;
    double fine;    // of T_s and T_m
    double target;  // seconds on 2 cores
    double paper;   // seconds
};

struct Result {
    double seconds = 0.0, cpu = 0.0, vertex_steps = 0.0;
    size_t vertices = 0, faces = 0, frozen = 0;
    int steps = 0;
    size_t branches = 0;
};

Result grow(const Case& one) {
    GrowthPlan plan;
    plan.steps = one.steps;
    add_branch(plan, -1, 0.0, DVec3(0.0), DVec3(0.0, 1.0, 0.0), 0.0);
    if (one.branches > 0) ramify(plan, 0, one.branches, one.orders);
    Result result;
    result.branches = plan.branches.size();
    Run run(plan, {}, one.fine * kLongest, one.fine * kShortest);
    const std::clock_t busy = std::clock();
    const auto start = std::chrono::steady_clock::now();
    while (!run.done()) {
        run.advance();
        result.vertex_steps += static_cast<double>(run.count().vertices);
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.cpu = static_cast<double>(std::clock() - busy) / CLOCKS_PER_SEC;
    result.vertices = run.count().vertices;
    result.faces = run.count().faces;
    result.frozen = run.count().frozen;
    result.steps = run.step();
    return result;
}

}  // namespace

void bench_growth(const Settings& settings) {
    const int repetitions = settings.repetitions > 0 ? settings.repetitions : 1;
    const Case cases[] = {
        {"(a) 81,718 vertices", 23, 2, kSteps, 1.0, 20.0, 48.4 * 60.0},
        {"(b) 23,508 vertices", 8, 2, kSteps, 1.0, 6.0, 7.6 * 60.0},
        {"(c) 32,758 vertices", 12, 2, kSteps, 1.0, 8.0, 6.7 * 60.0},
        {"trunk", 0, 1, kSteps, 1.0, 0.0, 0.0},
        {"trunk, half of T_s and T_m", 0, 1, kSteps, 0.5, 0.0, 0.0},
    };
    std::printf("Bark from a seed: fastest of %d, %d threads; Mizoguchi and Miyata's (2014) table 3 beside\n",
                repetitions, thread_count());
    std::printf("%-28s %8s %6s %9s %9s %7s %8s %8s %8s %7s\n", "case", "branches", "steps", "vertices",
                "faces", "frozen", "s", "target s", "paper s", "CPU us");
    Result trunk, fine;
    for (const Case& one : cases) {
        Result best = grow(one);
        for (int i = 1; i < repetitions; i++)
            best.seconds = std::min(best.seconds, grow(one).seconds);
        std::printf("%-28s %8zu %6d %9zu %9zu %7zu %8.2f %8.0f %8.0f %7.2f\n", one.name, best.branches,
                    best.steps, best.vertices, best.faces, best.frozen, best.seconds, one.target, one.paper,
                    1e6 * best.cpu / best.vertex_steps);
        std::fflush(stdout);
        if (one.branches == 0) (one.fine < 1.0 ? fine : trunk) = best;
    }
    std::printf("%.2f times the vertices take %.2f times the time a step\n",
                static_cast<double>(fine.vertices) / static_cast<double>(trunk.vertices),
                fine.cpu / trunk.cpu);
}

}  // namespace treerec::bench
