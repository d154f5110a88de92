// The grown trees and scans that tests/bench/fit_leaves.py fits to.
#pragma once

#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "accuracy.h"

namespace treerec::bench {

struct GrownSetting {
    double noise, leaves, occlusion;
    size_t bare_points;
};

// A case, and its name as fit_leaves.py reads it: its number, habit, noise and leaves.
struct NamedCase {
    AccuracyCase setting;
    std::string name;
};

// All settings for each habit, with a seed of its own from `first_seed` on; `rounds` times.
inline std::vector<NamedCase> named_cases(std::span<const GrownSetting> settings,
                                          std::span<const Habit> habits, uint64_t first_seed, int rounds) {
    std::vector<NamedCase> cases;
    for (int round = 0; round < rounds; round++)
        for (const Habit habit : habits)
            for (const GrownSetting& one : settings) {
                const size_t number = cases.size();
                char name[120];
                std::snprintf(name, sizeof name, "grown %zu %s %g %g", number, habit_name(habit).c_str(),
                              one.noise, one.leaves);
                cases.push_back({{habit, first_seed + number, one.noise, one.occlusion, one.leaves,
                                  points_for(habit, one.leaves, one.bare_points)},
                                 name});
            }
    return cases;
}

}  // namespace treerec::bench
