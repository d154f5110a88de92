#include "growth/recording.h"

#include <algorithm>
#include <utility>

namespace treerec {

bool GrowthRecording::wants(int step, int steps) {
    if (every_ == 0) every_ = std::max((steps + kMostFrames - 1) / kMostFrames, 1);
    steps_ = steps;
    return step >= steps || step % every_ == 0;
}

void GrowthRecording::take(int step, const GrownBark& bark) {
    Frame frame{step, pack_grown_bark(bark)};
    const bool last = step >= steps_;
    while (bytes_ + frame.bark.size() > most_ && !frames_.empty()) {
        every_ *= 2;
        std::erase_if(frames_, [&](const Frame& kept) { return kept.step % every_ != 0; });
        bytes_ = 0;
        for (const Frame& kept : frames_)
            bytes_ += kept.bark.size();
    }
    if (bytes_ + frame.bark.size() > most_ || (!last && step % every_ != 0)) return;
    bytes_ += frame.bark.size();
    frames_.push_back(std::move(frame));
}

}  // namespace treerec
