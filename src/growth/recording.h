// What a growth looked like on its way, kept to be scrubbed through: plain data, without CGAL.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mesh/grown_bark.h"

namespace treerec {

// Who wants to see the surface while it grows. Looking changes nothing of what grows.
class GrowthWatcher {
  public:
    virtual ~GrowthWatcher() = default;
    // Whether step `step` of `steps` is to be shown.
    virtual bool wants(int step, int steps) = 0;
    // The surface after that step: without lighter levels, and with a digest of 0, as it fits no wood yet.
    // The last one is the result.
    virtual void take(int step, const GrownBark& bark) = 0;
};

// Evenly spread steps of a growth, and its result, in at most so many bytes: whenever they would be more,
// every other one goes.
class GrowthRecording : public GrowthWatcher {
  public:
    static constexpr size_t kMostBytes = size_t(64) << 20;
    static constexpr int kMostFrames = 240;

    struct Frame {
        int step = 0;
        std::string bark;  // pack_grown_bark()
    };

    explicit GrowthRecording(size_t most_bytes = kMostBytes) : most_(most_bytes) {}
    bool wants(int step, int steps) override;
    void take(int step, const GrownBark& bark) override;
    // By step. Empty where not even the result has room.
    const std::vector<Frame>& frames() const { return frames_; }
    size_t bytes() const { return bytes_; }

  private:
    const size_t most_;
    int every_ = 0;  // of the steps that are kept, from one to the next; 0: not begun
    int steps_ = 0;
    size_t bytes_ = 0;
    std::vector<Frame> frames_;
};

}  // namespace treerec
