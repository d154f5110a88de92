// Sketches of trees whose every stroke's intent is known: grown trees (synth/grow.h) drawn as trunk, branches
// and outline, and then spoilt as people do (Ma and Liu 2020, figure 4).
//
// Trees of the habits with one stem, seen from any side. Branches are those of the first order that one would
// draw: long enough, apart from each other, and not hidden before the trunk.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sketch/strokes.h"

namespace treerec::test {

// What was done to a branch's tail.
enum class Mess : uint8_t { kNone, kGap, kCrossing, kHook, kLoop, kHookGap, kLoopCrossing };
const char* mess_name(Mess mess);
inline constexpr int kMesses = 7;

struct StrokeTruth {
    StrokeRole role = StrokeRole::kBranch;
    std::optional<DVec2> attach;  // of a branch, pixels of the sketch's canvas
    Mess mess = Mess::kNone;
    bool reversed = false;
};

struct MessySketch {
    Sketch sketch;
    std::vector<StrokeTruth> truth;  // of each stroke
};

struct MessOptions {
    bool broken = true;    // tails
    bool shaken = true;    // jitter, whole pixels
    bool shuffled = true;  // order and direction
};

// Canvases of several sizes. The same seed gives the same tree whatever the options.
MessySketch messy_sketch(uint64_t seed, const MessOptions& options = {});

}  // namespace treerec::test
