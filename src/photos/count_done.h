// Tells how many things of a stage are done, from any thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <mutex>

#include "progress.h"

namespace treerec {

class CountDone {
  public:
    // begin, end: what of the job the stage is. all: how many things it has.
    CountDone(Progress* progress, double begin, double end, const char* stage, size_t all)
        : progress_(progress), begin_(begin), end_(end), stage_(stage), all_(all) {}
    void add(size_t count) {
        if (!progress_) return;
        const std::lock_guard lock(mutex_);
        done_ += count;
        const double share = static_cast<double>(done_) / static_cast<double>(std::max<size_t>(all_, 1));
        progress_->update(begin_ + (end_ - begin_) * share, stage_);
        progress_->count(done_, all_);
    }

  private:
    Progress* progress_;
    double begin_, end_;
    const char* stage_;
    size_t all_, done_ = 0;
    std::mutex mutex_;
};

}  // namespace treerec
