// How long each stage of a job took, for reports.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace treerec {

struct StageTime {
    std::string name;
    double milliseconds = 0.0;
    size_t count = 0;   // points, branches or nodes after the stage
    bool kept = false;  // its result was there already, from a job before
};

// Appends a StageTime at every stop(), measured from the last one.
class StageClock {
  public:
    explicit StageClock(std::vector<StageTime>& stages) : stages_(stages) {}

    // Told of every stage as it ends, on the thread that ran it; set by benchmarks, to measure memory.
    static inline void (*observer)(const StageTime& stage) = nullptr;

    void restart() { start_ = Clock::now(); }
    void stop(const char* name, size_t count, bool kept = false) {
        const Clock::time_point now = Clock::now();
        stages_.push_back(
            {name, std::chrono::duration<double, std::milli>(now - start_).count(), count, kept});
        if (observer) observer(stages_.back());
        start_ = now;
    }

  private:
    using Clock = std::chrono::steady_clock;
    std::vector<StageTime>& stages_;
    Clock::time_point start_ = Clock::now();
};

}  // namespace treerec
