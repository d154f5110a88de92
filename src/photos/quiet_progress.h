#pragma once

#include "progress.h"

namespace treerec {

// For a small part of a stage, whose own stages nobody needs to see: it is only stopped.
class QuietProgress final : public Progress {
  public:
    explicit QuietProgress(const Progress* whole) : whole_(whole) {}
    bool cancelled() const override { return whole_ && whole_->cancelled(); }

  private:
    const Progress* whole_;
};

}  // namespace treerec
