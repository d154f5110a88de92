// How a long job tells where it is, and hears that it should stop.
#pragma once

#include <cstddef>

#include "error.h"

namespace treerec {

// Override to listen. Both calls may come from any thread, several times a second; keep them cheap.
class Progress {
  public:
    virtual ~Progress() = default;

    // fraction: 0..1 of the whole job, never falling. stage: a short name such as "Skeleton".
    virtual void update([[maybe_unused]] double fraction, [[maybe_unused]] const char* stage) {}

    // How many of a stage's things are done, such as photos; after the update() that names the stage.
    virtual void count([[maybe_unused]] size_t done, [[maybe_unused]] size_t all) {}

    // True once the user asked to stop.
    virtual bool cancelled() const { return false; }

    // Throws Cancelled if the user asked to stop. Call it at least every 50 ms of work.
    void check() const {
        if (cancelled()) throw Cancelled();
    }
};

// A part of a longer job: maps its own 0..1 onto [begin, end] of the whole.
// Null-safe: a job that gets no Progress passes nullptr on.
class SubProgress final : public Progress {
  public:
    SubProgress(Progress* whole, double begin, double end) : whole_(whole), begin_(begin), end_(end) {}

    void update(double fraction, const char* stage) override {
        if (whole_) whole_->update(begin_ + (end_ - begin_) * fraction, stage);
    }
    void count(size_t done, size_t all) override {
        if (whole_) whole_->count(done, all);
    }
    bool cancelled() const override { return whole_ && whole_->cancelled(); }

  private:
    Progress* whole_;
    double begin_;
    double end_;
};

}  // namespace treerec
